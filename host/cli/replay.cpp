#include "host/cli/replay.hpp"

#include "host/cli/check_target.hpp"
#include "host/cli/replay_report.hpp"
#include "host/error.hpp"

namespace glim {
namespace {

void refuseOutside(const SamplePlace& place, const RenderSettings& settings)
{
    if (place.x >= settings.width || place.y >= settings.height) {
        throw InputError("--replay: pixel " + std::to_string(place.x) + "," + std::to_string(place.y) + " is outside the picture of " +
                         std::to_string(settings.width) + "x" + std::to_string(settings.height) + "; expected X from 0 to " +
                         std::to_string(settings.width - 1) + " and Y from 0 to " + std::to_string(settings.height - 1) + ".");
    }
}

}  // namespace

void runReplay(const RenderOptions& options)
{
    if (options.stats) {
        checkTarget(*options.stats, ".json", {options.scene});
    }
    const Instance instance;
    Device device(instance, options.device);
    const PreparedScene prepared = prepareScene(options.scene, loadOptionsOf(options), options.split);
    const Camera camera = cameraOf(prepared.scene, options);
    const RenderSettings settings = settingsFor(options, camera);
    refuseOutside(*options.replay, settings);
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    Replay replay(device, prepared.flat, flattenCamera(camera, aspect, options.lens), settings);
    const SamplePlace& place = *options.replay;
    const ReplayReport report{options, prepared, settings, device.description(),
                              replay.trace(place.y * settings.width + place.x, place.sample)};
    if (options.stats) {
        writeReplay(*options.stats, report);
    }
    printReplay(report);
}

}  // namespace glim
