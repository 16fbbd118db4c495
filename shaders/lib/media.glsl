// The media that a path is in: up to four numbers of seven bits in one word, with the innermost medium in the lowest bits. 0: none. A path
// may leave overlapping solids, such as a glass and its liquid, in any order.
#ifndef GLIM_LIB_MEDIA
#define GLIM_LIB_MEDIA

#include "shared/scene_types.h"

const uint kMediumMask = (1u << kMediumBits) - 1u;
const uint kMediaMask = 0xfffffffu;
const uint kHasWavelength = 0x80000000u;  // beside them: the path has met dispersion
// The camera path's first scattering was not specular: light tracing finds what it meets after specular ones (kFeatureCaustics).
const uint kIsDiffuseFirst = 0x40000000u;
// The camera path has scattered in a medium, where light paths do not.
const uint kHasScattered = 0x20000000u;
const uint kIsCatcherFirst = 0x10000000u;  // the camera's ray has met a shadow catcher

uint innermost(uint media)
{
    return media & kMediumMask;
}

bool isFull(uint media)
{
    return (media & ~(kMediaMask >> kMediumBits) & kMediaMask) != 0u;
}

// If it is full, the outermost is forgotten.
uint enterMedium(uint media, uint medium)
{
    return (media & ~kMediaMask) | ((media << kMediumBits | medium) & kMediaMask);
}

// Takes the innermost entry of `medium` out; unchanged if it is not there.
uint leaveMedium(uint media, uint medium)
{
    for (uint place = 0u; place < 4u; ++place) {
        uint entry = media >> (place * kMediumBits) & kMediumMask;
        if (entry == medium && medium != 0u) {
            uint kept = media & ((1u << (place * kMediumBits)) - 1u);
            uint outer = (media & kMediaMask) >> kMediumBits & ~((1u << (place * kMediumBits)) - 1u);
            return (media & ~kMediaMask) | outer | kept;
        }
    }
    return media;
}

bool isInMedium(uint media, uint medium)
{
    return leaveMedium(media, medium) != media;
}

// The media on the other side of a surface that encloses `medium`; `front`: this side is the outer one.
uint mediaBeyond(uint media, uint medium, bool front)
{
    return front ? enterMedium(media, medium) : leaveMedium(media, medium);
}

#endif
