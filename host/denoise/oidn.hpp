// Intel's Open Image Denoise 2, loaded at run time: glim is built and runs without it.
#pragma once

#include "host/render/film.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace glim {

class Oidn {
public:
    // `path`: the library, or a folder that has libOpenImageDenoise.so.2 or is of Python's package pyoidn. Throws InputError if it cannot
    // be loaded.
    explicit Oidn(const std::filesystem::path& path);
    ~Oidn();
    Oidn(const Oidn&) = delete;
    Oidn& operator=(const Oidn&) = delete;

    // Returns the denoised radiance of each pixel. Albedo and normals are denoised on their own first. On the CPU: the same bits on every
    // run there, but not with another processor or version.
    std::vector<glm::vec3> denoise(const Film& film);
    // As in "Open Image Denoise 2.5.1".
    std::string name() const;

private:
    struct Api;
    struct Image;
    std::vector<glm::vec3> filter(const Film& film, const std::vector<Image>& images, const char* only);
    void check(const std::string& action);

    std::unique_ptr<Api> api_;
    void* device_ = nullptr;
};

}  // namespace glim
