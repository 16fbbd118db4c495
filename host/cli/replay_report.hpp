// What happened to a path, for people and for machines.
#pragma once

#include "host/cli/render_options.hpp"
#include "host/gpu/device.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/replay.hpp"

namespace glim {

struct ReplayReport {
    const RenderOptions& options;
    const PreparedScene& prepared;
    const RenderSettings& settings;
    const DeviceDescription& device;
    ReplayedPath path;
};

void printReplay(const ReplayReport& report);
// JSON, every number exact.
void writeReplay(const std::filesystem::path& file, const ReplayReport& report);

}  // namespace glim
