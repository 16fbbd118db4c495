#include "host/flatten/flat_scene.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

namespace glim {
namespace {

// FNV-1a, 64 bits (Fowler, Noll, Vo): not cryptographic.
class Fingerprint {
public:
    explicit Fingerprint(std::uint64_t state = 14695981039346656037ULL)
        : state_(state)
    {}
    template <class T>
    void add(const std::vector<T>& values)
    {
        addBytes(std::as_bytes(std::span<const T>(values)));
    }
    void addBytes(std::span<const std::byte> bytes)
    {
        for (const std::byte byte : bytes) {
            state_ = (state_ ^ static_cast<std::uint64_t>(byte)) * 1099511628211ULL;
        }
    }
    std::uint64_t state() const { return state_; }

private:
    std::uint64_t state_;
};

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

template <class T>
std::uint64_t bytesOf(const std::vector<T>& values)
{
    return values.size() * sizeof(T);
}

static_assert(sizeof(MaterialData) == kMaterialTexels * sizeof(uvec4));
static_assert(sizeof(FlatLight) == kLightTexels * sizeof(uvec4));
static_assert(sizeof(PrincipledData) == kPrincipledTexels * sizeof(uvec4));
static_assert(sizeof(LayersData) == kLayersTexels * sizeof(uvec4));
static_assert(sizeof(MediumData) == kMediumTexels * sizeof(uvec4));
static_assert(sizeof(TextureData) == kTextureTexels * sizeof(uvec4));
static_assert(sizeof(InstanceData) == kInstanceTexels * sizeof(uvec4));
static_assert(sizeof(LightNode) == kLightNodeTexels * sizeof(uvec4));

}  // namespace

std::uint64_t sizeInBytes(const FlatScene& scene)
{
    return bytesOf(scene.nodes) + bytesOf(scene.records) + bytesOf(scene.triangles) + bytesOf(scene.vertices) + bytesOf(scene.materials) +
           bytesOf(scene.lights) + bytesOf(scene.lightNodes) + bytesOf(scene.principled) + bytesOf(scene.layers) + bytesOf(scene.textures) +
           bytesOf(scene.media) + bytesOf(scene.texels) + bytesOf(scene.albedos) + bytesOf(scene.environmentTexels) +
           bytesOf(scene.environmentCells) + bytesOf(scene.caustics) + bytesOf(scene.instances);
}

std::uint64_t textureBytes(const FlatScene& scene)
{
    return bytesOf(scene.texels) + bytesOf(scene.environmentTexels) + bytesOf(scene.environmentCells);
}

std::uint64_t fingerprint(const FlatScene& scene)
{
    // In order of primitives, because the order and the number of records depend on the tree.
    const std::size_t count = scene.records.size() / kRecordTexels;
    std::vector<std::uint32_t> recordOf;
    for (std::uint32_t record = 0; record < count; ++record) {
        const std::size_t primitive = scene.records[record * kRecordTexels].w;
        recordOf.resize(std::max(recordOf.size(), primitive + 1));
        recordOf[primitive] = record;
    }
    Fingerprint print;
    for (std::size_t primitive = 0; primitive < recordOf.size(); ++primitive) {
        const std::size_t at = std::size_t{recordOf[primitive]} * kRecordTexels;
        print.addBytes(std::as_bytes(std::span(scene.records).subspan(at, kRecordTexels)));
        if (!scene.triangles.empty()) {
            addNormals(print, scene, primitive);
        }
    }
    print.add(scene.materials);
    for (FlatLight light : scene.lights) {
        light.record = 0;
        print.add(std::vector<FlatLight>{light});
    }
    print.add(scene.principled);
    print.add(scene.layers);
    print.add(scene.textures);
    print.add(scene.media);
    print.add(scene.texels);
    print.add(scene.environmentTexels);
    if (!scene.environmentTexels.empty() || scene.hidesEnvironment) {
        print.add(std::vector<vec3>{scene.environment, vec3(scene.environmentTurn, scene.hidesEnvironment ? 1.0F : 0.0F)});
    }
    for (std::size_t at = 0; at < scene.instances.size(); at += kInstanceTexels) {
        std::array<uvec4, kInstanceTexels> instance{};
        std::copy_n(scene.instances.begin() + static_cast<std::ptrdiff_t>(at), kInstanceTexels, instance.begin());
        instance[0].w = instance[1].w = 0;  // records
        print.addBytes(std::as_bytes(std::span(instance)));
    }
    print.add(scene.caustics);  // films with caustics by path tracing are others
    return print.state();
}

std::string fingerprint(std::uint64_t scene, const FlatCamera& camera)
{
    Fingerprint print(scene);
    print.add(std::vector<FlatCamera>{camera});
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(print.state()));
    return digits;
}

}  // namespace glim
