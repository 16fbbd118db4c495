// A file that appears complete under its name or not at all: written beside the target under a temporary name, synced to
// the disk and renamed by `commit`. Without `commit` nothing remains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace glim {

// Refuses (InputError) a target that could not be written: another extension than `extension` (".exr", upper or lower
// case; empty: any), a missing folder, a directory or device in its place, no permission. Creates and changes nothing.
void checkWritable(const std::filesystem::path& path, std::string_view extension);

class WholeFile {
public:
    explicit WholeFile(const std::filesystem::path& path);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(const void* bytes, std::size_t count);
    std::uint64_t tell() const { return position_; }
    void seek(std::uint64_t position);
    void commit();

private:
    [[noreturn]] void fail() const;  // with the system's reason from errno

    std::filesystem::path name_;    // as given, for messages
    std::filesystem::path target_;  // behind symbolic links, which stay
    std::filesystem::path temporary_;
    std::uint64_t position_ = 0;
    int descriptor_ = -1;
};

}  // namespace glim
