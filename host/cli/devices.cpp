#include "host/cli/commands.hpp"
#include "host/gpu/device.hpp"
#include "host/json.hpp"

#include <iostream>
#include <memory>

namespace glim {
namespace {

std::uint64_t inMebibytes(std::uint64_t bytes) { return bytes >> 20; }

Json describeDevice(const DeviceDescription& d)
{
    return {{"name", d.name},
            {"driver", d.driver},
            {"kind", d.kind},
            {"usable", d.missing.empty()},
            {"missing", d.missing},
            {"subgroupSize", d.subgroupSize},
            {"memory", d.memory},
            {"maxAllocation", d.maxAllocation},
            {"maxStorageBuffer", d.maxStorageBuffer},
            {"maxTexelElements", d.maxTexelElements},
            {"maxStorageBuffersPerKernel", d.maxStorageBuffers},
            {"maxWorkgroupInvocations", d.maxWorkgroup},
            {"timestamps", d.nanosecondsPerTick > 0.0F}};
}

void printDevice(std::size_t index, const DeviceDescription& d)
{
    std::cout << index << "  " << d.name << "\n   " << d.kind << ", " << d.driver << "\n   subgroup " << d.subgroupSize << ", memory "
              << inMebibytes(d.memory) << " MiB, largest allocation " << inMebibytes(d.maxAllocation) << " MiB\n   storage buffer "
              << inMebibytes(d.maxStorageBuffer) << " MiB (" << d.maxStorageBuffers << " per kernel), texel buffer "
              << inMebibytes(d.maxTexelElements * 16) << " MiB, workgroup " << d.maxWorkgroup << ", timestamps "
              << (d.nanosecondsPerTick > 0.0F ? "yes" : "no") << '\n';
    if (!d.missing.empty()) {
        std::cout << "   not usable: lacks " << d.missing << '\n';
    }
}

void runDevices(bool json)
{
    const VulkanInstance instance;
    const std::vector<DeviceDescription> devices = listDevices(instance);
    if (devices.empty()) {
        throw DeviceError(MessageId::DeviceMissing, {"Vulkan finds no device (a software one comes with Debian's mesa-vulkan-drivers)."});
    }
    Json list = Json::array();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (json) {
            list.append(describeDevice(devices[i]));
        } else {
            printDevice(i, devices[i]);
        }
    }
    if (json) {
        std::cout << list.dump(2) << '\n';
    }
}

}  // namespace

void addDevices(CommandLine& line)
{
    auto json = std::make_shared<bool>(false);
    Command& command = line.addCommand("devices", "List the Vulkan devices, the one used by default first");
    command.beginGroup("Output");
    command.addFlag("--json", "Print JSON; sizes in bytes", *json);
    command.onRun([json] {
        runDevices(*json);
        return ExitCode::Done;
    });
}

}  // namespace glim
