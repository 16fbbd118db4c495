#include "host/render/check_infinities.hpp"

#include "host/gpu/commands.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <array>
#include <limits>
#include <mutex>
#include <set>

namespace glim {

Infinities makeInfinities()
{
    using Limits = std::numeric_limits<float>;
    return {0.0F, 1.0F, Limits::max(), Limits::infinity(), Limits::quiet_NaN(), 0};
}

std::uint32_t probeInfinities(Device& device, const Infinities& given)
{
    const KernelLayout layout(device, {{kBindProbed, BufferKind::Readback}}, 0);
    const Kernel kernel(layout, kernels::probe_infinities, {});
    Buffer buffer(device, "probed infinities", BufferKind::Readback, sizeof given);
    upload(buffer, std::span<const Infinities>(&given, 1));
    const Bindings bindings(layout, {{kBindProbed, &buffer}});
    Commands commands(device);
    commands.dispatch(kernel, bindings, {}, 1);
    commands.submitAndWait();
    return download<Infinities>(buffer, 1)[0].answers;
}

void refuseLostInfinities(const DeviceDescription& device, std::uint32_t answers)
{
    constexpr std::array kAsked = {"division by zero that gives infinity",
                                   "products beyond the largest number that are infinite",
                                   "NaN as the result of operations without a value",
                                   "isinf",
                                   "comparison with infinity",
                                   "comparison with NaN that is false",
                                   "-0"};
    for (std::size_t i = 0; i < kAsked.size(); ++i) {
        if ((answers >> i & 1U) == 0) {
            throw DeviceError(MessageId::DeviceLacks,
                              {"Device ", part::quoted(device.name), " says that it keeps infinities and NaN, but lacks ",
                               part::expected(kAsked[i]), ", which glim needs."});
        }
    }
}

void refuseLostInfinities(Device& device)
{
    static std::mutex mutex;
    static std::set<std::string> known;  // devices and drivers that keep them
    const std::lock_guard lock(mutex);
    const std::string name = device.description().name + ", " + device.description().driver;
    if (!known.contains(name)) {
        refuseLostInfinities(device.description(), probeInfinities(device, makeInfinities()));
        known.insert(name);
    }
}

}  // namespace glim
