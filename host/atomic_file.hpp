// A file that appears under its name either complete or not at all. It is written beside the target without a name; `commit` syncs it to
// the disk, gives it a temporary name and renames it. It keeps the mode of the file that it replaces; a new one has that of the umask.
// Without `commit` nothing remains, even of a killed process. One that is killed within `commit` may leave the temporary name, which the
// next write to the target removes.
//
// A private file is for its user alone (mode 0600, whatever was there), and no link of its name is followed: that is refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glim {

// Throws InputError if `path` could not be written: its folder is missing, a folder or a device has its name, or permission is missing.
// Creates and changes nothing.
void checkWritable(const std::filesystem::path& path);

// Follows symbolic links, also to a file that does not exist yet. For links in a circle the result is a link.
std::filesystem::path followLinks(std::filesystem::path path);

// A name beside `target`, a name without links. One per target and ending, hidden, and never too long.
std::filesystem::path hiddenBeside(const std::filesystem::path& target, const std::string& ending);

// Whether the open file is still the one of this name.
bool isFileAt(const std::filesystem::path& path, int descriptor);

enum class FileAccess { ByUmask, Private };

class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& path, FileAccess rights = FileAccess::ByUmask);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t count);
    std::uint64_t tell() const { return position_; }
    void seek(std::uint64_t position);
    void commit();
    // For another program that writes the file in place of write().
    int descriptor() const { return descriptor_; }

private:
    static constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

    void flush();
    [[noreturn]] void fail() const;  // throws InputError with the reason from errno

    FileAccess access_;
    std::filesystem::path name_;       // as the caller gave it, for messages
    std::filesystem::path target_;     // after following symbolic links, which stay as they are
    std::filesystem::path temporary_;  // empty while the file has no name
    std::vector<char> buffer_;         // written, but not to the file yet
    std::uint64_t position_ = 0;
    int descriptor_ = -1;
};

}  // namespace glim
