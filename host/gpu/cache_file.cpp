#include "host/gpu/cache_file.hpp"

#include "host/atomic_file.hpp"
#include "host/digest.hpp"
#include "host/fingerprint.hpp"
#include "host/text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <span>
#include <utility>
#include <vector>

namespace fs = std::filesystem;

namespace glim {
namespace {

constexpr std::size_t kDigestLength = 64;

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string headerFor(std::string_view key) { return "glim's compiled kernels, format 1\n" + std::string(key) + '\n'; }

std::string digestOf(std::string_view header, std::string_view content)
{
    Digest digest;
    digest.add(bytesOf(header));
    digest.add(bytesOf(content));
    return digest.finish();
}

// Empty where nothing is to be kept: GLIM_CACHE_DIR is empty, or there is no home.
fs::path cacheFolder()
{
    if (const char* given = std::getenv("GLIM_CACHE_DIR")) {
        return given;
    }
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    if (cache != nullptr && fs::path(cache).is_absolute()) {  // relative paths are to be ignored (XDG Base Directory 0.8)
        return fs::path(cache) / "glim";
    }
    return home != nullptr && *home != '\0' ? fs::path(home) / ".cache" / "glim" : fs::path();
}

// Also the folders above it, as the XDG Base Directory Specification 0.8 wants them.
void makePrivate(const fs::path& folder)
{
    if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno == ENOENT && folder.has_relative_path() && folder.has_parent_path()) {
        makePrivate(folder.parent_path());
        mkdir(folder.c_str(), S_IRWXU);
    }
}

// Makes the folder, for this user alone, if there is none. False if that fails, or if the folder is another user's.
bool makeCacheFolder(const fs::path& folder)
{
    makePrivate(folder);
    struct stat status = {};
    return stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid();
}

fs::path pathFor(std::string_view key, std::string_view ending)
{
    const fs::path folder = cacheFolder();
    Fingerprint print;
    print.addBytes(bytesOf(key));
    return folder.empty() ? fs::path() : folder / (hexadecimal(print.state()) + std::string(ending));
}

// The file if it is a regular one that this user alone can have written. Clears `file` if something else has its name, which is left alone.
std::string readOwn(fs::path& file)
{
    const int descriptor = file.empty() ? -1 : open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        if (errno != ENOENT) {
            file.clear();
        }
        return {};
    }
    struct stat status = {};
    std::string bytes;
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != geteuid()) {
        file.clear();
    } else if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && static_cast<std::uint64_t>(status.st_size) <= CacheFile::kMaxBytes) {
        bytes.resize(static_cast<std::size_t>(status.st_size));
        std::size_t count = 0;
        for (ssize_t got = 1; got > 0 && count < bytes.size(); count += static_cast<std::size_t>(std::max<ssize_t>(got, 0))) {
            got = read(descriptor, bytes.data() + count, bytes.size() - count);
        }
        bytes.resize(count);
        futimens(descriptor, nullptr);  // those that were used longest ago go first
    }
    close(descriptor);
    return bytes;
}

// Of the files with this ending removes those that were used longest ago, until those left have at most kMaxBytes.
void removeOldest(const fs::path& folder, std::string_view ending)
{
    struct Entry {
        fs::file_time_type used;
        std::uint64_t bytes;
        fs::path path;
    };
    std::vector<Entry> entries;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        if (i->path().extension() == ending) {
            std::error_code ignored;
            const Entry entry{i->last_write_time(ignored), i->file_size(ignored), i->path()};
            if (!ignored) {
                entries.push_back(entry);
            }
        }
    }
    std::ranges::sort(entries, std::ranges::greater(), &Entry::used);
    std::uint64_t kept = 0;
    for (const Entry& entry : entries) {
        kept += entry.bytes;
        if (kept > CacheFile::kMaxBytes) {
            fs::remove(entry.path, error);
        }
    }
}

}  // namespace

std::string sealCache(std::string_view key, std::string_view content)
{
    const std::string header = headerFor(key);
    return header + digestOf(header, content) + std::string(content);
}

std::optional<std::string_view> openCache(std::string_view key, std::string_view file)
{
    const std::string header = headerFor(key);
    if (!file.starts_with(header) || file.size() < header.size() + kDigestLength) {
        return {};
    }
    const std::string_view digest = file.substr(header.size(), kDigestLength), content = file.substr(header.size() + kDigestLength);
    return digest == digestOf(header, content) ? std::optional(content) : std::nullopt;
}

CacheFile::CacheFile(std::string key, std::string_view ending)
    : key_(std::move(key)),
      ending_(ending),
      path_(pathFor(key_, ending))
{}

std::string CacheFile::read()
{
    const std::string file = readOwn(path_);
    return std::string(openCache(key_, file).value_or(""));
}

void CacheFile::write(std::string_view content) const noexcept
{
    try {
        const std::string sealed = sealCache(key_, content);
        std::error_code ignored;
        if (sealed.size() > kMaxBytes) {
            fs::remove(path_, ignored);
        } else if (makeCacheFolder(path_.parent_path())) {
            AtomicFile file(path_, FileAccess::Private);
            file.write(sealed.data(), sealed.size());
            file.commit();
            removeOldest(path_.parent_path(), ending_);
        }
    } catch (const std::exception&) {  // the disk is full, say, or there is no memory for a copy
        return;
    }
}

}  // namespace glim
