// Notes that the kernels take about the only path of a pass, for --replay (kNotes).
#ifndef GLIM_ACCESS_NOTES
#define GLIM_ACCESS_NOTES

#include "interaction.glsl"

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
