// What the kernels find out about the only path of a pass, for who replays it (kNotes).
#ifndef GLIM_ACCESS_NOTES
#define GLIM_ACCESS_NOTES

#include "surface.glsl"

layout(set = 0, binding = kBindNote, scalar) writeonly buffer NoteBuffer { PathNote pathNote; };

void noteSurface(Surface surface)
{
    if (kNotes) {
        pathNote.point = surface.point;
        pathNote.geometric = surface.geometric;
        pathNote.shading = surface.shading;
        pathNote.front = uint(surface.front);
    }
}

void noteFound(float other, float weight)
{
    if (kNotes) {
        pathNote.foundPdf = other;
        pathNote.foundWeight = weight;
    }
}

void noteLight(uint light)
{
    if (kNotes) {
        pathNote.light = light;
    }
}

void noteLightSample(float pdf, float other, float weight)
{
    if (kNotes) {
        pathNote.lightPdf = pdf;
        pathNote.scatterPdf = other;
        pathNote.lightWeight = weight;
    }
}

void noteScatter(vec3 weight, vec3 throughput)
{
    if (kNotes) {
        pathNote.weight = weight;
        pathNote.throughput = throughput;
    }
}

void noteSurvival(float survival)
{
    if (kNotes) {
        pathNote.survival = survival;
    }
}

#endif
