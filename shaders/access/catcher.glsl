// Shadow catchers. Each sample has two paths with the same random numbers. Both meet the same surface first. If that is no catcher, the
// second path ends; else it goes on as if all objects were away but catchers and what emits.
#ifndef GLIM_ACCESS_CATCHER
#define GLIM_ACCESS_CATCHER

#include "bvh_traversal.glsl"
#include "pass.glsl"

bool isWithoutObjects(uint slot)
{
    return hasFeature(kFeatureCatcher) && slot >= samplesOfPass();
}

// What the rays of a camera path meet: `bounce` surfaces are behind it.
uint sidesOfRay(uint slot, uint bounce)
{
    return isWithoutObjects(slot) && bounce > 0u ? kFronts | kWithoutObjects : kFronts;
}

// Whether the path ends at the surface that it met first.
bool endsAtObject(uint slot, uint bounce, FirstHit first)
{
    return isWithoutObjects(slot) && bounce == 0u && first.alpha > 0.0;
}

#endif
