// The classes of devices, and what each changes: speed, and no bit of a picture. Of the arithmetic, which bits come from, drivers have
// names.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>

namespace glim {

enum class DeviceClass {
    Llvmpipe,     // Mesa's software driver: lanes of a CPU's vectors, and few threads
    Software,     // other software drivers
    SharedGpu,    // GPUs that share the host's memory: integrated ones; also virtual and unknown ones, of which little is known
    DiscreteGpu,  // GPUs with memory of their own
};

struct ClassRules {
    // The schedule of --schedule auto: the persistent one, or else the wavefront, which scenes with scattering volumes always take.
    // llvmpipe is faster with the persistent one where little is traced (tests/bench/README.md), an H100 with the wavefront
    // (tests/bench/GPU.md). SwiftShader takes more than ten minutes to compile trace_paths.
    bool persistent;
    // The driver compiles trace_paths and learn_guide in seconds.
    bool compilesPaths;
    // Paths in flight, unless the device has less room. An H100 holds 270,336 threads, and was 6.6 to 7 times as fast with 2^22 as with
    // 2^18; in the Cornell box it was 1.11 times as fast with 2^23 as with 2^22, and 1.04 times with 2^24 as with 2^23. A CPU needs only
    // what fills its vectors.
    std::uint32_t pathCapacity;
    // Paths that a thread of trace_paths and trace_light_paths takes, one after the other. On a CPU it spares starting threads; on a GPU it
    // leaves threads without work.
    std::uint32_t pathsPerThread;
    // The traversal stacks of a workgroup are in its shared memory. Otherwise all levels of a stack move, by selections, which is faster on
    // llvmpipe (access/traversal_stack.glsl).
    bool sharedStack;
};

// Paths in flight take no more than this part of a device's memory: 32 GiB have room for 2^24, 16 GiB for 2^23.
inline constexpr std::uint64_t kPathPart = 10;

DeviceClass classify(VkPhysicalDeviceType type, VkDriverId driver);
const ClassRules& rulesOf(DeviceClass deviceClass);
// Whether it runs on the CPU.
inline bool isSoftware(DeviceClass deviceClass) { return deviceClass == DeviceClass::Llvmpipe || deviceClass == DeviceClass::Software; }

// Whether its quotients and square roots are known to be rounded to nearest: on a CPU they are (IEEE 754). No probe could show it.
inline bool dividesExactly(VkDriverId driver) { return driver == VK_DRIVER_ID_MESA_LLVMPIPE || driver == VK_DRIVER_ID_GOOGLE_SWIFTSHADER; }

}  // namespace glim
