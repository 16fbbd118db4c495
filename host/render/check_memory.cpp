#include "host/render/check_memory.hpp"

#include "host/error.hpp"
#include "host/memory.hpp"
#include "host/render/parameters.hpp"
#include "host/render/splats.hpp"

#include <algorithm>

namespace glim {

namespace {

struct Memory {
    std::uint64_t onDevice, onHost;  // bytes
};

Memory computeMemory(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device, bool checkpoints)
{
    const std::uint64_t pixels = settings.pixelCount();
    const bool light = tracesLight(prepared.flat, settings);
    const std::uint64_t onDevice = sizeInBytes(prepared.flat) +
                                   PathBuffers::sizeInBytes(choosePathCapacity(settings, device), settings.groupCount()) +
                                   pixels * Tile::bytesPerPixel(settings) + (light ? SplatBuffer::bytesFor(settings) : 0);
    // The film and what its error is estimated with; --adaptive neighbours has a second film. A checkpoint has a film, the last page and
    // the film that it shows, with --adaptive neighbours the second film too, and is copied once. Halves are two films without light
    // groups, which a checkpoint has too, and three of their last page; a checkpoint of --adaptive neighbours has one of these. A tile has
    // a copy of its page.
    const std::uint64_t second = isNeighbours(settings.adaptive) ? 1 : 0, halves = settings.halves ? 2 : 0;
    const std::uint64_t grouped = 2 + second + (checkpoints ? 2 * (3 + second) : 0) + (settings.halves ? 3 : 0);
    const std::uint64_t films = grouped + halves + (checkpoints ? 2 * (halves + (settings.halves ? second : 0)) : 0);
    const std::uint64_t groups = grouped * momentsOfGroups(settings.groupCount()) * sizeof(glm::vec3);
    const std::uint64_t onHost = pixels * (films * sizeof(PixelMoments) + groups +
                                           (light ? films * sizeof(SplatMoments) + groups + SplatSums::bytesPerPixel(settings) : 0) +
                                           (settings.catcher ? films * sizeof(CatcherMoments) : 0)) +
                                 std::min(settings.tileSize(), settings.pixelCount()) * sizeof(PixelMoments);
    return {onDevice, onHost};
}

}  // namespace

std::uint64_t computeGroupBytes(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device,
                                bool checkpoints)
{
    RenderSettings without = settings;
    without.lightGroups.clear();
    const Memory all = computeMemory(prepared, settings, device, checkpoints), rest = computeMemory(prepared, without, device, checkpoints);
    return all.onDevice + all.onHost - rest.onDevice - rest.onHost;
}

void checkMemory(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device, bool checkpoints)
{
    const auto [onDevice, onHost] = computeMemory(prepared, settings, device, checkpoints);
    const auto refuse = [&](std::uint64_t needed, const MessagePart& owner, std::uint64_t there) {
        if (needed > there) {
            const std::uint64_t textures = imageBytes(prepared.flat);
            const std::uint64_t groupBytes = computeGroupBytes(prepared, settings, device, checkpoints);
            throw InputError(
                MessageId::OutOfMemory,
                {part::file(prepared.scene.file), ": the scene and a picture of ", std::to_string(settings.width), "x",
                 std::to_string(settings.height), " need ", part::value(std::to_string(needed >> 20) + " MiB"), ", which is ",
                 std::to_string((needed - there) >> 20), " MiB more memory than ", owner, " has",
                 textures < needed / 4 ? ""
                                       : "; " + std::to_string(textures >> 20) + " MiB are textures, which --max-texture N scales down",
                 settings.lightGroups.empty() ? "" : "; " + std::to_string(groupBytes >> 20) + " MiB are for light groups", "."});
        }
    };
    const MessagePart machine = part::place("this machine");
    if (isSoftware(device.deviceClass)) {
        refuse(onHost + onDevice, machine, machineBytes());
        if (const std::optional<AddressLimit> limit = addressLimit()) {
            const MessagePart process(MessagePart::Kind::Place, "the process, by its limit (ulimit -v),", "ulimit -v");
            refuse(onHost + onDevice + driverAddresses(), process, limit->bytes);
        }
        return;
    }
    refuse(onHost, machine, machineBytes());
    refuse(onDevice, part::place("device \"" + device.name + "\""), device.memory);
}

}  // namespace glim
