// Pixels of one or two films, laid under those of a band of the window. The push constants are not those of a pass that traces.
#ifndef GLIM_ACCESS_VIEW
#define GLIM_ACCESS_VIEW

#include "shared/bindings.h"
#include "shared/display_types.h"

layout(push_constant, scalar) uniform ViewBlock { ViewPass pass; };
layout(local_size_x_id = kSpecWorkgroup) in;

layout(set = 0, binding = kBindViewed, scalar) readonly buffer ViewedBuffer { vec3 viewed[]; };
layout(set = 0, binding = kBindReference, scalar) readonly buffer ReferenceBuffer { vec3 referenceValues[]; };
layout(set = 0, binding = kBindPicture, rgba8) writeonly uniform image2D picture;

#endif
