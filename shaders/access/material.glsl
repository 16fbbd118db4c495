// The material at a point: factors times textures and vertex colours, and the shading normal that its normal map gives.
#ifndef GLIM_ACCESS_MATERIAL
#define GLIM_ACCESS_MATERIAL

#include "interaction.glsl"
#include "lib/lat_long.glsl"
#include "parameters.glsl"
#include "texture.glsl"

bool isOnSphere(SurfaceInteraction si)
{
    return hasFeature(kFeatureSpheres) && si.primitive >= render.triangleCount;
}

// A section of the vertices, interpolated; of a sphere that of vertex 0.
vec4 vertexAttribute(uint first, SurfaceInteraction si)
{
    bool sphere = isOnSphere(si);
    return vertexAttribute(first, sphere ? 0u : si.primitive, sphere ? vec2(0.0) : si.barycentric);
}

// Texture coordinates of set 0 and set 1. Spheres are mapped by longitude and latitude, as an environment is.
vec4 textureCoordinates(SurfaceInteraction si)
{
    if (isOnSphere(si)) {
        return latLongFromDirection(si.front ? si.ng : -si.ng).xyxy;
    }
    return vertexAttribute(render.firstUv, si);
}

// The same at a point of a record that is not yet an interaction.
vec4 textureCoordinates(Record record, vec3 point, vec2 barycentric)
{
    if (isSphere(record)) {
        return latLongFromDirection(normalizeSafely(point - floatsOf(record.t0))).xyxy;
    }
    return vertexAttribute(render.firstUv, primitiveOf(record), barycentric);
}

// glTF 2.0, section 3.9.3. The frame is that of MikkTSpace: interpolated normal and tangent, neither of unit length. On the back the whole
// normal is turned. Not finite or zero: the normal stays.
vec3 mappedNormal(SurfaceInteraction si, vec4 uv, PrincipledData data)
{
    float side = si.front ? 1.0 : -1.0;
    vec4 tangent = vertexAttribute(render.firstTangent, si);
    vec3 n = hasFeature(kFeatureSmooth) ? vertexNormal(si.primitive, si.barycentric) : vec3(0.0);
    n = dot(n, n) > 0.0 ? n : side * si.ng;
    vec3 bitangent = cross(n, tangent.xyz) * (tangent.w < 0.0 ? -1.0 : 1.0);
    vec3 local = (2.0 * sampleTexture(data.normalTexture, uv).xyz - 1.0) * vec3(data.normalScale, data.normalScale, 1.0);
    vec3 mapped = tangent.xyz * local.x + bitangent * local.y + n * local.z;
    float square = dot(mapped, mapped);
    return square > 0.0 && dot(tangent.xyz, tangent.xyz) > 0.0 ? side * mapped / sqrt(square) : si.ns;
}

// Coverage at a point of a record with alpha, in [0, 1].
float alphaOf(Record record, vec3 point, vec2 barycentric)
{
    MaterialData material = fetchMaterial(materialOf(record));
    float alpha = material.alpha;
    if (hasFeature(kFeaturePrincipled) && material.principled != 0u) {
        if (hasFeature(kFeatureVertexColors) && render.firstColor != 0u && !isSphere(record)) {
            alpha *= vertexAttribute(render.firstColor, primitiveOf(record), barycentric).a;
        }
        if (hasFeature(kFeatureTextures)) {
            uint texture_ = fetchPrincipled(material.principled).baseColorTexture;
            alpha *= sampleTexture(texture_, textureCoordinates(record, point, barycentric)).a;
        }
    }
    float masked = alpha >= material.alphaCutoff ? 1.0 : 0.0;
    return material.alphaCutoff >= 0.0 ? masked : alpha;
}

// What texture and coverage multiply a material's emission by, at a point of a record.
vec3 emissionFactor(Record record, vec3 point, vec2 barycentric)
{
    MaterialData data = fetchMaterial(materialOf(record));
    vec3 factor = vec3(1.0);
    if (hasFeature(kFeatureTextures) && data.principled != 0u) {
        factor = sampleTexture(fetchPrincipled(data.principled).emissiveTexture, textureCoordinates(record, point, barycentric)).rgb;
    }
    return hasAlpha(record) ? factor * alphaOf(record, point, barycentric) : factor;
}

struct SurfaceMaterial {
    MaterialData data;          // base colour and emission with textures
    PrincipledData principled;  // with textures; only of principled materials
};

void applyTextures(inout SurfaceInteraction si, vec4 uv, inout SurfaceMaterial material)
{
    PrincipledData p = material.principled;
    vec4 rough = sampleTexture(p.metallicRoughnessTexture, uv);
    material.data.baseColor *= sampleTexture(p.baseColorTexture, uv).rgb;
    material.data.emission *= sampleTexture(p.emissiveTexture, uv).rgb;
    material.principled.metallic *= rough.b;
    material.principled.roughness *= rough.g;
    material.principled.specular *= sampleTexture(p.specularTexture, uv).a;
    material.principled.specularColor *= sampleTexture(p.specularColorTexture, uv).rgb;
    if (hasFeature(kFeatureNormalMaps) && p.normalTexture != 0u) {
        si.ns = mappedNormal(si, uv, p);
    }
}

// May change the interaction's shading normal.
SurfaceMaterial materialAt(inout SurfaceInteraction si)
{
    SurfaceMaterial material;
    material.data = fetchMaterial(si.material);
    if (hasFeature(kFeaturePrincipled) && material.data.principled != 0u) {
        material.principled = fetchPrincipled(material.data.principled);
        if (hasFeature(kFeatureVertexColors) && render.firstColor != 0u) {
            material.data.baseColor *= vertexAttribute(render.firstColor, si).rgb;
        }
        if (hasFeature(kFeatureTextures)) {
            applyTextures(si, textureCoordinates(si), material);
        }
    }
    return material;
}

#endif
