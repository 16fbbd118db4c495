#include "host/atomic_file.hpp"

#include "host/error.hpp"
#include "host/fingerprint.hpp"
#include "host/text.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace glim {
namespace {

[[noreturn]] void refuse(const fs::path& path, MessageId id, std::initializer_list<MessagePart> reason)
{
    const Message message(id, reason);
    throw InputError(Message(message, {part::file(path), ": cannot be written: ", message.sentence, "."}));
}

[[noreturn]] void refuseByErrno(const fs::path& path) { refuse(path, MessageId::FileUnwritable, {part::value(std::strerror(errno))}); }

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// Asks for the effective user's permission, while access() asks for the real user's.
bool mayWrite(const fs::path& path) { return faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0; }

void checkTarget(const fs::path& path, const fs::path& target)
{
    if (path.empty()) {
        throw InputError(MessageId::Missing, {"An empty file name cannot be written."});
    }
    std::error_code error;
    const fs::path folder = folderOf(target);
    const fs::file_status folderStatus = fs::status(folder, error);
    if (!fs::exists(folderStatus)) {
        refuse(path, MessageId::FileMissing, {"the folder ", part::value(folder), " does not exist"});
    }
    if (!fs::is_directory(folderStatus)) {
        refuse(path, MessageId::WrongType, {part::value(folder), " is not ", part::expected("a folder")});
    }
    const fs::file_status status = fs::status(target, error);
    if (fs::is_symlink(target, error)) {
        refuse(path, MessageId::Cycle, {"its links are not followed, or lead in a circle"});
    }
    if (fs::is_directory(status) || !target.has_filename()) {
        refuse(path, MessageId::WrongType, {"it is ", part::value("a folder")});
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        refuse(path, MessageId::WrongType, {"it exists and is not ", part::expected("a regular file")});
    }
    if (fs::exists(status) && !mayWrite(target)) {
        refuseByErrno(path);
    }
    if (!mayWrite(folder)) {
        refuse(path, MessageId::FileUnwritable, {"in the folder ", part::place(folder), ": ", part::value(std::strerror(errno))});
    }
}

// Removes what a killed process has left. False if the file is another's: of a process that is about to rename it, or not of glim.
bool removeLeftover(const fs::path& path)
{
    const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
        return errno == ENOENT;
    }
    struct stat status = {};
    const bool isOurs = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid();
    const bool isLeft = isOurs && flock(file, LOCK_EX | LOCK_NB) == 0;
    const bool isGone = isLeft && (!isFileAt(path, file) || unlink(path.c_str()) == 0);
    close(file);
    return isGone;
}

std::uint64_t randomBits()
{
    std::uint64_t bits = 0;
    static_cast<void>(!getrandom(&bits, sizeof bits, 0));  // 0 where the kernel has no such call
    return bits;
}

// Calls make(name), which makes a file beside `target` or fails as open does, until it succeeds. One name per target, so that a leftover is
// found; while that is taken, others that nobody can foresee and take. Returns the name, or none if it failed for another reason.
fs::path nameBeside(const fs::path& target, const std::function<bool(const fs::path&)>& make)
{
    constexpr int kMaxNames = 100;
    for (int i = 0; i < kMaxNames; ++i) {
        const fs::path name = hiddenBeside(target, (i == 0 ? "" : "." + hexadecimal(randomBits())) + ".partial");
        do {
            if (make(name)) {
                return name;
            }
            if (errno != EEXIST) {
                return {};
            }
        } while (removeLeftover(name));
    }
    errno = EEXIST;
    return {};
}

// Else a power cut might bring the old file back. Some file systems cannot, and are left alone.
void syncFolder(const fs::path& folder)
{
    const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file >= 0) {
        fsync(file);
        close(file);
    }
}

// Owner and group are kept as far as the process may. Where the group is another, it gets what all others have.
void keepMode(int file, const fs::path& replaced)
{
    struct stat old = {}, now = {};
    if (stat(replaced.c_str(), &old) != 0) {
        return;
    }
    if (fchown(file, old.st_uid, old.st_gid) != 0) {
        static_cast<void>(!fchown(file, static_cast<uid_t>(-1), old.st_gid));
    }
    const bool sameGroup = fstat(file, &now) == 0 && now.st_gid == old.st_gid;
    const mode_t others = old.st_mode & S_IRWXO;
    fchmod(file, sameGroup ? old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO) : (old.st_mode & S_IRWXU) | others << 3U | others);
}

}  // namespace

fs::path followLinks(fs::path path)
{
    constexpr int kMaxLinks = 40;  // as Linux
    std::error_code ignored;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(path, ignored); ++i) {
        path = path.parent_path() / fs::read_symlink(path, ignored);
    }
    return path;
}

fs::path hiddenBeside(const fs::path& target, const std::string& ending)
{
    Fingerprint print;
    const std::string name = target.filename().string();
    print.addBytes(std::as_bytes(std::span(name)));
    return folderOf(target) / (".glim-" + hexadecimal(print.state()) + ending);
}

bool isFileAt(const fs::path& path, int descriptor)
{
    struct stat open = {}, named = {};
    return fstat(descriptor, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

void checkWritable(const fs::path& path) { checkTarget(path, followLinks(path)); }

AtomicFile::AtomicFile(const fs::path& path, FileAccess rights)
    : access_(rights),
      name_(path),
      target_(rights == FileAccess::Private ? path : followLinks(path))
{
    checkTarget(path, target_);
    const mode_t mode = rights == FileAccess::Private ? S_IRUSR | S_IWUSR : 0666;
    const fs::path folder = folderOf(target_);
    // Has no name until it is whole, so nothing is left of it whatever happens. Some file systems lack this.
    const bool canLink = access("/proc/self/fd", X_OK) == 0;
    descriptor_ = canLink ? open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, mode) : -1;
    if (descriptor_ < 0 && (!canLink || errno == EOPNOTSUPP || errno == EISDIR || errno == ENOENT)) {
        temporary_ = nameBeside(target_, [this, mode](const fs::path& name) {
            descriptor_ = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            // A leftover is not locked. Somebody may have taken the file for one just now.
            const bool isTaken = descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
            if (isTaken || (descriptor_ >= 0 && !isFileAt(name, descriptor_))) {
                close(std::exchange(descriptor_, -1));
                errno = EEXIST;
            }
            return descriptor_ >= 0;
        });
    }
    if (descriptor_ < 0) {
        fail();
    }
}

AtomicFile::~AtomicFile()
{
    if (descriptor_ >= 0 && !temporary_.empty()) {
        unlink(temporary_.c_str());
    }
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

void AtomicFile::write(const void* bytes, std::size_t count)
{
    const char* begin = static_cast<const char*>(bytes);
    buffer_.insert(buffer_.end(), begin, begin + count);
    position_ += count;
    if (buffer_.size() >= kBufferBytes) {
        flush();
    }
}

void AtomicFile::flush()
{
    const char* rest = buffer_.data();
    std::size_t count = buffer_.size();
    while (count > 0) {
        const ssize_t written = ::write(descriptor_, rest, count);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            fail();
        }
        rest += written;
        count -= static_cast<std::size_t>(written);
    }
    buffer_.clear();
}

void AtomicFile::seek(std::uint64_t position)
{
    flush();
    if (lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) {
        fail();
    }
    position_ = position;
}

void AtomicFile::commit()
{
    flush();
    if (access_ == FileAccess::ByUmask) {
        keepMode(descriptor_, target_);
    }
    if (fsync(descriptor_) != 0) {
        fail();
    }
    if (temporary_.empty()) {
        // Whoever replaces a target holds this lock meanwhile: a temporary name that nobody has locked is left from a killed process.
        flock(descriptor_, LOCK_EX);
        const std::string open = "/proc/self/fd/" + std::to_string(descriptor_);
        temporary_ = nameBeside(target_, [&open](const fs::path& name) {
            return linkat(AT_FDCWD, open.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
        });
        if (temporary_.empty()) {
            fail();
        }
    }
    if (rename(temporary_.c_str(), target_.c_str()) != 0) {
        fail();
    }
    close(descriptor_);
    descriptor_ = -1;
    syncFolder(folderOf(target_));
}

void AtomicFile::fail() const { refuseByErrno(name_); }

}  // namespace glim
