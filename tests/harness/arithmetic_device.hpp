// Devices whose arithmetic a test chooses.
#pragma once

#include "host/gpu/device.hpp"

#include <memory>

namespace glim {

// The device of the tests, with the arithmetic that GLIM_ARITHMETIC asks for by these words.
std::unique_ptr<Device> deviceWith(const std::string& arithmetic);

}  // namespace glim
