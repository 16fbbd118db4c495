// One thread is one pixel. Averages the variance of the pixels around it, because a pixel's own variance is noisy if the pixel has few
// blocks of samples.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/denoise.glsl"

vec3 poolAround(ivec2 center)
{
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int y = -kPoolRadius; y <= kPoolRadius; ++y) {
        for (int x = -kPoolRadius; x <= kPoolRadius; ++x) {
            ivec2 at = center + ivec2(x, y);
            if (isInBand(at)) {
                sum += noisy[pixelAt(at)].variance;
                count += 1.0;
            }
        }
    }
    return sum / count;
}

void main()
{
    if (gl_GlobalInvocationID.x < pass.count) {
        uint pixel = pass.first + gl_GlobalInvocationID.x;
        pooled[pixel] = poolAround(getPixelPosition(pixel));
    }
}
