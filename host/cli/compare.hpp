// glim compare A.exr B.exr: how far A is from the reference B.
#pragma once

namespace CLI {
class App;
}

namespace glim {

void addCompare(CLI::App& app);

}  // namespace glim
