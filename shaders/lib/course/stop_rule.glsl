// Decides when a pixel of an adaptive render has enough samples.
#ifndef GLIM_LIB_COURSE_STOP_RULE
#define GLIM_LIB_COURSE_STOP_RULE

#include "shared/luminance.h"
#include "shared/pixel_moments.h"

// Welford, "Note on a Method for Calculating Corrected Sums of Squares and Products", 1962.
LuminanceMoments addLuminance(LuminanceMoments moments, float luminance, bool met)
{
    uint count = moments.count + 1u;
    float delta = luminance - moments.mean;
    float mean = moments.mean + delta / float(count);
    return LuminanceMoments(count, mean, moments.squares + delta * (luminance - mean), moments.met + uint(met));
}

// The rule of Berkeley's CS 184 path tracer: half the 95 % interval of the mean, 1.96 s / sqrt(n), is at most `tolerance` times the mean.
// Testing it again and again stops pixels preferably where the mean is too low, which biases the picture. A pixel whose samples are all
// equal, most often black, passes only after `constantSamples`.
bool isAccurate(LuminanceMoments moments, float tolerance, uint constantSamples)
{
    if (moments.count < 2u) {
        return false;
    }
    if (moments.squares == 0.0) {
        return moments.count >= constantSamples;
    }
    float n = float(moments.count);
    float deviation = sqrt(moments.squares / (n - 1.0));
    return 1.96 * deviation / sqrt(n) <= tolerance * moments.mean;
}

#endif
