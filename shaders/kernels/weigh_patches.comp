// One thread is some rows of a column of pixels. For each of these pixels it adds the pixels of one row of the search window, weighted by
// how similar their patches are (lib/nl_means.glsl). Neighbours in the column share rows of their patches.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/denoise.glsl"
#include "lib/nl_means.glsl"

const int kSharedRows = kStripRows + 2 * kPatchRadius;

// The sum of the distances of a row of the patch, and how many there are: none outside of the picture.
vec2 rowDistance(ivec2 center, int i)
{
    vec2 sum = vec2(0.0);
    for (int x = -kPatchRadius; x <= kPatchRadius; ++x) {
        ivec2 at = center + ivec2(x, 0);
        if (isInBand(at) && isInBand(at + getWindowOffset(i))) {
            sum += vec2(distances[pixelAt(at) * uint(kWindowWidth) + uint(i)], 1.0);
        }
    }
    return sum;
}

void weigh(ivec2 place, int i, vec2 distance)
{
    ivec2 other = place + getWindowOffset(i);
    if (isInBand(place) && isInBand(other)) {
        float weight = patchWeight(distance.x / distance.y);
        uint pixel = pixelAt(place);
        WeightedSum sum = sums[pixel];
        sums[pixel] = WeightedSum(sum.radiance + weightedRadiance(noisy[pixelAt(other)].mean, weight), sum.weight + weight);
    }
}

void weighStrip(ivec2 top)
{
    for (int i = 0; i < kWindowWidth; ++i) {
        vec2 rows[kSharedRows];
        for (int r = 0; r < kSharedRows; ++r) {
            rows[r] = rowDistance(top + ivec2(0, r - kPatchRadius), i);
        }
        for (int k = 0; k < kStripRows; ++k) {
            vec2 distance = vec2(0.0);
            for (int r = 0; r <= 2 * kPatchRadius; ++r) {
                distance += rows[k + r];
            }
            weigh(top + ivec2(0, k), i, distance);
        }
    }
}

void main()
{
    if (gl_GlobalInvocationID.x < pass.count) {
        ivec2 strip = getPixelPosition(pass.first + gl_GlobalInvocationID.x);
        weighStrip(ivec2(strip.x, strip.y * kStripRows));
    }
}
