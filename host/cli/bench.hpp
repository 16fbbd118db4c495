// glim bench SCENE...
#pragma once

#include "host/error.hpp"

namespace CLI {
class App;
}

namespace glim {

// `exitCode` is set where a signal ended the bench early.
void addBench(CLI::App& app, ExitCode& exitCode);

}  // namespace glim
