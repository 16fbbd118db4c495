// Samples the BSDF and the guide: one of them, with the density of both (the one-sample MIS of Veach and Guibas 1995).
#ifndef GLIM_ACCESS_GUIDED_BSDF
#define GLIM_ACCESS_GUIDED_BSDF

#include "bsdf.glsl"
#include "guide.glsl"
#include "notes.glsl"

// A sample whose direction the guide has chosen, still unweighted.
BsdfSample makeGuidedSample(Bsdf bsdf, vec3 wi, out vec3 local)
{
    local = frameFromWorld(bsdf.frame, wi);
    bool below = transmitsDiffusely(bsdf) && local.z < 0.0;
    return BsdfSample(wi, vec3(0.0), 0.0, below ? bsdf.principled.eta : 1.0, kBsdfUnweighted | (below ? kBsdfTransmission : 0u));
}

// As evalAndSampleBsdf. Delta lobes are chosen as often as the guide leaves, for it has none of their light. `bsdfPdf`: of the sample. `uLobe` becomes the number that has chosen the lobe.
BsdfPair evalAndSampleGuided(Bsdf bsdf, Guide guide, vec3 wo, vec3 lightWi, vec2 u, inout float uLobe, out float bsdfPdf)
{
    bool byGuide = uLobe < guide.share;
    uLobe = min(byGuide ? uLobe / guide.share : (uLobe - guide.share) / (1.0 - guide.share), 0.99999994);
    vec3 local = vec3(0.0);
    BsdfSample next = BsdfSample(bsdf.frame.z, vec3(0.0), 0.0, 1.0, 0u);
    if (!byGuide) {
        next = sampleUnweighted(bsdf, wo, u, uLobe, local);
    }
    GuideSample guided = sampleGuideOr(guide, byGuide, u, next.wi);
    if (byGuide) {
        next = makeGuidedSample(bsdf, guided.w, local);
    }
    BsdfPair pair = evalBsdfTwice(bsdf, wo, lightWi, next, local);
    if (pair.light.pdf > 0.0) {
        pair.light.pdf = mixPdfs(guide, pdfGuide(guide, lightWi), pair.light.pdf);
    }
    bsdfPdf = pair.next.pdf;
    bool delta = (pair.next.flags & kBsdfDelta) != 0u;
    float pdf = bsdfPdf > 0.0 ? mixPdfs(guide, guided.pdf, bsdfPdf) : 0.0;
    pair.next.weight *= delta ? 1.0 / (1.0 - guide.share) : pdf > 0.0 ? bsdfPdf / pdf : 0.0;
    pair.next.pdf = pdf;
    noteGuide(byGuide, guide.share, delta ? 0.0 : guided.pdf, bsdfPdf, pdf);
    return pair;
}

#endif
