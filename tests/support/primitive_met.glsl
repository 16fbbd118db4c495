// The primitive that a ray met, whichever of its references that was.
#ifndef GLIM_TEST_PRIMITIVE_MET
#define GLIM_TEST_PRIMITIVE_MET

#include "access/scene.glsl"
#include "shared/path_types.h"

uint primitiveMet(PathHit hit)
{
    return hit.primitiveRef == kNoPrimitiveRef ? kNoPrimitive : getPrimitive(fetchPrimitiveRef(hit.primitiveRef));
}

#endif
