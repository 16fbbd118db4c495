// `glim preview`.
#pragma once

namespace CLI {
class App;
}

namespace glim {

void addPreview(CLI::App& app);

}  // namespace glim
