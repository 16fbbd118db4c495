// Notes that the kernels take about the only path of a pass, for --replay (kNotes).
#ifndef GLIM_ACCESS_NOTES
#define GLIM_ACCESS_NOTES

#include "lib/media.glsl"
#include "material.glsl"

layout(set = 0, binding = kBindNote, scalar) writeonly buffer NoteBuffer { PathNote pathNote; };

// ns: the shading normal that the BSDF uses.
void noteSurface(SurfaceInteraction si, vec3 ns)
{
    if (kNotes) {
        pathNote.point = si.p;
        pathNote.ng = si.ng;
        pathNote.ns = ns;
        pathNote.front = uint(si.front);
    }
}

// `media`: of the ray that has arrived.
void noteMaterial(SurfaceInteraction si, PathHit hit, SurfaceMaterial material, uint media)
{
    if (kNotes) {
        PlacedPrimitive placed = fetchPlacedPrimitive(hit.primitiveRef);
        bool principled = hasFeature(kFeaturePrincipled) && material.data.principled != 0u;
        pathNote.baseColor = material.data.baseColor;
        pathNote.metallic = principled ? material.principled.metallic : 0.0;
        pathNote.roughness = principled ? material.principled.roughness : 0.0;
        pathNote.transmission = material.layers.transmission;
        pathNote.diffuseTransmission = material.layers.diffuseTransmission;
        pathNote.clearcoat = material.layers.clearcoat;
        pathNote.clearcoatRoughness = material.layers.clearcoatRoughness;
        pathNote.sheenColor = material.layers.sheenColor;
        pathNote.sheenRoughness = material.layers.sheenRoughness;
        pathNote.anisotropy = material.layers.anisotropy;
        pathNote.iridescence = material.layers.iridescence;
        pathNote.filmThickness = material.layers.iridescence > 0.0 ? material.filmThickness : 0.0;
        pathNote.alpha = hasAlpha(placed.ref) ? computeAlpha(placed, si.p, hit.barycentric) : 1.0;
        pathNote.medium = innermost(media);
    }
}

void noteHitLight(float lightPdf, float weight)
{
    if (kNotes) {
        pathNote.lightPdfOfHit = lightPdf;
        pathNote.misWeightOfHit = weight;
    }
}

void noteLight(uint light)
{
    if (kNotes) {
        pathNote.light = light;
    }
}

void noteLightSample(float pdf, float bsdfPdf, float weight)
{
    if (kNotes) {
        pathNote.lightPdf = pdf;
        pathNote.bsdfPdf = bsdfPdf;
        pathNote.misWeightOfLight = weight;
    }
}

// The direction that a vertex with a guide has sampled. `pdf`: of both.
void noteGuide(bool isByGuide, float share, float guidePdf, float bsdfPdf, float pdf)
{
    if (kNotes) {
        pathNote.isByGuide = uint(isByGuide);
        pathNote.guideShare = share;
        pathNote.guidePdf = guidePdf;
        pathNote.nextBsdfPdf = bsdfPdf;
        pathNote.nextPdf = pdf;
    }
}

// If the path ends there, no bounce is noted.
void noteArrival(float continuation, bool survives)
{
    if (kNotes) {
        pathNote.arrival = continuation;
        if (!survives) {
            pathNote.continuation = continuation;
        }
    }
}

void noteLobe(uint lobe, uint flags)
{
    if (kNotes) {
        pathNote.lobe = lobe;
        pathNote.lobeFlags = flags;
    }
}

void noteBounce(vec3 weight, vec3 throughput)
{
    if (kNotes) {
        pathNote.weight = weight;
        pathNote.throughput = throughput;
    }
}

void noteContinuation(float continuation)
{
    if (kNotes) {
        pathNote.continuation = continuation;
    }
}

#endif
