// One thread is one pixel. Compares it with the pixels of one row of its window, for weigh_patches.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/denoise.glsl"
#include "lib/nl_means.glsl"

void comparePixel(uint pixel)
{
    ivec2 place = getPixelPosition(pixel);
    vec3 mean = noisy[pixel].mean;
    vec3 variance = pooled[pixel];
    for (int i = 0; i < kWindowWidth; ++i) {
        ivec2 at = place + getWindowOffset(i);
        if (isInBand(at)) {
            uint other = pixelAt(at);
            distances[pixel * uint(kWindowWidth) + uint(i)] = pixelDistance(mean, variance, noisy[other].mean, pooled[other]);
        }
    }
}

void main()
{
    if (gl_GlobalInvocationID.x < pass.count) {
        comparePixel(pass.first + gl_GlobalInvocationID.x);
    }
}
