// Multiple importance sampling.
#ifndef GLIM_LIB_MIS
#define GLIM_LIB_MIS

#include "finite.glsl"

// Weight of a sample drawn with pdf f where another technique has pdf g: the power heuristic with exponent 2 (Veach 1997,
// section 9.2.4). Computed from ratios, so that no square overflows; 0 if both are 0. Denormal pdfs count as 0, since devices may flush
// them: 0 / f would be NaN where f is flushed when it divides, but not when it is compared.
float powerHeuristic(float f, float g)
{
    if (!(f >= kSmallestNormal)) {
        return 0.0;
    }
    if (isinf(f)) {
        return isinf(g) ? 0.5 : 1.0;
    }
    bool first = f >= g;  // not by min and max, which give either one of a number and NaN
    float larger = first ? f : g, smaller = first ? g : f;
    float r = smaller >= kSmallestNormal ? smaller / larger : 0.0;
    float weight = 1.0 / (1.0 + r * r);
    return first ? weight : r * r * weight;
}

#endif
