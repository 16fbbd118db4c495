#include "host/gpu/pipeline_cache.hpp"

#include "host/atomic_file.hpp"
#include "host/digest.hpp"
#include "host/error.hpp"
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
#include <vector>

namespace fs = std::filesystem;

namespace glim {
namespace {

constexpr std::string_view kEnding = ".kernels";
constexpr std::size_t kDigestLength = 64;

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string headerFor(std::string_view key) { return "glim's compiled kernels, format 1\n" + std::string(key) + '\n'; }

std::string digestOf(std::string_view header, std::string_view cache)
{
    Digest digest;
    digest.add(bytesOf(header));
    digest.add(bytesOf(cache));
    return digest.finish();
}

std::string describeDriver(VkPhysicalDevice physical)
{
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceProperties& device = properties.properties;
    std::string key = format("vendor %u, device %u, driver %u, API %u, cache ", device.vendorID, device.deviceID, device.driverVersion,
                             device.apiVersion);
    for (const std::uint8_t byte : device.pipelineCacheUUID) {
        key += format("%02x", byte);
    }
    return key + ", " + device.deviceName + ", " + driver.driverName + " " + driver.driverInfo;
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

fs::path fileFor(std::string_view key)
{
    const fs::path folder = cacheFolder();
    Fingerprint print;
    print.addBytes(bytesOf(key));
    return folder.empty() ? fs::path() : folder / (hexadecimal(print.state()) + std::string(kEnding));
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
    } else if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && static_cast<std::uint64_t>(status.st_size) <= PipelineCache::kMaxBytes) {
        bytes.resize(static_cast<std::size_t>(status.st_size));
        std::size_t count = 0;
        for (ssize_t got = 1; got > 0 && count < bytes.size(); count += static_cast<std::size_t>(std::max<ssize_t>(got, 0))) {
            got = read(descriptor, bytes.data() + count, bytes.size() - count);
        }
        bytes.resize(count);
    }
    close(descriptor);
    return bytes;
}

// Removes the files that were written longest ago, until those left have at most kMaxBytes.
void removeOldest(const fs::path& folder)
{
    struct Entry {
        fs::file_time_type written;
        std::uint64_t bytes;
        fs::path path;
    };
    std::vector<Entry> entries;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        if (i->path().extension() == kEnding) {
            std::error_code ignored;
            const Entry entry{i->last_write_time(ignored), i->file_size(ignored), i->path()};
            if (!ignored) {
                entries.push_back(entry);
            }
        }
    }
    std::ranges::sort(entries, std::ranges::greater(), &Entry::written);
    std::uint64_t kept = 0;
    for (const Entry& entry : entries) {
        kept += entry.bytes;
        if (kept > PipelineCache::kMaxBytes) {
            fs::remove(entry.path, error);
        }
    }
}

}  // namespace

std::string sealCache(std::string_view key, std::string_view cache)
{
    const std::string header = headerFor(key);
    return header + digestOf(header, cache) + std::string(cache);
}

std::optional<std::string_view> openCache(std::string_view key, std::string_view file)
{
    const std::string header = headerFor(key);
    if (!file.starts_with(header) || file.size() < header.size() + kDigestLength) {
        return {};
    }
    const std::string_view digest = file.substr(header.size(), kDigestLength), cache = file.substr(header.size() + kDigestLength);
    return digest == digestOf(header, cache) ? std::optional(cache) : std::nullopt;
}

PipelineCache::PipelineCache(VkPhysicalDevice physical, VkDevice device)
    : device_(device),
      key_(describeDriver(physical)),
      file_(fileFor(key_))
{
    const std::string file = readOwn(file_);
    const std::string_view cache = openCache(key_, file).value_or("");
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = cache.size();
    info.pInitialData = cache.data();
    if (vkCreatePipelineCache(device_, &info, nullptr, &handle_) != VK_SUCCESS) {
        handle_ = VK_NULL_HANDLE;
    }
    written_ = size();
}

PipelineCache::~PipelineCache()
{
    write();
    vkDestroyPipelineCache(device_, handle_, nullptr);
}

std::size_t PipelineCache::size() const
{
    std::size_t bytes = 0;
    return handle_ != VK_NULL_HANDLE && vkGetPipelineCacheData(device_, handle_, &bytes, nullptr) == VK_SUCCESS ? bytes : 0;
}

void PipelineCache::write() noexcept
{
    try {
        std::string cache(size(), '\0');
        std::size_t bytes = cache.size();
        if (file_.empty() || bytes <= written_ || vkGetPipelineCacheData(device_, handle_, &bytes, cache.data()) != VK_SUCCESS) {
            return;
        }
        written_ = bytes;
        const std::string sealed = sealCache(key_, std::string_view(cache).substr(0, bytes));
        std::error_code ignored;
        if (sealed.size() > kMaxBytes) {
            fs::remove(file_, ignored);
        } else if (makeCacheFolder(file_.parent_path())) {
            AtomicFile file(file_, FileAccess::Private);
            file.write(sealed.data(), sealed.size());
            file.commit();
            removeOldest(file_.parent_path());
        }
    } catch (const std::exception&) {  // the disk is full, say, or there is no memory for a copy
        return;
    }
}

}  // namespace glim
