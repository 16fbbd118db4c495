// Whether a device keeps infinities, NaN and -0 as kernels need it (shaders/kernels/probe_infinities.comp).
#pragma once

#include "host/gpu/buffer.hpp"

namespace glim {

struct Infinities {
    float zero, one, largest, infinity, nan;
    std::uint32_t answers;  // one bit each
};

// What there is to ask.
Infinities makeInfinities();
// Asks the device.
std::uint32_t probeInfinities(Device& device, const Infinities& given);

// Throws DeviceError if an answer is wrong.
void refuseLostInfinities(const DeviceDescription& device, std::uint32_t answers);
// The same of a device, which is asked only once.
void refuseLostInfinities(Device& device);

}  // namespace glim
