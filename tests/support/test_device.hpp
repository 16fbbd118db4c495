// The device that all tests of a process share. Without a device the tests that need it fail; they are never skipped.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

Device& testDevice();

}  // namespace glim
