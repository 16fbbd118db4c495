// One thread is one pixel of a picture: its bytes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "harness/interface.h"
#include "shared/bindings.h"

layout(local_size_x_id = kSpecWorkgroup) in;
layout(push_constant, scalar) uniform Size { uint width, height; };
layout(set = 0, binding = kBindPicture, rgba8) readonly uniform image2D picture;
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Pixels { uint pixels[]; };

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id < width * height) {
        uvec3 bytes = uvec3(255.0 * imageLoad(picture, ivec2(id % width, id / width)).rgb + 0.5);
        pixels[id] = bytes.r | bytes.g << 8u | bytes.b << 16u;
    }
}
