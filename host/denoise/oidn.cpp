#include "host/denoise/oidn.hpp"

#include "host/error.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <initializer_list>

namespace fs = std::filesystem;

namespace glim {
namespace {

// Of OIDN's C interface.
constexpr int kCpuDevice = 1, kFloat3 = 3;

fs::path libraryAt(const fs::path& path)
{
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) {
        return path;
    }
    const char* kName = "libOpenImageDenoise.so.2";
    for (const char* folder : {"", "lib", "oidn/lib"}) {
        if (fs::exists(path / folder / kName, ignored)) {
            return path / folder / kName;
        }
    }
    throw InputError(MessageId::LibraryMissing,
                     {part::file(path), ": this folder has no ", part::expected(kName), "; Python's package pyoidn has one."});
}

}  // namespace

// The functions that glim calls.
struct Oidn::Api {
    explicit Api(const fs::path& path)
        : library(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
    {
        if (library == nullptr) {
            const std::string reason = dlerror();
            std::error_code ignored;
            throw InputError(fs::exists(path, ignored) ? MessageId::LibraryFailed : MessageId::LibraryMissing,
                             {part::file(path), ": Open Image Denoise cannot be loaded: ", part::value(reason), "."});
        }
        load(newDevice, "oidnNewDevice", path);
        load(commitDevice, "oidnCommitDevice", path);
        load(releaseDevice, "oidnReleaseDevice", path);
        load(getDeviceError, "oidnGetDeviceError", path);
        load(getDeviceInt, "oidnGetDeviceInt", path);
        load(newFilter, "oidnNewFilter", path);
        load(setImage, "oidnSetSharedFilterImage", path);
        load(setBool, "oidnSetFilterBool", path);
        load(commitFilter, "oidnCommitFilter", path);
        load(executeFilter, "oidnExecuteFilter", path);
        load(releaseFilter, "oidnReleaseFilter", path);
    }
    ~Api() { dlclose(library); }
    Api(const Api&) = delete;
    Api& operator=(const Api&) = delete;

    template <class Function>
    void load(Function& function, const char* name, const fs::path& path)
    {
        function = reinterpret_cast<Function>(dlsym(library, name));
        if (function == nullptr) {
            dlclose(library);
            throw InputError(MessageId::LibraryFailed,
                             {part::file(path), ": is not Open Image Denoise 2: it has no function ", part::expected(name), "."});
        }
    }

    void* library;
    void* (*newDevice)(int type);
    void (*commitDevice)(void* device);
    void (*releaseDevice)(void* device);
    int (*getDeviceError)(void* device, const char** message);
    int (*getDeviceInt)(void* device, const char* name);
    void* (*newFilter)(void* device, const char* type);
    void (*setImage)(void* filter, const char* name, void* pixels, int format, std::size_t width, std::size_t height, std::size_t offset,
                     std::size_t pixelStride, std::size_t rowStride);
    void (*setBool)(void* filter, const char* name, bool value);
    void (*commitFilter)(void* filter);
    void (*executeFilter)(void* filter);
    void (*releaseFilter)(void* filter);
};

struct Oidn::Image {
    const char* name;
    std::vector<glm::vec3> pixels;
};

Oidn::Oidn(const fs::path& path)
    : api_(std::make_unique<Api>(libraryAt(path)))
{
    device_ = api_->newDevice(kCpuDevice);
    if (device_ == nullptr) {
        throw DeviceError(MessageId::DeviceMissing, {part::file(path), ": Open Image Denoise has no device for this processor."});
    }
    api_->commitDevice(device_);
    check("begin");
}

Oidn::~Oidn()
{
    if (device_ != nullptr) {
        api_->releaseDevice(device_);
    }
}

std::string Oidn::name() const
{
    const auto part = [this](const char* which) { return std::to_string(api_->getDeviceInt(device_, which)); };
    return "Open Image Denoise " + part("versionMajor") + "." + part("versionMinor") + "." + part("versionPatch");
}

void Oidn::check(const std::string& action)
{
    const char* message = nullptr;
    if (api_->getDeviceError(device_, &message) != 0) {
        throw DeviceError(MessageId::LibraryFailed, {"Open Image Denoise could not ", part::place(action), ": ",
                                                     part::value(message == nullptr ? "it does not say why" : message), "."});
    }
}

// The color filtered by the help of the others or, with `only`, that image alone.
std::vector<glm::vec3> Oidn::filter(const Film& film, const std::vector<Image>& images, const char* only)
{
    std::vector<glm::vec3> output(film.pixels.size());
    void* filter = api_->newFilter(device_, "RT");
    const auto set = [&](const char* name, const glm::vec3* pixels) {
        api_->setImage(filter, name, const_cast<glm::vec3*>(pixels), kFloat3, film.width, film.height, 0, 0, 0);
    };
    for (const Image& image : images) {
        if (only == nullptr || std::string(only) == image.name) {
            set(image.name, image.pixels.data());
        }
    }
    set("output", output.data());
    if (only == nullptr) {
        api_->setBool(filter, "hdr", true);
        api_->setBool(filter, "cleanAux", true);
    }
    api_->commitFilter(filter);
    api_->executeFilter(filter);
    api_->releaseFilter(filter);
    check("denoise");
    return output;
}

std::vector<glm::vec3> Oidn::denoise(const Film& film)
{
    std::vector<Image> images{{"color", {}}, {"albedo", {}}, {"normal", {}}};
    for (const PixelMoments& pixel : shownPixels(film)) {
        images[0].pixels.push_back(pixel.mean);
        images[1].pixels.push_back(glm::clamp(pixel.albedo, 0.0F, 1.0F));
        images[2].pixels.push_back(pixel.normal);
    }
    const std::vector<glm::vec3> albedo = filter(film, images, "albedo");
    images[2].pixels = filter(film, images, "normal");
    images[1].pixels = albedo;
    return filter(film, images, nullptr);
}

}  // namespace glim
