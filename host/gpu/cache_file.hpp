// What a run keeps on disk for the next: in $GLIM_CACHE_DIR, $XDG_CACHE_HOME/glim or ~/.cache/glim. A file begins with its key and a
// digest, and no byte of one that does not fit both is used: a driver that is handed damaged code may do anything. What is wrong with a
// file, or keeps it from being written, is no error: what it has is made again.
//
// Processes that write at the same time replace each other's files, which are whole at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace glim {

// Content as a file for this key, and the content of such a file. None if the file is damaged or for another key.
std::string sealCache(std::string_view key, std::string_view content);
std::optional<std::string_view> openCache(std::string_view key, std::string_view file);

class CacheFile {
public:
    // The files with one ending together, in bytes. Those that were used longest ago go first. One that is larger itself is removed.
    static constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;

    // `ending`: of all files of a kind, as in ".kernels".
    CacheFile(std::string key, std::string_view ending);

    // Empty if there is none.
    std::string read();
    // Whether it is kept: there is a folder for it, and nothing else has its name.
    bool isKept() const { return !path_.empty(); }
    void write(std::string_view content) const noexcept;

private:
    std::string key_, ending_;
    std::filesystem::path path_;  // empty where it is not kept
};

}  // namespace glim
