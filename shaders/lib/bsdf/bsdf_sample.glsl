// The results of evaluating and sampling a BSDF. Directions point away from the surface.
#ifndef GLIM_LIB_BSDF_SAMPLE
#define GLIM_LIB_BSDF_SAMPLE

// All non-delta lobes together. pdf 0: nothing is scattered towards wi.
struct BsdfEval {
    vec3 f;     // BSDF * |cos| of wi against the shading normal, in sr^-1
    float pdf;  // per steradian
};

const uint kBsdfDelta = 1u;
const uint kBsdfTransmission = 2u;
const uint kBsdfUnweighted = 4u;  // `weight` and `pdf` are still to be set, by `weighted`

// A sampled direction. A weight of zero ends the path.
struct BsdfSample {
    vec3 wi;
    vec3 weight;  // BSDF * |cos| / pdf
    float pdf;    // per steradian; 0 for a delta lobe
    float eta;    // index of refraction on wi's side over that on wo's; 1 for reflection
    uint flags;
};

// `f`: the BSDF at s.wi. Samples that have their weight keep it.
BsdfSample weightSample(BsdfSample s, BsdfEval f)
{
    if ((s.flags & kBsdfUnweighted) != 0u) {
        s.weight = f.pdf > 0.0 ? f.f / f.pdf : vec3(0.0);
        s.pdf = f.pdf;
        s.flags &= ~kBsdfUnweighted;
    }
    return s;
}

#endif
