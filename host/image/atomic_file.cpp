#include "host/image/atomic_file.hpp"

#include "host/error.hpp"
#include "host/fingerprint.hpp"
#include "host/text.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

namespace fs = std::filesystem;

namespace glim {
namespace {

[[noreturn]] void refuse(const fs::path& path, const std::string& reason)
{
    throw InputError(path.string() + ": cannot be written: " + reason + ".");
}

std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return text;
}

// Follows symbolic links, also to a file that does not exist yet. For links in a circle the result is a link, which is refused later.
fs::path followLinks(fs::path path)
{
    constexpr int kMostLinks = 40;  // as Linux
    std::error_code ignored;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, ignored); ++i) {
        path = path.parent_path() / fs::read_symlink(path, ignored);
    }
    return path;
}

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// Asks for the effective user's permission, while access() asks for the real user's.
bool mayWrite(const fs::path& path) { return faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0; }

void checkTarget(const fs::path& path, const fs::path& target)
{
    std::error_code error;
    const fs::path folder = folderOf(target);
    const fs::file_status folderStatus = fs::status(folder, error);
    if (!fs::exists(folderStatus)) {
        refuse(path, "the folder " + folder.string() + " does not exist");
    }
    if (!fs::is_directory(folderStatus)) {
        refuse(path, folder.string() + " is not a folder");
    }
    const fs::file_status status = fs::status(target, error);
    if (fs::is_symlink(target, error)) {
        refuse(path, "its links lead in a circle");
    }
    if (fs::is_directory(status) || !target.has_filename()) {
        refuse(path, "it is a folder");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        refuse(path, "it exists and is not a regular file");
    }
    if (fs::exists(status) && !mayWrite(target)) {
        refuse(path, std::strerror(errno));
    }
    if (!mayWrite(folder)) {
        refuse(path, "in the folder " + folder.string() + ": " + std::strerror(errno));
    }
}

// One per target, so that a leftover is found. Hidden, and never too long.
std::string temporaryName(const fs::path& target)
{
    Fingerprint print;
    const std::string name = target.filename().string();
    print.addBytes(std::as_bytes(std::span(name)));
    return ".glim-" + hexadecimal(print.state()) + ".partial";
}

// Waits for the process that is about to rename the file, if there is one, and removes what a killed one has left.
void removeLeftover(const fs::path& path)
{
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return;
    }
    flock(file, LOCK_EX);
    if (isFileAt(path, file)) {
        unlink(path.c_str());
    }
    close(file);
}

// Locked, unlike a leftover.
int openNew(const fs::path& path)
{
    int file = -1;
    do {
        file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno == EEXIST) {
            removeLeftover(path);
            errno = EEXIST;
        }
    } while (file < 0 && errno == EEXIST);
    if (file >= 0) {
        flock(file, LOCK_EX);
    }
    return file;
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

}  // namespace

bool isFileAt(const fs::path& path, int descriptor)
{
    struct stat open = {}, named = {};
    return fstat(descriptor, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

void checkWritable(const fs::path& path, std::string_view extension)
{
    if (path.empty()) {
        throw InputError("An empty file name cannot be written.");
    }
    if (!extension.empty() && lowerCase(path.extension().string()) != extension) {
        refuse(path, "its name does not end in " + std::string(extension));
    }
    checkTarget(path, followLinks(path));
}

AtomicFile::AtomicFile(const fs::path& path)
    : name_(path),
      target_(followLinks(path))
{
    checkWritable(path, "");
    const fs::path folder = folderOf(target_);
    temporary_ = folder / temporaryName(target_);
    // Has no name until it is whole, so nothing is left of it whatever happens. Some file systems lack this.
    const bool canLink = access("/proc/self/fd", X_OK) == 0;
    descriptor_ = canLink ? open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666) : -1;
    if (descriptor_ < 0 && (!canLink || errno == EOPNOTSUPP || errno == EISDIR || errno == ENOENT)) {
        named_ = true;
        descriptor_ = openNew(temporary_);
    }
    if (descriptor_ < 0) {
        fail();
    }
}

AtomicFile::~AtomicFile()
{
    if (descriptor_ >= 0 && named_) {
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
    if (fsync(descriptor_) != 0) {
        fail();
    }
    if (!named_) {
        // Whoever replaces a target holds this lock meanwhile: a temporary name that nobody has locked is left from a killed process.
        flock(descriptor_, LOCK_EX);
        const std::string open = "/proc/self/fd/" + std::to_string(descriptor_);
        while (linkat(AT_FDCWD, open.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
            if (errno != EEXIST) {
                fail();
            }
            removeLeftover(temporary_);
        }
        named_ = true;
    }
    if (rename(temporary_.c_str(), target_.c_str()) != 0) {
        fail();
    }
    close(descriptor_);
    descriptor_ = -1;
    syncFolder(folderOf(target_));
}

void AtomicFile::fail() const { refuse(name_, std::strerror(errno)); }

}  // namespace glim
