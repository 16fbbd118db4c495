// The commands of glim. Each function adds one to the command line.
#pragma once

#include "host/cli/command.hpp"

namespace glim {

void addRender(CommandLine& line);   // render SCENE -o OUT.exr, with and without --replay
void addServe(CommandLine& line);    // serve: renders by requests on standard input
void addPreview(CommandLine& line);  // preview SCENE
void addView(CommandLine& line);     // view A.exr [B.exr]: shows films in a window
void addInspect(CommandLine& line);  // inspect SCENE: its contents, costs and needs
void addDevices(CommandLine& line);  // devices: what Vulkan offers
void addCompare(CommandLine& line);  // compare A.exr B.exr: how far A is from the reference B
void addBench(CommandLine& line);    // bench SCENE...
void addMerge(CommandLine& line);    // merge A.exr B.exr ... -o C.exr: renders over different samples, as one

}  // namespace glim
