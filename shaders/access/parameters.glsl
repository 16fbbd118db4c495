// What stays the same during a render.
#ifndef GLIM_ACCESS_PARAMETERS
#define GLIM_ACCESS_PARAMETERS

#include "shared/bindings.h"
#include "shared/path_types.h"

layout(set = 0, binding = kBindParameters, scalar) readonly buffer ParametersBlock { RenderParameters parameters; };

// A copy that main makes before anything else. A CPU reads a buffer in a branch lane by lane: trace_paths took a fifth longer.
RenderParameters render = parameters;

#endif
