#include "host/job/checkpoint_writer.hpp"

#include "host/error.hpp"
#include "host/job/outcome.hpp"
#include "host/job/parse.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace glim {
namespace {

constexpr double kDefaultInterval = 300.0;
constexpr double kMaxShare = 0.01;  // of the time, for writing
constexpr std::chrono::seconds kPatience{2};

template <class Value>
bool isUnderWay(const std::future<Value>& work)
{
    return work.valid() && work.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

}  // namespace

void RepeatedMessage::sayAgain(MessageId id, const std::string& sentence)
{
    if (std::has_single_bit(++times_)) {
        say(id, {sentence, times_ > 1 ? " (" + std::to_string(times_) + " times in a row)" : ""});
    }
}

void addCheckpoint(OptionTable& table, CheckpointOptions& options)
{
    table.add("--checkpoint", "TIME", "Write the film so far this often, as in 90s, 5m or 1h [5m with --resume]",
              [&options](const OptionValue& value) { options.seconds = parseDuration("--checkpoint", value); });
    table.addFlag("--resume", "Continue the film at --output if there is one", options.resume);
    table.addText("--on-checkpoint", "COMMAND", "Shell command to run after each checkpoint; GLIM_FILM is the film's name",
                  options.command);
}

CheckpointWriter::CheckpointWriter(const CheckpointOptions& options, std::filesystem::path output, std::function<void(Checkpoint&)> label)
    : options_(options),
      output_(std::move(output)),
      label_(std::move(label)),
      last_(Clock::now())
{
    setenv("GLIM_FILM", output_.c_str(), 1);  // of the command; here, while no other thread reads the environment
}

CheckpointWriter::~CheckpointWriter()
{
    finish();
    if (command_.valid() && command_.wait_for(kPatience) != std::future_status::ready) {
        say(MessageId::CommandRuns, {part::place("--on-checkpoint"), ": the command still runs and is waited for"});
        command_.wait();
    }
}

void CheckpointWriter::offer(Renderer& renderer, bool asked)
{
    asked_ = asked_ || asked;
    if (isUnderWay(writing_)) {
        return;
    }
    finish();
    if (!isUnderWay(command_) && (asked_ || (options_.isGiven() && secondsSince(last_) >= interval_))) {
        try {
            begin(renderer);
        } catch (const DeviceError&) {
            throw;  // the render cannot go on either
        } catch (const std::exception& error) {
            fail(error);
        }
    }
}

void CheckpointWriter::begin(Renderer& renderer)
{
    std::optional<Checkpoint> checkpoint = renderer.checkpoint();
    if (!checkpoint) {
        return;
    }
    asked_ = false;
    last_ = Clock::now();
    samplesPerPixel_ = static_cast<double>(renderer.plan().pictureSamples()) / static_cast<double>(checkpoint->film.pixels.size());
    label_(*checkpoint);
    writing_ = std::async(std::launch::async, [this, checkpoint = *std::move(checkpoint)] { return write(checkpoint); });
}

void CheckpointWriter::finish()
{
    if (!writing_.valid()) {
        return;
    }
    interval_ = options_.seconds.value_or(kDefaultInterval);
    try {
        if (const std::optional<double> seconds = writing_.get()) {
            interval_ = std::max(interval_, *seconds / kMaxShare);
            writtenSamples_ = samplesPerPixel_;
            written_ = Clock::now();
            failed_.end();
            if (!options_.command.empty()) {
                command_ = std::async(std::launch::async, [this] { runCommand(); });
            }
        }
    } catch (const std::exception& error) {
        fail(error);
    }
}

void CheckpointWriter::fail(const std::exception& error)
{
    asked_ = false;
    last_ = Clock::now();
    interval_ = options_.seconds.value_or(kDefaultInterval);
    failed_.sayAgain(MessageId::NoCheckpoint, "no checkpoint: " + describeReason(error));
}

std::optional<WrittenCheckpoint> CheckpointWriter::lastWritten() const
{
    return writtenSamples_ ? std::optional(WrittenCheckpoint{*writtenSamples_, secondsSince(written_)}) : std::nullopt;
}

std::optional<double> CheckpointWriter::write(const Checkpoint& checkpoint) const
{
    const auto start = Clock::now();
    if (!writeFilm(output_, makeFilm(checkpoint), checkpoint, [this] { return !abandoned_; })) {
        return std::nullopt;
    }
    return secondsSince(start);
}

// std::system would keep SIGINT from glim meanwhile.
void CheckpointWriter::runCommand()
{
    std::string shell = "sh", option = "-c";
    char* const words[] = {shell.data(), option.data(), options_.command.data(), nullptr};
    pid_t process = 0;
    int status = 0;
    if (const int error = posix_spawn(&process, "/bin/sh", nullptr, nullptr, words, environ); error != 0) {
        commandFailed_.sayAgain(MessageId::CommandFailed,
                                "--on-checkpoint: the command cannot be run: " + std::string(std::strerror(error)));
        return;
    }
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (status == 0) {
        commandFailed_.end();
    } else if (WIFSIGNALED(status)) {
        commandFailed_.sayAgain(MessageId::CommandFailed,
                                "--on-checkpoint: the command was ended by signal " + std::to_string(WTERMSIG(status)));
    } else {
        commandFailed_.sayAgain(MessageId::CommandFailed,
                                "--on-checkpoint: the command failed with status " + std::to_string(WEXITSTATUS(status)));
    }
}

}  // namespace glim
