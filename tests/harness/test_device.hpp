// The device that all tests of a process share: the first that is usable, or the one that GLIM_DEVICE names by a part of its name or by its
// index. Without a device the tests that need it fail; they are never skipped.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

Device& testDevice();

}  // namespace glim
