// One thread is one pixel. Averages the pixels around it whose patches are alike but for noise (lib/nl_means.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/denoise.glsl"
#include "lib/nl_means.glsl"

float patchDistance(ivec2 p, ivec2 q)
{
    float sum = 0.0;
    float count = 0.0;
    for (int y = -kPatchRadius; y <= kPatchRadius; ++y) {
        for (int x = -kPatchRadius; x <= kPatchRadius; ++x) {
            ivec2 a = p + ivec2(x, y);
            ivec2 b = q + ivec2(x, y);
            if (isInBand(a) && isInBand(b)) {
                uint i = pixelAt(a);
                uint j = pixelAt(b);
                sum += pixelDistance(noisy[i].mean, pooled[i], noisy[j].mean, pooled[j]);
                count += 1.0;
            }
        }
    }
    return sum / count;
}

vec3 denoiseAt(ivec2 p)
{
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int y = -kWindowRadius; y <= kWindowRadius; ++y) {
        for (int x = -kWindowRadius; x <= kWindowRadius; ++x) {
            ivec2 q = p + ivec2(x, y);
            if (isInBand(q)) {
                float weight = patchWeight(patchDistance(p, q));
                sum += noisy[pixelAt(q)].mean * weight;
                weights += weight;
            }
        }
    }
    return sum / weights;
}

void main()
{
    if (gl_GlobalInvocationID.x < pass.pixelCount) {
        uint pixel = pass.firstPixel + gl_GlobalInvocationID.x;
        denoised[pixel] = denoiseAt(placeOf(pixel));
    }
}
