#include "host/flatten/flat_scene.hpp"

#include "host/fingerprint.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace glim {
namespace {

// Adds three normals per primitive, as when each primitive had its own: films from that time can still be merged and resumed.
void addNormals(Fingerprint& print, const FlatScene& scene, std::size_t primitive)
{
    const uvec4 vertices = primitive < scene.triangles.size() ? scene.triangles[primitive] : uvec4(0);
    for (int v = 0; v < 3; ++v) {
        print.addBytes(std::as_bytes(std::span(&scene.vertices[vertices[v]], 1)));
        for (const std::uint32_t section : {scene.firstUv, scene.firstTangent, scene.firstColor}) {
            if (section != 0) {
                print.addBytes(std::as_bytes(std::span(&scene.vertices[section + vertices[v]], 1)));
            }
        }
    }
}

// In order of primitives, because the order and the number of references depend on the tree.
std::uint64_t printSurfaces(const FlatScene& scene)
{
    const std::size_t count = scene.primitiveRefs.size() / kPrimitiveRefTexels;
    std::vector<std::uint32_t> refOfPrimitive;
    for (std::uint32_t ref = 0; ref < count; ++ref) {
        const std::size_t primitive = scene.primitiveRefs[ref * kPrimitiveRefTexels].w;
        refOfPrimitive.resize(std::max(refOfPrimitive.size(), primitive + 1));
        refOfPrimitive[primitive] = ref;
    }
    Fingerprint print;
    for (std::size_t primitive = 0; primitive < refOfPrimitive.size(); ++primitive) {
        const std::size_t at = std::size_t{refOfPrimitive[primitive]} * kPrimitiveRefTexels;
        print.addBytes(std::as_bytes(std::span(scene.primitiveRefs).subspan(at, kPrimitiveRefTexels)));
        if (!scene.triangles.empty()) {
            addNormals(print, scene, primitive);
        }
    }
    return print.state();
}

template <class Values>
std::uint64_t bytesOf(const Values& values)
{
    return values.size() * sizeof(values[0]);
}

static_assert(sizeof(MaterialData) == kMaterialTexels * sizeof(uvec4));
static_assert(sizeof(FlatLight) == kLightTexels * sizeof(uvec4));
static_assert(sizeof(PrincipledData) == kPrincipledTexels * sizeof(uvec4));
static_assert(sizeof(LayersData) == kLayersTexels * sizeof(uvec4));
static_assert(sizeof(MediumData) == kMediumTexels * sizeof(uvec4));
static_assert(sizeof(ScatteringData) == kScatteringTexels * sizeof(uvec4));
static_assert(sizeof(TextureData) == kTextureTexels * sizeof(uvec4));
static_assert(sizeof(InstanceData) == kInstanceTexels * sizeof(uvec4));
static_assert(sizeof(LightNode) == kLightNodeTexels * sizeof(uvec4));

}  // namespace

vec3 scatteringOf(const FlatScene& scene, std::uint32_t medium)
{
    return scene.scattering.empty() ? vec3(0.0F) : scene.media[medium - 1].extinction * scene.scattering[medium - 1].albedo;
}

vec3 absorptionOf(const FlatScene& scene, std::uint32_t medium) { return scene.media[medium - 1].extinction - scatteringOf(scene, medium); }

std::uint64_t sizeInBytes(const FlatScene& scene)
{
    return bytesOf(scene.nodes) + bytesOf(scene.primitiveRefs) + bytesOf(scene.triangles) + bytesOf(scene.vertices) +
           bytesOf(scene.materials) + bytesOf(scene.lights) + bytesOf(scene.lightNodes) + bytesOf(scene.lightPowers) +
           bytesOf(scene.principled) + bytesOf(scene.layers) + bytesOf(scene.textures) + bytesOf(scene.media) + bytesOf(scene.scattering) +
           bytesOf(scene.albedos) + bytesOf(scene.caustics) + bytesOf(scene.instances) + bytesOf(scene.motions) + textureBytes(scene);
}

std::uint64_t textureBytes(const FlatScene& scene)
{
    return imageBytes(scene) + bytesOf(scene.environmentMap->texels) + bytesOf(scene.environmentMap->cells);
}

std::uint64_t imageBytes(const FlatScene& scene) { return bytesOf(scene.images->texels); }

std::uint64_t fingerprint(const FlatScene& scene)
{
    std::optional<std::uint64_t>& surfaces = *scene.surfacesPrint;
    surfaces = surfaces ? surfaces : printSurfaces(scene);
    Fingerprint print(*surfaces);
    print.add(scene.materials);
    for (FlatLight light : scene.lights) {
        light.primitiveRef = 0;
        if ((light.kind & kLightKindMask) == kRectangleLight) {
            light.versineInner = light.versineOuter = 0.0F;  // follow from its edges
        }
        print.add(std::vector<FlatLight>{light});
    }
    print.add(scene.principled);
    print.add(scene.layers);
    print.add(scene.textures);
    print.add(scene.media);
    print.add(scene.scattering);
    if (!scene.images->texels.empty()) {
        print.add(std::vector<std::uint64_t>{scene.images->fingerprint});
    }
    if (!scene.environmentMap->texels.empty()) {
        print.add(std::vector<std::uint64_t>{scene.environmentMap->fingerprint});
    }
    if (!scene.environmentMap->texels.empty() || scene.hidesEnvironment) {
        print.add(std::vector<vec3>{scene.environment, vec3(scene.environmentRotation, scene.hidesEnvironment ? 1.0F : 0.0F)});
    }
    for (std::size_t at = 0; at < scene.instances.size(); at += kInstanceTexels) {
        std::array<uvec4, kInstanceTexels> instance{};
        std::copy_n(scene.instances.begin() + static_cast<std::ptrdiff_t>(at), kInstanceTexels, instance.begin());
        instance[0].w = instance[1].w = 0;  // references
        print.addBytes(std::as_bytes(std::span(instance)));
    }
    print.addBytes(std::as_bytes(std::span(scene.motions.begin(), scene.motions.end())));
    print.add(scene.caustics);  // films with caustics by path tracing are others
    return print.state();
}

std::string fingerprint(std::uint64_t scene, const FlatCamera& camera)
{
    Fingerprint print(scene);
    print.addBytes(std::as_bytes(std::span(&camera, 1)).first(offsetof(FlatCamera, projection)));
    if (camera.projection.model != kCentredFilm) {
        print.add(std::vector<FlatProjection>{camera.projection});
    }
    if (camera.motion != 0) {
        print.add(std::vector<std::uint32_t>{camera.motion});
    }
    return hexadecimal(print.state());
}

}  // namespace glim
