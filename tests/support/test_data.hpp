// Where tests find what they read besides the device's answers.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace glim {

// `folder` of GLIM_TEST_DATA if that is set, as where tools/gpu_check runs without the sources; else `usual`.
inline std::filesystem::path testData(const char* folder, const char* usual)
{
    const char* data = std::getenv("GLIM_TEST_DATA");
    return data != nullptr ? std::filesystem::path(data) / folder : std::filesystem::path(usual);
}

}  // namespace glim
