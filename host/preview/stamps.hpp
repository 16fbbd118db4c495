// Files that are watched, since others change them while glim runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

namespace glim {

struct FileStamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const FileStamp&) const = default;
};

// Absent while the file is missing, as it is for a moment when some editors save.
inline std::optional<FileStamp> readStamp(const std::filesystem::path& file)
{
    std::error_code missing;
    FileStamp stamp{std::filesystem::last_write_time(file, missing)};
    if (missing) {
        return {};
    }
    if (std::filesystem::is_regular_file(file, missing)) {
        stamp.size = std::filesystem::file_size(file, missing);
    }
    return stamp;
}

// `Stamps` are those of some files.
template <class Stamps>
class StampWatch {
public:
    StampWatch(std::chrono::milliseconds interval, Stamps seen)
        : interval_(interval),
          seen_(std::move(seen)),
          lastRead_(std::chrono::steady_clock::now())
    {}

    // Whether they differ from those that are `known` and then stayed the same for one interval: a program may still write the files. Reads
    // them by `read`, once in an interval.
    template <class Read>
    bool hasChanged(const Stamps& known, const Read& read)
    {
        const auto now = std::chrono::steady_clock::now();
        if (now - lastRead_ < interval_) {
            return false;
        }
        lastRead_ = now;
        const Stamps before = std::exchange(seen_, read());
        return seen_ == before && seen_ != known;
    }
    // Those that were read last.
    const Stamps& seen() const { return seen_; }

private:
    std::chrono::milliseconds interval_;
    Stamps seen_;
    std::chrono::steady_clock::time_point lastRead_;
};

}  // namespace glim
