// How often the host talks to the device, in numbers of calls since the start of the program.
#pragma once

#include <cstdint>

namespace glim::test {

struct VulkanCalls {
    std::uint64_t submits = 0, waits = 0;
    std::uint64_t dispatches = 0, barriers = 0, copies = 0;  // recorded
    std::uint64_t objects = 0;                               // command pools, fences, query pools and allocations made

    VulkanCalls operator-(const VulkanCalls& b) const
    {
        return {submits - b.submits,   waits - b.waits,   dispatches - b.dispatches,
                barriers - b.barriers, copies - b.copies, objects - b.objects};
    }
};

// Of the thread that uses the queue.
VulkanCalls vulkanCalls();

}  // namespace glim::test
