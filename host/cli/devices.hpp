// glim devices: what Vulkan offers.
#pragma once

namespace CLI {
class App;
}

namespace glim {

void addDevices(CLI::App& app);

}  // namespace glim
