#include "host/image/atomic_file.hpp"

#include "host/error.hpp"

#include <fcntl.h>
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

}  // namespace

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
    const std::string stem = ".glim-" + std::to_string(getpid()) + "-";
    for (unsigned attempt = 0; descriptor_ < 0; ++attempt) {
        temporary_ = folderOf(target_) / (stem + std::to_string(attempt) + ".partial");
        descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST) {
            fail();
        }
    }
}

AtomicFile::~AtomicFile()
{
    if (descriptor_ >= 0) {
        close(descriptor_);
        unlink(temporary_.c_str());
    }
}

void AtomicFile::write(const void* bytes, std::size_t count)
{
    const char* rest = static_cast<const char*>(bytes);
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
        position_ += static_cast<std::uint64_t>(written);
    }
}

void AtomicFile::seek(std::uint64_t position)
{
    if (lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) {
        fail();
    }
    position_ = position;
}

void AtomicFile::commit()
{
    if (fsync(descriptor_) != 0 || rename(temporary_.c_str(), target_.c_str()) != 0) {
        fail();
    }
    close(descriptor_);
    descriptor_ = -1;
}

void AtomicFile::fail() const { refuse(name_, std::strerror(errno)); }

}  // namespace glim
