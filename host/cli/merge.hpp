// glim merge A.exr B.exr ... -o C.exr: renders of the same picture over different samples, as one.
#pragma once

namespace CLI {
class App;
}

namespace glim {

void addMerge(CLI::App& app);

}  // namespace glim
