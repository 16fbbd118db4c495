#ifndef GLIM_SHARED_LUMINANCE_H
#define GLIM_SHARED_LUMINANCE_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Of linear Rec.709.
GLIM_FUNCTION Real computeLuminance(RealVec3 radiance) { return dot(radiance, RealVec3(0.2126, 0.7152, 0.0722)); }

GLIM_SHARED_END
#endif
