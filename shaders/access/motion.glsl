// Motions of the scene, and the time of the path that a thread traces.
#ifndef GLIM_ACCESS_MOTION
#define GLIM_ACCESS_MOTION

#include "features.glsl"
#include "lib/motion.glsl"
#include "parameters.glsl"

layout(set = 0, binding = kBindMotions) uniform usamplerBuffer sceneMotions;

// As in FlatMotionKey. It holds for all that is traced and shaded until beginPath() of path_time.glsl sets that of another path.
float pathTime = 0.0;

FlatMotionKey fetchMotionKey(uint at)
{
    vec4 a = uintBitsToFloat(texelFetch(sceneMotions, int(at)));
    vec4 b = uintBitsToFloat(texelFetch(sceneMotions, int(at + 1u)));
    vec4 c = uintBitsToFloat(texelFetch(sceneMotions, int(at + 2u)));
    vec4 d = uintBitsToFloat(texelFetch(sceneMotions, int(at + 3u)));
    return FlatMotionKey(a.xyz, a.w, b, c.xyz, c.w, d.xyz, d.w);
}

// The last of the keys that is not after the path's time, and not the last of all, by binary search. `first`: texel of the first.
uint findMotionKey(uint first, uint count)
{
    uint low = 0u, high = count - 1u;
    do {
        uint middle = (low + high) >> 1u;
        bool begins = uintBitsToFloat(texelFetch(sceneMotions, int(first + middle * kMotionKeyTexels)).w) <= pathTime;
        low = begins ? middle : low;
        high = begins ? high : middle;
    } while (high - low > 1u);
    return low;
}

// At the path's time. `motion`: as in InstanceData.
Movement movementNow(uint motion)
{
    uvec4 head = texelFetch(sceneMotions, int(motion - 1u));
    uint key = motion + findMotionKey(motion, head.w) * kMotionKeyTexels;
    return moveBetween(fetchMotionKey(key), fetchMotionKey(key + kMotionKeyTexels), uintBitsToFloat(head.xyz), pathTime);
}

// The camera of the frame's time, moved.
FlatCamera moveCamera(FlatCamera camera)
{
    Movement m = movementNow(camera.motion);
    camera.position = m.translation;
    camera.right = turnVector(m, camera.right);
    camera.up = turnVector(m, camera.up);
    camera.forward = turnVector(m, camera.forward);
    camera.lensRight = turnVector(m, camera.lensRight);
    camera.lensUp = turnVector(m, camera.lensUp);
    return camera;
}

#endif
