// From a physical device to what matters of it.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

struct Candidate {
    VkPhysicalDevice physical;
    std::uint32_t queueFamily;
    DeviceDescription description;
};

// As listDevices, with the handles.
std::vector<Candidate> findCandidates(const Instance& instance);

}  // namespace glim
