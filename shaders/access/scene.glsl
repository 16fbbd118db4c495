// The flattened scene, read only.
#ifndef GLIM_ACCESS_SCENE
#define GLIM_ACCESS_SCENE

#include "features.glsl"
#include "motion.glsl"
#include "shared/scene_types.h"

layout(set = 0, binding = kBindNodes) uniform usamplerBuffer sceneNodes;
layout(set = 0, binding = kBindPrimitiveRefs) uniform usamplerBuffer scenePrimitiveRefs;
layout(set = 0, binding = kBindTriangles) uniform usamplerBuffer sceneTriangles;
layout(set = 0, binding = kBindVertices) uniform usamplerBuffer sceneVertices;
layout(set = 0, binding = kBindMaterials) uniform usamplerBuffer sceneMaterials;
layout(set = 0, binding = kBindLights) uniform usamplerBuffer sceneLights;
layout(set = 0, binding = kBindLightNodes) uniform usamplerBuffer sceneLightNodes;
layout(set = 0, binding = kBindInstances) uniform usamplerBuffer sceneInstances;

// A leaf's entry for a primitive: three texels (scene_types.h).
struct PrimitiveRef {
    uvec4 t0, t1, t2;
};

PrimitiveRef fetchPrimitiveRef(uint ref)
{
    int at = int(ref * kPrimitiveRefTexels);
    return PrimitiveRef(texelFetch(scenePrimitiveRefs, at), texelFetch(scenePrimitiveRefs, at + 1), texelFetch(scenePrimitiveRefs, at + 2));
}

vec3 toFloats(uvec4 texel)
{
    return uintBitsToFloat(texel.xyz);
}

// As it is placed at the path's time.
InstanceData fetchInstance(uint instance)
{
    int at = int(instance * kInstanceTexels);
    uvec4 a = texelFetch(sceneInstances, at);
    uvec4 b = texelFetch(sceneInstances, at + 1);
    uvec4 c = texelFetch(sceneInstances, at + 2);
    uvec4 d = texelFetch(sceneInstances, at + 3);
    uvec4 e = texelFetch(sceneInstances, at + 4);
    InstanceData data = InstanceData(toFloats(a), a.w, toFloats(b), b.w, toFloats(c), c.w, toFloats(d), d.w, toFloats(e), e.w);
    if (hasFeature(kFeatureMotion) && data.motion != 0u) {
        Movement movement = movementNow(data.motion);
        data.column0 = moveVector(movement, vec3(1.0, 0.0, 0.0));
        data.column1 = moveVector(movement, vec3(0.0, 1.0, 0.0));
        data.column2 = moveVector(movement, vec3(0.0, 0.0, 1.0));
        data.translation = movePoint(movement, vec3(0.0));
    }
    return data;
}

MaterialData fetchMaterial(uint material)
{
    int at = int(material * kMaterialTexels);
    uvec4 a = texelFetch(sceneMaterials, at);
    uvec4 b = texelFetch(sceneMaterials, at + 1);
    uvec4 c = texelFetch(sceneMaterials, at + 2);
    return MaterialData(toFloats(a), a.w, toFloats(b), uintBitsToFloat(b.w), c.x, c.y, uintBitsToFloat(c.z), uintBitsToFloat(c.w));
}

PrincipledData fetchPrincipled(uint principled)
{
    int at = int(principled);
    vec4 a = uintBitsToFloat(texelFetch(sceneMaterials, at));
    vec4 b = uintBitsToFloat(texelFetch(sceneMaterials, at + 1));
    uvec4 c = uvec4(0u);
    if (hasFeature(kFeatureTextures) || hasLayers()) {
        c = texelFetch(sceneMaterials, at + 2);
    }
    return PrincipledData(a.x, a.y, a.z, a.w, b.xyz, b.w, c.x, c.y, c.z, c.w, uvec4(0u));
}

LayersData noLayers()
{
    LayersData l;
    l.clearcoat = l.clearcoatRoughness = 0.0;
    l.clearcoatNormalScale = 1.0;
    l.sheenColor = vec3(0.0);
    l.sheenRoughness = 0.0;
    l.anisotropy = 0.0;
    l.anisotropyCosine = 1.0;
    l.anisotropySine = 0.0;
    l.iridescence = 0.0;
    l.iridescenceIor = 1.3;
    l.iridescenceThicknessMinimum = l.iridescenceThicknessMaximum = 0.0;
    l.diffuseTransmissionColor = vec3(0.0);
    l.diffuseTransmission = 0.0;
    l.transmission = 0.0;
    l.medium = l.scattersThin = 0u;
    l.backscattered = 0.0;
    return l;
}

// Only what the scene's features need.
LayersData fetchLayers(uint layers)
{
    int at = int(layers);
    LayersData l = noLayers();
    if (hasFeature(kFeatureClearcoat)) {
        vec4 a = uintBitsToFloat(texelFetch(sceneMaterials, at));
        l.clearcoat = a.x;
        l.clearcoatRoughness = a.y;
        l.clearcoatNormalScale = a.z;
    }
    if (hasFeature(kFeatureSheen)) {
        vec4 b = uintBitsToFloat(texelFetch(sceneMaterials, at + 1));
        l.sheenColor = b.rgb;
        l.sheenRoughness = b.w;
    }
    if (hasFeature(kFeatureAnisotropy)) {
        vec4 c = uintBitsToFloat(texelFetch(sceneMaterials, at + 2));
        l.anisotropy = c.x;
        l.anisotropyCosine = c.y;
        l.anisotropySine = c.z;
    }
    if (hasFeature(kFeatureIridescence)) {
        vec4 d = uintBitsToFloat(texelFetch(sceneMaterials, at + 3));
        l.iridescence = d.x;
        l.iridescenceIor = d.y;
        l.iridescenceThicknessMinimum = d.z;
        l.iridescenceThicknessMaximum = d.w;
    }
    if (hasFeature(kFeatureDiffuseTransmission)) {
        vec4 e = uintBitsToFloat(texelFetch(sceneMaterials, at + 4));
        l.diffuseTransmissionColor = e.rgb;
        l.diffuseTransmission = e.w;
    }
    if (hasFeature(kFeatureTransmission | kFeatureDiffuseTransmission | kFeatureMedia)) {
        uvec4 f = texelFetch(sceneMaterials, at + 5);
        l.transmission = uintBitsToFloat(f.x);
        l.medium = f.y;
        l.scattersThin = f.z;
        l.backscattered = uintBitsToFloat(f.w);
    }
    return l;
}

MediumData fetchMedium(uint firstMedium, uint medium)
{
    int at = int(firstMedium + (medium - 1u) * kMediumTexels);
    vec4 a = uintBitsToFloat(texelFetch(sceneMaterials, at));
    vec4 b = hasFeature(kFeatureDispersion) ? uintBitsToFloat(texelFetch(sceneMaterials, at + 1)) : vec4(0.0);
    return MediumData(a.xyz, a.w, b.x, b.yzw);
}

ScatteringData fetchScattering(uint firstScattering, uint medium)
{
    vec4 a = uintBitsToFloat(texelFetch(sceneMaterials, int(firstScattering + (medium - 1u) * kScatteringTexels)));
    return ScatteringData(a.xyz, a.w);
}

FlatLight fetchLight(uint light)
{
    int at = int(light * kLightTexels);
    uvec4 a = texelFetch(sceneLights, at);
    uvec4 b = texelFetch(sceneLights, at + 1);
    uvec4 c = texelFetch(sceneLights, at + 2);
    uvec4 d = texelFetch(sceneLights, at + 3);
    uvec4 e = texelFetch(sceneLights, at + 4);
    return FlatLight(a.x, a.y, a.z, a.w, toFloats(b), uintBitsToFloat(b.w), toFloats(c), uintBitsToFloat(c.w), toFloats(d),
                     uintBitsToFloat(d.w), toFloats(e), uintBitsToFloat(e.w));
}

// Of MaterialData::flags or FlatLight::kind.
uint lightGroupOf(uint word)
{
    return hasFeature(kFeatureLightGroups) ? word >> kLightGroupShift : 0u;
}

// The sums of power before finite light `light` (scene_types.h), on the front of the axes or on their back.
uvec3 fetchLightPowers(uint lightCount, uint light, uint back)
{
    return texelFetch(sceneLights, int(lightCount * kLightTexels + 2u * light + back)).xyz;
}

LightNode fetchLightNode(uint node)
{
    int at = int(node * kLightNodeTexels);
    uvec4 a = texelFetch(sceneLightNodes, at);
    uvec4 b = texelFetch(sceneLightNodes, at + 1);
    uvec4 c = texelFetch(sceneLightNodes, at + 2);
    return LightNode(toFloats(a), uintBitsToFloat(a.w), toFloats(b), uintBitsToFloat(b.w), uintBitsToFloat(c.x), uintBitsToFloat(c.y), c.z,
                     c.w);
}

uint getPrimitive(PrimitiveRef ref)
{
    return ref.t0.w;
}

#define isSphere(ref) (hasFeature(kFeatureSpheres) && ((ref).t1.w & kSphereBit) != 0u)

// Of what is a sphere.
#define isLine(ref) (hasFeature(kFeatureLines) && ((ref).t1.w & kSliverBit) != 0u)

float sphereRadius(PrimitiveRef ref)
{
    return uintBitsToFloat(isLine(ref) ? ref.t2.x : ref.t1.x);
}

// The centre, or of a line the place of its axis that is closest to p.
vec3 sphereCenter(PrimitiveRef ref, vec3 p)
{
    vec3 center = toFloats(ref.t0);
    if (isLine(ref)) {
        vec3 axis = toFloats(ref.t1);
        center += axis * clamp(dot(p - center, axis) / dot(axis, axis), 0.0, 1.0);
    }
    return center;
}

// That multiplies the base colour. Only with kFeaturePointColors.
vec4 sphereColor(PrimitiveRef ref)
{
    if (isLine(ref)) {
        return vec4(ref.t2.y & 0xffffu, ref.t2.y >> 16u, ref.t2.z & 0xffffu, ref.t2.z >> 16u) * 3.0517578125e-5;
    }
    return vec4(toFloats(ref.t2), uintBitsToFloat(ref.t1.y));
}

bool isSliver(PrimitiveRef ref)
{
    return hasFeature(kFeatureSlivers) && (ref.t1.w & kSliverBit) != 0u;
}

// Whether the primitive is neither opaque nor transparent all over.
#define hasAlpha(ref) (hasFeature(kFeatureAlpha) && ((ref).t1.w & kAlphaBit) != 0u)

// Whether rays of camera paths that come from behind pass the primitive.
#define isSingleSided(ref) (hasFeature(kFeatureSingleSided) && ((ref).t1.w & kSingleSidedBit) != 0u)

uint getMaterial(PrimitiveRef ref)
{
    return ref.t1.w & kMaterialMask;
}

#endif
