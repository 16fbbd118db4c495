// Writes a film while it is rendered, so that a later run can continue it.
#pragma once

#include "host/clock.hpp"
#include "host/job/option_table.hpp"
#include "host/job/progress.hpp"
#include "host/render/renderer.hpp"

#include <atomic>
#include <exception>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace glim {

struct CheckpointOptions {
    std::optional<double> seconds;  // between two checkpoints
    bool resume = false;
    std::string command;  // for the shell, after each checkpoint

    bool isGiven() const { return seconds || resume; }
};

void addCheckpoint(OptionTable& table, CheckpointOptions& options);

// Says what happens again and again the 1st, 2nd, 4th, 8th ... time in a row.
class RepeatedMessage {
public:
    void sayAgain(MessageId id, const std::string& sentence);
    void end() { times_ = 0; }

private:
    unsigned times_ = 0;
};

class CheckpointWriter {
public:
    // `label`: what is known of the film besides what the renderer knows (scene file, camera, guide).
    CheckpointWriter(const CheckpointOptions& options, std::filesystem::path output, std::function<void(Checkpoint&)> label);
    // Waits for the checkpoint under way and for the command after it.
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&) = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    // To be called often, between passes. Starts a checkpoint in a thread of its own if it is time for one or the user has asked for one.
    // Writing takes at most a hundredth of the time. What cannot be written is said so on stderr, and the render goes on.
    void offer(Renderer& renderer, bool asked);
    // Waits for the one under way, but not for the command, which may never end.
    void finish();
    // Gives up the one under way, without waiting for that: the film itself will be there soon.
    void abandon() { abandoned_ = true; }
    std::optional<WrittenCheckpoint> lastWritten() const;

private:
    void begin(Renderer& renderer);
    std::optional<double> write(const Checkpoint& checkpoint) const;
    void fail(const std::exception& error);
    void runCommand();

    CheckpointOptions options_;
    std::filesystem::path output_;
    std::function<void(Checkpoint&)> label_;
    bool asked_ = false;                    // by the user, and not done yet
    Clock::time_point last_;                // when the last one began
    double samplesPerPixel_ = 0.0;          // of that one
    std::optional<double> writtenSamples_;  // the same of the last one that was written
    Clock::time_point written_;
    double interval_ = 0.0;                       // seconds; the first checkpoint comes with the first finished block
    std::future<std::optional<double>> writing_;  // gives the seconds that it took, or nothing if it was given up
    std::atomic<bool> abandoned_ = false;
    std::future<void> command_;
    RepeatedMessage failed_, commandFailed_;
};

}  // namespace glim
