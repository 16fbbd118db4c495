// glim render SCENE -o OUT.exr
#pragma once

#include "host/error.hpp"

namespace CLI {
class App;
}

namespace glim {

// `exitCode` is set to Interrupted or Terminated where a signal ended the render early.
void addRender(CLI::App& app, ExitCode& exitCode);

}  // namespace glim
