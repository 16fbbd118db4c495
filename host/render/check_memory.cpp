#include "host/render/check_memory.hpp"

#include "host/error.hpp"
#include "host/memory.hpp"
#include "host/render/parameters.hpp"
#include "host/render/splats.hpp"

#include <algorithm>

namespace glim {

void checkMemory(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device, bool checkpoints)
{
    const std::uint64_t pixels = settings.pixelCount();
    const bool light = tracesLight(prepared.flat, settings);
    const std::uint64_t onDevice = sizeInBytes(prepared.flat) + PathBuffers::sizeInBytes(choosePathCapacity(settings, device)) +
                                   pixels * Tile::bytesPerPixel(settings) + (light ? SplatBuffer::bytesFor(settings) : 0);
    // The film and what its error is estimated with; --adaptive neighbours has a second film. A checkpoint has a film, the last page and
    // the film that it shows, with --adaptive neighbours the second film too, and is copied once. Halves are two films, and two of their
    // last page. A tile has a copy of its page.
    const std::uint64_t second = isNeighbours(settings.adaptive) ? 1 : 0;
    const std::uint64_t films = 2 + second + (checkpoints ? 2 * (3 + second) : 0) + (settings.halves ? 4 : 0);
    const std::uint64_t onHost =
        pixels * (films * sizeof(PixelMoments) + (light ? films * sizeof(SplatMoments) + SplatSums::kPixelBytes : 0) +
                  (settings.catcher ? films * sizeof(CatcherMoments) : 0)) +
        std::min(settings.tilePixels, settings.pixelCount()) * sizeof(PixelMoments);
    const auto refuse = [&](std::uint64_t needed, const MessagePart& owner, std::uint64_t there) {
        if (needed > there) {
            const std::uint64_t textures = imageBytes(prepared.flat);
            throw InputError(
                MessageId::OutOfMemory,
                {part::file(prepared.scene.file), ": the scene and a picture of ", std::to_string(settings.width), "x",
                 std::to_string(settings.height), " need ", part::value(std::to_string(needed >> 20) + " MiB"), ", which is ",
                 std::to_string((needed - there) >> 20), " MiB more memory than ", owner, " has",
                 textures < needed / 4 ? "."
                                       : "; " + std::to_string(textures >> 20) + " MiB are textures, which --max-texture N scales down."});
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
