// What the lobes of the kernels and the host's tables of their albedos have in common.
#ifndef GLIM_SHARED_MICROFACETS_H
#define GLIM_SHARED_MICROFACETS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Length of w after the stretch that makes the distribution of GGX microfacets uniform.
GLIM_FUNCTION Real stretchedLength(RealVec3 w, RealVec2 alpha) { return length(RealVec3(alpha.x * w.x, alpha.y * w.y, w.z)); }

// Estevez and Kulla's fit of the sheen's masking function Lambda (lib/bsdf/sheen.glsl): a / (1 + b x^c) + d x + e.
struct SheenFit {
    Real a, b, c, d, e;
};

GLIM_FUNCTION SheenFit fitSheen(Real alpha)
{
    Real t = (1.0 - alpha) * (1.0 - alpha);
    SheenFit fit;
    fit.a = mix(21.5473, 25.3245, t);
    fit.b = mix(3.82987, 3.32435, t);
    fit.c = mix(0.19823, 0.16801, t);
    fit.d = mix(-1.97760, -1.27393, t);
    fit.e = mix(-4.32054, -4.85967, t);
    return fit;
}

// power: x^c.
GLIM_FUNCTION Real evalSheenFit(SheenFit fit, Real x, Real power) { return fit.a / (1.0 + fit.b * power) + fit.d * x + fit.e; }

GLIM_SHARED_END
#endif
