// The device that all tests of a process share. No device is a failure of the test that asks for it, never a skip.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

Device& testDevice();

}  // namespace glim
