// glim inspect SCENE: what is in it, what it costs, what it needs.
#pragma once

namespace CLI {
class App;
}

namespace glim {

void addInspect(CLI::App& app);

}  // namespace glim
