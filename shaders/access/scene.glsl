// The flattened scene, read only.
#ifndef GLIM_ACCESS_SCENE
#define GLIM_ACCESS_SCENE

#include "features.glsl"
#include "shared/scene_types.h"

layout(set = 0, binding = kBindNodes) uniform usamplerBuffer sceneNodes;
layout(set = 0, binding = kBindRecords) uniform usamplerBuffer sceneRecords;
layout(set = 0, binding = kBindNormals) uniform usamplerBuffer sceneNormals;
layout(set = 0, binding = kBindMaterials, scalar) readonly buffer Materials { FlatMaterial sceneMaterials[]; };
layout(set = 0, binding = kBindLights, scalar) readonly buffer Lights { FlatLight sceneLights[]; };
layout(set = 0, binding = kBindEmitters, scalar) readonly buffer Emitters { FlatEmitter sceneEmitters[]; };
layout(set = 0, binding = kBindCamera, scalar) readonly buffer CameraBuffer { FlatCamera sceneCamera; };

// Three texels; scene_types.h says what is in them.
struct Record {
    uvec4 t0, t1, t2;
};

Record fetchRecord(uint record)
{
    int at = int(record * kRecordTexels);
    return Record(texelFetch(sceneRecords, at), texelFetch(sceneRecords, at + 1), texelFetch(sceneRecords, at + 2));
}

vec3 floatsOf(uvec4 texel)
{
    return uintBitsToFloat(texel.xyz);
}

bool isSphere(Record record)
{
    return kSpheres && (record.t1.w & kSphereBit) != 0u;
}

#endif
