#include "host/render/identify.hpp"

#include "host/image/cryptomatte.hpp"
#include "host/image/exr.hpp"
#include "host/render/describe_primitive.hpp"
#include "host/render/film_place.hpp"
#include "version.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace glim {
namespace {

constexpr const char* kKindNames[] = {"node", "mesh", "material"};
constexpr const char* kOthers[] = {"node", "mesh.sphere", "material.default"};  // what the file does not have
constexpr const char* kMatteLayers[] = {"CryptoObject", "CryptoAsset", "CryptoMaterial"};

// Pixels of a band of rows. Their values take 156 bytes each.
constexpr std::uint32_t kBandPixels = 1U << 16;

std::string indexChannel(std::size_t kind) { return kKindNames[kind] + std::string(".X"); }

// One for each id; the largest first, equal ones by id.
std::vector<Share> rank(std::vector<Share> shares)
{
    std::ranges::sort(shares, {}, &Share::id);
    std::vector<Share> ranked;
    for (const Share& share : shares) {
        if (ranked.empty() || ranked.back().id != share.id) {
            ranked.push_back({share.id, 0});
        }
        ranked.back().samples += share.samples;
    }
    std::ranges::stable_sort(ranked, std::greater(), &Share::samples);
    return ranked;
}

}  // namespace

// Where the values of a band's pixels go.
struct Identifier::Planes {
    explicit Planes(Image& image)
    {
        const std::size_t pixels = std::size_t{image.width} * image.height;
        const auto allocate = [pixels](auto& plane) {
            plane.resize(pixels);
            return plane.data();
        };
        for (std::size_t kind = 0; kind < kKinds; ++kind) {
            indices[kind] = allocate(image.counts[indexChannel(kind)]);
            std::fill_n(indices[kind], pixels, kNoIndex);
            for (std::size_t i = 0; i < kMatteRanks; ++i) {
                ids[kind][i] = allocate(image.channels[matteIdChannel(kMatteLayers[kind], i)]);
                coverages[kind][i] = allocate(image.channels[matteCoverageChannel(kMatteLayers[kind], i)]);
            }
        }
    }

    std::array<std::uint32_t*, kKinds> indices{};
    std::array<std::array<float*, kMatteRanks>, kKinds> ids{}, coverages{};
};

Identifier::Identifier(const Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera,
                       std::shared_ptr<const CameraRayKernels> kernels)
    : prepared_(prepared),
      rays_(renderer.resources().device, *renderer.resources().shared, prepared.flat, camera, renderer.settings(), std::move(kernels))
{
    for (const MeshInstance& instance : prepared.scene.instances) {
        const Mesh& mesh = prepared.scene.meshes[instance.mesh];
        addObject({instance.node, mesh.fileMesh, mesh.material});
    }
    for (const Sphere& sphere : prepared.scene.spheres) {
        addObject({sphere.node, kNoIndex, sphere.material});
    }
}

void Identifier::addObject(const std::array<std::uint32_t, kKinds>& indices)
{
    Identity identity{indices, {}};
    if (indices[2] == prepared_.scene.defaultMaterial) {
        identity.indices[2] = kNoIndex;
    }
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        const std::string name = getName(kind, identity.indices[kind]);
        identity.mattes[kind] = manifests_[kind].try_emplace(name, matteId(name)).first->second;
    }
    objects_.push_back(identity);
}

std::string Identifier::getName(std::size_t kind, std::uint32_t index) const
{
    if (index == kNoIndex) {
        return kOthers[kind];
    }
    const Scene& scene = prepared_.scene;
    const std::string& name = kind == 0 ? scene.nodeNames[index] : kind == 1 ? scene.meshNames[index] : scene.materials[index].name;
    return name.empty() ? kKindNames[kind] + ("." + std::to_string(index)) : name;
}

Image Identifier::frame(const Film& film) const
{
    Image image;
    image.attributes["software"] = "glim " GLIM_VERSION;
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        addMatteAttributes(image, kMatteLayers[kind], manifests_[kind]);
    }
    const Planes channels(image);  // of no pixels yet
    describePlace(image, film);
    return image;
}

// The objects that the samples of each pixel show, run by run. The first pixel has the most samples.
std::vector<std::vector<Share>> Identifier::meet(const Film& film, std::span<const std::uint32_t> pixels)
{
    const std::uint32_t most = film.pixels[pixels[0]].count, begin = film.sampleRanges.front().first;
    std::vector<std::vector<Share>> objects(pixels.size());
    for (std::uint32_t sample = 0, samples = 0; sample < most; sample += samples) {
        samples = std::min(most - sample, rays_.rayCount() / static_cast<std::uint32_t>(pixels.size()));
        const std::vector<PathHit> hits = rays_.trace(pixels, begin + sample, samples);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const std::uint32_t count = film.pixels[pixels[i]].count;
            for (std::uint32_t k = 0; k < samples && sample + k < count; ++k) {
                const std::uint32_t object = findPart(prepared_, hits[i * samples + k].primitiveRef).object;
                if (objects[i].empty() || objects[i].back().id != object) {
                    objects[i].push_back({object, 0});
                }
                ++objects[i].back().samples;
            }
        }
    }
    return objects;
}

void Identifier::write(std::size_t pixel, std::vector<Share> objects, std::uint32_t samples, Planes& planes) const
{
    objects = rank(std::move(objects));
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        std::vector<Share> indices, mattes;
        for (const Share& share : objects) {
            indices.push_back({share.id == kNoIndex ? kNoIndex : objects_[share.id].indices[kind], share.samples});
            if (share.id != kNoIndex) {
                mattes.push_back({objects_[share.id].mattes[kind], share.samples});
            }
        }
        planes.indices[kind][pixel] = rank(std::move(indices)).front().id;
        mattes = rank(std::move(mattes));
        for (std::size_t i = 0; i < std::min(kMatteRanks, mattes.size()); ++i) {
            planes.ids[kind][i][pixel] = std::bit_cast<float>(mattes[i].id);
            planes.coverages[kind][i][pixel] = static_cast<float>(mattes[i].samples) / static_cast<float>(samples);
        }
    }
}

Image Identifier::rows(const Film& film, std::uint32_t first, std::uint32_t count)
{
    Image image;
    image.width = film.width;
    image.height = count;
    Planes planes(image);
    const std::uint32_t begin = first * film.width;
    std::vector<std::uint32_t> pixels(std::size_t{film.width} * count);
    std::iota(pixels.begin(), pixels.end(), begin);
    std::erase_if(pixels, [&](std::uint32_t pixel) { return film.pixels[pixel].count == 0; });
    // The pixels of a trace have as many samples as each other, or nearly.
    std::ranges::stable_sort(pixels, std::greater(), [&](std::uint32_t pixel) { return film.pixels[pixel].count; });
    for (std::size_t i = 0; i < pixels.size();) {
        const std::size_t most = std::max(1U, rays_.rayCount() / film.pixels[pixels[i]].count);
        const auto traced = std::span(pixels).subspan(i, std::min(most, pixels.size() - i));
        auto objects = meet(film, traced);
        for (std::size_t k = 0; k < traced.size(); ++k) {
            write(traced[k] - begin, std::move(objects[k]), film.pixels[traced[k]].count, planes);
        }
        i += traced.size();
    }
    return image;
}

void writeIds(const std::filesystem::path& path, Identifier& identifier, const Film& film)
{
    ExrWriter writer(path, identifier.frame(film));
    const std::uint32_t rows = std::max(1U, kBandPixels / film.width);
    for (std::uint32_t first = 0; first < film.height; first += rows) {
        writer.write(identifier.rows(film, first, std::min(rows, film.height - first)));
    }
    writer.commit();
}

}  // namespace glim
