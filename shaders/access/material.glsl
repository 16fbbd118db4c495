// The material at a point: factors times textures and vertex colours, and the shading normal that its normal map gives.
#ifndef GLIM_ACCESS_MATERIAL
#define GLIM_ACCESS_MATERIAL

#include "interaction.glsl"
#include "lib/lat_long.glsl"
#include "lib/thin_film.glsl"
#include "parameters.glsl"
#include "texture.glsl"

#define isOnSphere(si) (hasFeature(kFeatureSpheres) && (si).primitive >= render.triangleCount && (si).instance == kNoInstance)

// The mesh's tangent, and the sign of the bitangent; 0 on a sphere.
vec4 vertexTangent(SurfaceInteraction si)
{
    return isOnSphere(si) ? vec4(0.0) : vertexDirection(render.firstTangent, false, si.triangle, si.instance, si.barycentric);
}

// Texture coordinates of set 0 and set 1. Spheres are mapped by longitude and latitude, as an environment is.
vec4 textureCoordinates(SurfaceInteraction si)
{
    if (isOnSphere(si)) {
        return latLongFromDirection(si.front ? si.ng : -si.ng).xyxy;
    }
    return vertexAttribute(render.firstUv, si.triangle, si.barycentric);
}

// The same at a point of a reference that is not yet an interaction.
vec4 textureCoordinates(PlacedPrimitive placed, vec3 point, vec2 barycentric)
{
    if (!hasFeature(kFeatureTextures)) {
        return vec4(0.0);
    }
    if (isSphere(placed.ref)) {
        return latLongFromDirection(normalizeSafely(point - sphereCenter(placed.ref, point))).xyxy;
    }
    return vertexAttribute(render.firstUv, placed.triangle, barycentric);
}

// glTF 2.0, section 3.9.3. The frame is that of MikkTSpace: interpolated normal and tangent, neither of unit length. On the back the whole
// normal is flipped. A result that is zero or not finite leaves the normal as it is.
vec3 mappedNormal(SurfaceInteraction si, vec3 texel, float scale)
{
    float side = si.front ? 1.0 : -1.0;
    vec4 tangent = vertexTangent(si);
    vec3 n = hasFeature(kFeatureSmooth) && !isOnSphere(si) ? vertexNormal(si.triangle, si.instance, si.barycentric) : vec3(0.0);
    n = dot(n, n) > 0.0 ? n : side * si.ng;
    vec3 bitangent = cross(n, tangent.xyz) * (tangent.w < 0.0 ? -1.0 : 1.0);
    vec3 local = (2.0 * texel - 1.0) * vec3(scale, scale, 1.0);
    vec3 mapped = tangent.xyz * local.x + bitangent * local.y + n * local.z;
    float square = dot(mapped, mapped);
    return square > 0.0 && dot(tangent.xyz, tangent.xyz) > 0.0 ? side * mapped / sqrt(square) : si.ns;
}

#define isUnlit(data) (hasFeature(kFeatureUnlit) && (data).type == kUnlit)

// Whether the light that the material transmits passes straight; transparency.glsl then transmits it.
bool passesStraight(MaterialData data)
{
    return (data.flags & kThinWall) != 0u;
}

// Coverage, in [0, 1], of a material whose alpha with textures and vertex colours is given.
float computeCoverage(MaterialData material, float alpha)
{
    float masked = alpha >= material.alphaCutoff ? 1.0 : 0.0;
    return material.alphaCutoff == kOpaque ? 1.0 : material.alphaCutoff >= 0.0 ? masked : alpha;
}

vec4 vertexColor(uint triangle, vec2 barycentric)
{
    bool colored = hasFeature(kFeatureVertexColors) && render.firstColor != 0u;
    return colored ? vertexAttribute(render.firstColor, triangle, barycentric) : vec4(1.0);
}

// Colour 0 of a reference's vertices, or of the point that a sphere stands for; white if it has none.
vec4 vertexColor(PlacedPrimitive placed, vec2 barycentric)
{
    if (isSphere(placed.ref)) {
        return hasFeature(kFeaturePointColors) ? sphereColor(placed.ref) : vec4(1.0);
    }
    return vertexColor(placed.triangle, barycentric);
}

vec4 vertexColor(SurfaceInteraction si)
{
    if (isOnSphere(si)) {
        return hasFeature(kFeaturePointColors) ? sphereColor(fetchPrimitiveRef(si.triangle)) : vec4(1.0);
    }
    return vertexColor(si.triangle, si.barycentric);
}

// Coverage at a point of a reference with alpha.
float computeAlpha(PlacedPrimitive placed, vec3 point, vec2 barycentric)
{
    MaterialData material = fetchMaterial(getMaterial(placed.ref));
    float alpha = material.alpha;
    if (hasFeature(kFeaturePrincipled) && material.principled != 0u) {
        uint textureTexel = textureIn(fetchPrincipled(material.principled), kSlotBaseColor);
        alpha *= vertexColor(placed, barycentric).a * sampleTexture(textureTexel, textureCoordinates(placed, point, barycentric)).a;
    }
    return computeCoverage(material, alpha);
}

// What a clearcoat leaves of emission, which lies below it: by its Fresnel reflectance at the geometric normal. `cosine`: against that.
float passedCoat(float clearcoat, float cosine)
{
    return 1.0 - clearcoat * (0.04 + 0.96 * schlickWeight(cosine));
}

// What texture, coat and coverage multiply a material's emission by, at a point of a reference. cosine: of the direction it leaves in.
vec3 emissionFactor(PlacedPrimitive placed, vec3 point, vec2 barycentric, float cosine)
{
    MaterialData data = fetchMaterial(getMaterial(placed.ref));
    vec3 factor = vec3(1.0);
    float alpha = data.alpha;
    if (hasFeature(kFeaturePrincipled) && data.principled != 0u) {
        PrincipledData p = fetchPrincipled(data.principled);
        bool coated = hasFeature(kFeatureClearcoat) && p.layers != 0u;
        uvec3 textures = uvec3(textureIn(p, kSlotEmissive), coated ? textureIn(p, kSlotClearcoat) : 0u,
                               hasAlpha(placed.ref) ? textureIn(p, kSlotBaseColor) : 0u);
        ThreeTexels texels = sampleTextures(textures, textureCoordinates(placed, point, barycentric));
        factor = texels.x.rgb;
        if (coated) {
            factor *= passedCoat(fetchLayers(p.layers).clearcoat * texels.y.r, cosine);
        }
        alpha *= vertexColor(placed, barycentric).a * texels.z.a;
    }
    return hasAlpha(placed.ref) ? factor * computeCoverage(data, alpha) : factor;
}

struct SurfaceMaterial {
    MaterialData data;          // base colour and emission with textures
    PrincipledData principled;  // with textures; only of principled materials
    LayersData layers;          // with textures; factors are 0 if there is none
    float filmThickness;        // nm
    vec3 tangent;               // of anisotropy, in world space; of any length
    vec3 coatNormal;            // unit, flipped with ng
    vec2 iors;                  // of a solid that transmits: on wo's side, and beyond the surface
};

// Number of the medium that the surface encloses, or 0.
uint getMedium(SurfaceMaterial material)
{
    return material.layers.medium;
}

void rotateAnisotropy(vec2 texel, inout LayersData layers)
{
    vec2 d = 2.0 * texel - 1.0;
    float size = length(d);
    d = size > 0.0 ? d / size : vec2(1.0, 0.0);
    vec2 rotation = vec2(layers.anisotropyCosine, layers.anisotropySine);
    layers.anisotropyCosine = rotation.x * d.x - rotation.y * d.y;
    layers.anisotropySine = rotation.y * d.x + rotation.x * d.y;
}

struct SampledNormals {
    vec3 base, coat;  // as normal maps store them
};

void applyTexel(uint slot, vec4 texel, inout SurfaceMaterial material, inout SampledNormals normals)
{
#define TIMES(part, factor, channels) material.part.factor *= texel.channels;
#define SLOT(number, name, holds, feature, path, times) \
    if (hasFeature(feature)) { \
        if (slot == kSlot##name) { times } \
    }
    GLIM_TEXTURE_SLOTS(SLOT)
#undef SLOT
#undef TIMES
    if (slot == kSlotNormal) normals.base = texel.xyz;
    if (hasFeature(kFeatureGlossiness)) {
        if (slot == kSlotSpecularColor) material.principled.roughness *= material.principled.glossy != 0u ? texel.a : 1.0;
    }
    if (hasFeature(kFeatureClearcoat)) {
        if (slot == kSlotClearcoatNormal) normals.coat = texel.xyz;
    }
    if (hasFeature(kFeatureAnisotropy)) {
        if (slot == kSlotAnisotropy) rotateAnisotropy(texel.xy, material.layers);
    }
    if (hasFeature(kFeatureIridescence)) {
        if (slot == kSlotIridescenceThickness) {
            material.filmThickness =
                mix(material.layers.iridescenceThicknessMinimum, material.layers.iridescenceThicknessMaximum, texel.g);
        }
    }
}

// The slots that matter in the scene.
uint slotsOfScene()
{
    uint slots = 0u;
#define SLOT(number, name, holds, feature, path, times) slots |= hasFeature(feature) ? 1u << number : 0u;
    GLIM_TEXTURE_SLOTS(SLOT)
#undef SLOT
    return slots;
}

// A loop over the textures that the material has: one copy of the code that samples them, and no time for those that it has not.
SampledNormals applyTextures(vec4 uv, inout SurfaceMaterial material)
{
    SampledNormals normals = SampledNormals(vec3(0.5, 0.5, 1.0), vec3(0.5, 0.5, 1.0));
    uint left = material.principled.textures & slotsOfScene();
    if (left != 0u) {
        do {
            uint slot = uint(findLSB(left));
            applyTexel(slot, sampleTexture(textureIn(material.principled, slot), uv), material, normals);
            left &= left - 1u;
        } while (left != 0u);
    }
    return normals;
}

// The tangent that anisotropy is rotated from: of the mesh, or on a sphere the way that longitude grows.
vec3 surfaceTangent(SurfaceInteraction si, LayersData layers)
{
    vec3 outward = si.front ? si.ng : -si.ng;
    vec4 tangent = isOnSphere(si) ? vec4(outward.z == 0.0 && outward.x == 0.0 ? vec3(1.0, 0.0, 0.0) : vec3(-outward.z, 0.0, outward.x), 1.0)
                                  : vertexTangent(si);
    vec3 n = si.front ? si.ns : -si.ns;
    vec3 bitangent = cross(n, tangent.xyz) * (tangent.w < 0.0 ? -1.0 : 1.0);
    return tangent.xyz * layers.anisotropyCosine + bitangent * layers.anisotropySine;
}

// May change the interaction's shading normal.
SurfaceMaterial makeSurfaceMaterial(inout SurfaceInteraction si)
{
    SurfaceMaterial material;
    material.data = fetchMaterial(si.material);
    material.layers = noLayers();
    material.coatNormal = si.ns;
    material.iors = si.front ? vec2(1.0, material.data.ior) : vec2(material.data.ior, 1.0);
    if (hasFeature(kFeaturePrincipled) && material.data.principled != 0u) {
        material.principled = fetchPrincipled(material.data.principled);
        bool layered = hasLayers() && material.principled.layers != 0u;
        if (layered) {
            material.layers = fetchLayers(material.principled.layers);
            material.filmThickness = material.layers.iridescenceThicknessMaximum;
        }
        if (hasFeature(kFeatureVertexColors | kFeaturePointColors)) {
            material.data.baseColor *= vertexColor(si).rgb;
        }
        if (hasFeature(kFeatureTextures)) {
            SampledNormals normals = applyTextures(textureCoordinates(si), material);
            if (hasFeature(kFeatureNormalMaps) && hasFeature(kFeatureClearcoat) && hasTexture(material.principled, kSlotClearcoatNormal)) {
                material.coatNormal = mappedNormal(si, normals.coat, material.layers.clearcoatNormalScale);
            }
            if (hasFeature(kFeatureNormalMaps) && hasTexture(material.principled, kSlotNormal)) {
                si.ns = mappedNormal(si, normals.base, material.principled.normalScale);
            }
        }
        if (hasFeature(kFeatureAnisotropy) && material.layers.anisotropy > 0.0) {
            material.tangent = surfaceTangent(si, material.layers);
        }
        if (hasFeature(kFeatureGlossiness) && material.principled.glossy != 0u) {
            vec3 specular = material.principled.specularColor;
            material.principled.roughness = 1.0 - material.principled.roughness;
            material.data.baseColor *= 1.0 - clamp(max(specular.r, max(specular.g, specular.b)), 0.0, 1.0);
        }
    }
    return material;
}

#endif
