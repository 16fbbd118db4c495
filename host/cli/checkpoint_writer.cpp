#include "host/cli/checkpoint_writer.hpp"

#include "host/cli/parse.hpp"
#include "host/error.hpp"
#include "host/image/atomic_file.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace glim {
namespace {

constexpr double kDefaultInterval = 300.0;
constexpr double kMostShare = 0.01;  // of the time, for writing

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void addCheckpoint(const Command& command, CheckpointOptions& options)
{
    command.add("--checkpoint", "TIME", "Write the film so far this often, as in 90s, 5m or 1h [5m with --resume]",
                [&options](const std::string& text) { options.seconds = parseDuration("--checkpoint", text); });
    command.addFlag("--resume", "Continue the film at --output if there is one", options.resume);
    command.add("--on-checkpoint", "COMMAND", "Run by the shell after each checkpoint, with its name in GLIM_FILM",
                [&options](const std::string& text) { options.command = text; });
}

CheckpointWriter::CheckpointWriter(const CheckpointOptions& options, std::filesystem::path output, std::function<void(Film&)> label)
    : options_(options),
      output_(std::move(output)),
      label_(std::move(label)),
      last_(Clock::now())
{
    setenv("GLIM_FILM", output_.c_str(), 1);  // of the command; here, while no other thread reads the environment
}

CheckpointWriter::~CheckpointWriter() { finish(); }

void CheckpointWriter::offer(const Renderer& renderer, bool asked)
{
    asked_ = asked_ || asked;
    if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return;
    }
    finish();
    if (!asked_ && !(options_.isGiven() && secondsSince(last_) >= interval_)) {
        return;
    }
    std::optional<Checkpoint> checkpoint = renderer.checkpoint();
    if (!checkpoint) {
        return;
    }
    asked_ = false;
    last_ = Clock::now();
    samplesPerPixel_ = static_cast<double>(renderer.pictureSamples()) / static_cast<double>(checkpoint->film.pixels.size());
    label_(checkpoint->film);
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
            interval_ = std::max(interval_, *seconds / kMostShare);
            writtenSamples_ = samplesPerPixel_;
            written_ = Clock::now();
        }
    } catch (const InputError& error) {
        say("no checkpoint: " + std::string(error.what()));
    }
}

std::optional<WrittenCheckpoint> CheckpointWriter::lastWritten() const
{
    return writtenSamples_ ? std::optional(WrittenCheckpoint{*writtenSamples_, secondsSince(written_)}) : std::nullopt;
}

std::optional<double> CheckpointWriter::write(const Checkpoint& checkpoint) const
{
    const auto start = Clock::now();
    if (!writeFilm(output_, filmOf(checkpoint), checkpoint, [this] { return !abandoned_; })) {
        return std::nullopt;
    }
    const double seconds = secondsSince(start);
    if (!options_.command.empty()) {
        if (const int status = std::system(options_.command.c_str()); status != 0) {
            say("--on-checkpoint: the command failed with status " + std::to_string(status >> 8));
        }
    }
    return seconds;
}

OutputLock::OutputLock(const std::filesystem::path& output)
    : path_(output.string() + ".lock")
{
    do {
        if (file_ >= 0) {
            close(file_);  // its owner has removed it between our two calls
        }
        file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file_ < 0) {
            throw InputError(path_.string() + ": cannot be made: " + std::strerror(errno) + ".");
        }
        if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
            char process[16] = {};
            const ssize_t length = read(file_, process, sizeof process - 1);
            close(file_);
            throw InputError(output.string() + ": is written by another glim" +
                             (length > 0 ? ", process " + std::string(process) : std::string()) + "; expected only one.");
        }
    } while (!isFileAt(path_, file_));
    const std::string process = std::to_string(getpid());
    if (ftruncate(file_, 0) != 0 || write(file_, process.data(), process.size()) < 0) {
        say(path_.string() + " cannot be written, so another glim will not learn who holds it");
    }
}

OutputLock::~OutputLock()
{
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    close(file_);
}

}  // namespace glim
