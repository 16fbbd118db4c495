// Each path has one time. It is no part of a path's state: it follows from seed, pixel and sample.
#ifndef GLIM_ACCESS_PATH_TIME
#define GLIM_ACCESS_PATH_TIME

#include "motion.glsl"
#include "pass.glsl"

// Sets the time, and the camera of `render` as it is then. u: in [0, 1).
void setTime(float u)
{
    pathTime = render.timeBegin + render.timeSpan * u;
    if (kMovingCamera) {
        render.camera = moveCamera(parameters.camera);
    }
}

// To be called before anything of a path is traced or shaded.
void beginPath(SampleId id)
{
    if (hasFeature(kFeatureMotion) || kMovingCamera) {
        setTime(unitFloat(samplePair(id, kDimensionTime, kSobol).x));
    }
}

void beginLightPath(SampleId id)
{
    if (hasFeature(kFeatureMotion) || kMovingCamera) {
        setTime(unitFloat(lightPathPair(id, render.lightPaths, kDimensionTime, kSobol).x));
    }
}

#endif
