#include "host/job/output_lock.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace fs = std::filesystem;

namespace glim {
namespace {

// A lock has one line: this and the process. It is empty for a moment after it was made.
constexpr std::string_view kOwner = "glim ";

// What a lock says: the process, or nothing if it is empty. No text if the file is not glim's.
std::optional<std::string> ownerOf(int file)
{
    struct stat status = {};
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    if (status.st_size == 0 && status.st_uid == geteuid()) {
        return "";
    }
    char text[32];
    const ssize_t length = pread(file, text, sizeof text, 0);
    std::string_view line(text, static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
    if (!line.starts_with(kOwner) || !line.ends_with('\n')) {
        return std::nullopt;
    }
    line.remove_prefix(kOwner.size());
    line.remove_suffix(1);
    const bool isNumber = std::ranges::all_of(line, [](unsigned char c) { return std::isdigit(c) != 0; });
    return isNumber && !line.empty() ? std::optional<std::string>(line) : std::nullopt;
}

// Another user's file can be read at most. A pipe is not waited for.
int openPresent(const fs::path& path)
{
    constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    const int file = open(path.c_str(), O_RDWR | kFlags);
    return file < 0 && errno == EACCES ? open(path.c_str(), O_RDONLY | kFlags) : file;
}

}  // namespace

OutputLock::OutputLock(const fs::path& output)
    : output_(output),
      path_(hiddenBeside(followLinks(output), ".lock"))
{
    do {
        removeLeftover();
    } while (!make());
}

OutputLock::~OutputLock()
{
    if (file_ >= 0) {
        if (isFileAt(path_, file_)) {
            unlink(path_.c_str());
        }
        close(file_);
    }
}

void OutputLock::removeLeftover() const
{
    const int present = openPresent(path_);
    if (present < 0 && errno == ENOENT) {
        return;
    }
    const auto owner = present < 0 ? std::nullopt : ownerOf(present);
    const bool isHeld = owner && flock(present, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    const bool isRemoved = owner && !isHeld && (!isFileAt(path_, present) || unlink(path_.c_str()) == 0);
    const int error = errno;
    if (present >= 0) {
        close(present);
    }
    if (!owner) {
        refuse(MessageId::UnknownFormat, {"is not glim's lock; expected ", part::expected("no file of this name")});
    }
    if (isHeld) {
        throw InputError(MessageId::FileInUse, {part::file(output_), ": is written by another glim", owner->empty() ? "" : ", process ",
                                                part::value(*owner), "; expected ", part::expected("only one"), "."});
    }
    if (!isRemoved) {
        refuse(MessageId::FileUnwritable, {"was left by an earlier glim and cannot be removed: ", std::strerror(error)});
    }
}

// False if somebody else was faster.
bool OutputLock::make()
{
    const int file = open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) {
        refuse(MessageId::FileUnwritable, {"cannot be made: ", std::strerror(errno)});
    }
    if (file < 0) {
        return false;
    }
    const bool isLocked = flock(file, LOCK_EX | LOCK_NB) == 0;
    if (!isLocked && errno != EWOULDBLOCK) {
        say(MessageId::NotLocked,
            {part::file(path_), " cannot be locked, so another glim may write ", output_.string(), " too: ", std::strerror(errno)});
        unlink(path_.c_str());
        close(file);
        return true;
    }
    if (!isLocked || !isFileAt(path_, file)) {  // it was taken for a leftover
        close(file);
        return false;
    }
    const std::string line = std::string(kOwner) + std::to_string(getpid()) + '\n';
    if (write(file, line.data(), line.size()) < 0) {
        const std::string reason = std::strerror(errno);
        unlink(path_.c_str());
        close(file);
        refuse(MessageId::FileUnwritable, {"cannot be written: ", reason});
    }
    file_ = file;
    return true;
}

void OutputLock::refuse(MessageId id, std::initializer_list<MessagePart> why) const
{
    const Message reason(id, why);
    throw InputError(Message(reason, {part::file(path_), ": ", reason.sentence, "."}));
}

}  // namespace glim
