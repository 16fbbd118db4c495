// What bits depend on besides scene and settings: glim's kernels, and how the device rounds.
#pragma once

#include "host/gpu/device.hpp"

#include <string>

namespace glim {

// A fingerprint of the kernels that films come from. Films of other kernels have other bits.
std::string kernelsFingerprint();

// A fingerprint of what the device makes of probe_arithmetic. It is probed once per process and driver. Devices with equal fingerprints
// are taken to give equal bits; Vulkan allows others to differ in most operations.
std::string arithmeticFingerprint(Device& device);

}  // namespace glim
