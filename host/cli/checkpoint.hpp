// Writes a film while it is rendered, so that a later run can continue it.
#pragma once

#include "host/cli/command.hpp"
#include "host/render/renderer.hpp"

#include <chrono>
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

void addCheckpoint(const Command& command, CheckpointOptions& options);

// Whether the user asked for a checkpoint by SIGUSR1 since the last call.
bool takeCheckpointRequest();

class CheckpointWriter {
public:
    // `label`: what is known of the film besides what the renderer knows (scene file, camera).
    CheckpointWriter(const CheckpointOptions& options, std::filesystem::path output, std::function<void(Film&)> label);
    // Waits for the checkpoint under way.
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&) = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    // To be called often. Starts a checkpoint in a thread of its own if there are new samples, and either it is time for one or `now`.
    // Writing takes at most a hundredth of the time. One that cannot be written is said so on stderr, and the render goes on.
    void offer(const Renderer& renderer, bool now);
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    double write(const Film& film) const;

    CheckpointOptions options_;
    std::filesystem::path output_;
    std::function<void(Film&)> label_;
    std::uint64_t version_ = 0;  // of what was written last
    Clock::time_point last_;
    double interval_ = 0.0;        // seconds; the first checkpoint comes with the first page
    std::future<double> writing_;  // gives the seconds that it took
};

// One process at a time may write a file: throws InputError, which names the other process, if there is one. The lock is a file beside
// `output`, which is removed at the end.
class OutputLock {
public:
    explicit OutputLock(const std::filesystem::path& output);
    ~OutputLock();
    OutputLock(const OutputLock&) = delete;
    OutputLock& operator=(const OutputLock&) = delete;

private:
    std::filesystem::path path_;
    int file_ = -1;
};

}  // namespace glim
