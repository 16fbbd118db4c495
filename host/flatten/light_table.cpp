#include "host/flatten/light_table.hpp"

#include "host/flatten/box_sums.hpp"
#include "host/flatten/environment_map.hpp"
#include "host/flatten/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace glim {
namespace {

using std::numbers::pi;

// The strength of an image's texels in linear light, about; 0 only where a texel is black.
class EmissiveImage {
public:
    explicit EmissiveImage(const DecodedImage& image)
        : height_(image.height),
          sums_(image.width, image.height, [&image](std::uint32_t x, std::uint32_t y) {
              const std::size_t at = 4 * (std::size_t{y} * image.width + x);
              std::uint32_t strongest = 0;
              for (std::size_t c = 0; c < 3; ++c) {
                  strongest = std::max(strongest, image.rgba16.empty() ? image.rgba8[at + c] * 257U : image.rgba16[at + c]);
              }
              return strongest == 0 ? 0 : static_cast<std::uint32_t>(kOne * std::pow(strongest / 65535.0, 2.2)) + 1;
          })
    {}

    // Over a triangle's texture coordinates, set 0 and set 1; 0 only where the texture is black all over it.
    double mean(const Texture& texture, const glm::vec4 (&uvs)[3]) const
    {
        glm::vec2 uv[3];
        for (int v = 0; v < 3; ++v) {
            uv[v] = texture.uvSet == 0 ? glm::vec2(uvs[v].x, uvs[v].y) : glm::vec2(uvs[v].z, uvs[v].w);
        }
        const UvBox box = computeUvBox(texture, uv);
        const double rows = static_cast<double>(box.high.y - box.low.y) * height_;
        if (!(rows > 1.0) || !(rows < 1e6)) {
            return sums_.mean(box, texture) / kOne;
        }
        return meanOfStrips(texture, uv, box, std::min(static_cast<std::uint32_t>(rows), kMaxStrips)) / kOne;
    }

private:
    static constexpr double kOne = 1 << 20;
    static constexpr std::uint32_t kMaxStrips = 64;

    // The triangle is cut into strips along the image's rows, each of which counts by its width.
    double meanOfStrips(const Texture& texture, const glm::vec2 (&uv)[3], const UvBox& box, std::uint32_t strips) const
    {
        glm::vec2 at[3];
        for (int v = 0; v < 3; ++v) {
            at[v] = {glm::dot(texture.rowU, glm::vec3(uv[v], 1.0F)), glm::dot(texture.rowV, glm::vec3(uv[v], 1.0F))};
        }
        double sum = 0.0, weight = 0.0;
        for (std::uint32_t strip = 0; strip < strips; ++strip) {
            const float step = (box.high.y - box.low.y) / static_cast<float>(strips);
            const UvBox part = stripOf(at, box.low.y + step * static_cast<float>(strip), box.low.y + step * static_cast<float>(strip + 1));
            const double width = std::max(0.0, static_cast<double>(part.high.x - part.low.x));
            sum += width * sums_.mean(part, texture);
            weight += width;
        }
        return weight > 0.0 ? sum / weight : sums_.mean(box, texture);
    }

    // The box of what lies between two rows.
    static UvBox stripOf(const glm::vec2 (&at)[3], float low, float high)
    {
        UvBox part{{INFINITY, low}, {-INFINITY, high}};
        const auto hold = [&part](float x) {
            part.low.x = std::min(part.low.x, x);
            part.high.x = std::max(part.high.x, x);
        };
        for (int v = 0; v < 3; ++v) {
            const glm::vec2 &a = at[v], &b = at[(v + 1) % 3];
            if (a.y >= low && a.y <= high) {
                hold(a.x);
            }
            for (const float y : {low, high}) {
                if ((a.y < y) != (b.y < y)) {
                    hold(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
                }
            }
        }
        return part.low.x <= part.high.x ? part : UvBox{{at[0].x, low}, {at[0].x, high}};
    }

    std::uint32_t height_;
    BoxSums sums_;
};

// A light on the way to the table.
struct FiniteLight {
    FlatLight light;
    LightBounds bounds;
};

FiniteLight polygonLight(const FlatLight& surface, const glm::vec3& corner, const glm::vec3& edge1, const glm::vec3& edge2, bool rectangle)
{
    const glm::dvec3 normal = glm::cross(glm::dvec3(edge1), glm::dvec3(edge2));
    const double doubled = glm::length(normal);
    FlatLight light = surface;
    light.kind |= rectangle ? kRectangleLight : kTriangleLight;
    light.position = corner;
    light.edge1 = edge1;
    light.edge2 = edge2;
    light.size = static_cast<float>(rectangle ? doubled : 0.5 * doubled);
    if (rectangle) {
        light.versineInner = static_cast<float>(1.0 / glm::length(glm::dvec3(edge1)));
        light.versineOuter = static_cast<float>(1.0 / glm::length(glm::dvec3(edge2)));
    }
    const glm::vec3 ends[4] = {corner, corner + edge1, corner + edge2, corner + (edge1 + edge2)};
    LightBounds bounds;
    bounds.low = bounds.high = corner;
    for (int i = 0; i < (rectangle ? 4 : 3); ++i) {
        bounds.low = glm::min(bounds.low, ends[i]);
        bounds.high = glm::max(bounds.high, ends[i]);
    }
    bounds.radius = 0.5F * glm::length(bounds.high - bounds.low);
    bounds.axis = glm::vec3(normal / doubled);
    bounds.twoSided = (light.kind & kDoubleSidedLight) != 0;
    return {light, bounds};
}

// The light of two triangles that are a rectangle's halves, the corner opposite the diagonal being `corner` of the first; or nothing.
std::optional<FiniteLight> rectangleLight(const FlatLight& surface, const Triangle& half, int corner, const Triangle& other)
{
    const glm::vec3& at = half.vertices[corner];
    const glm::vec3 edge1 = half.vertices[(corner + 1) % 3] - at, edge2 = half.vertices[(corner + 2) % 3] - at;
    const glm::dvec3 opposite = glm::dvec3(at) + glm::dvec3(edge1) + glm::dvec3(edge2);
    // Coordinates are rounded to 2^-24 of their size.
    const glm::dvec3 size = glm::abs(glm::dvec3(at)) + glm::abs(glm::dvec3(edge1)) + glm::abs(glm::dvec3(edge2));
    const double slack = 0x1p-22 * std::max({size.x, size.y, size.z});
    const bool square =
        std::abs(glm::dot(glm::dvec3(edge1), glm::dvec3(edge2))) <= slack * glm::length(glm::dvec3(edge1) + glm::dvec3(edge2));
    const bool whole =
        std::ranges::any_of(other.vertices, [&](const glm::vec3& v) { return glm::length(glm::dvec3(v) - opposite) <= slack; });
    const bool sameFront = glm::dot(faceNormal(half), faceNormal(other)) > 0.0;
    return square && whole && sameFront ? std::optional(polygonLight(surface, at, edge1, edge2, true)) : std::nullopt;
}

// Collects the lights.
class LightTable {
public:
    LightTable(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> refOfPrimitive)
        : flat_(flat),
          scene_(scene),
          primitives_(primitives),
          refOfPrimitive_(refOfPrimitive),
          meansBefore_(std::exchange(flat.emissionMeans, {}))
    {}

    void addInstance(std::size_t instance)
    {
        const std::uint32_t id = scene_.meshes[scene_.instances[instance].mesh].material;
        const Material& material = scene_.materials[id];
        const std::uint32_t first = primitives_.firstTriangles[instance], end = primitives_.firstTriangles[instance + 1];
        if (!(strongestChannel(material.emission) > 0.0)) {
            return;
        }
        const FlatLight surface = surfaceLight(id);
        const std::vector<std::uint32_t> otherHalf = (surface.kind & kUnevenLight) == 0
                                                         ? findRectangles(surface, first, end)
                                                         : std::vector<std::uint32_t>(end - first, kNoPrimitive);
        const std::shared_ptr<const EmissionMeans> means = hasEmissiveImage(material) ? meansOf(material, first, end) : nullptr;
        for (std::uint32_t i = first; i < end; ++i) {
            const double factor = means ? means->means[i - first] : 1.0;
            const std::uint32_t other = otherHalf[i - first];
            if (factor > 0.0 && (other == kNoPrimitive || i < other)) {
                addPolygon(surface, i, other, factor);
            }
        }
    }

    void addSphere(const PlacedSphere& sphere, std::size_t index)
    {
        if (sphere.isLine() || !(strongestChannel(scene_.materials[sphere.material].emission) > 0.0)) {
            return;
        }
        FlatLight light = surfaceLight(sphere.material);
        light.kind |= kSphereLight;
        light.position = sphere.center;
        light.size = sphere.radius;
        light.primitive = static_cast<std::uint32_t>(primitives_.triangles.size() + index);
        light.primitiveRef = refOfPrimitive_[light.primitive];
        const LightBounds bounds{sphere.center - sphere.radius, sphere.center + sphere.radius, sphere.radius};
        const double radius = static_cast<double>(sphere.radius);
        flat_.features |= kFeatureSphereLights;
        add({light, bounds}, pi * radius * radius * strongestChannel(light.intensity));
    }

    void addPunctual(const PunctualLight& punctual)
    {
        if (!(strongestChannel(punctual.intensity) > 0.0)) {
            return;
        }
        FlatLight light{};
        light.position = punctual.position;
        light.size = punctual.range;
        light.edge1 = punctual.direction;
        light.intensity = punctual.intensity;
        light.versineInner = punctual.versineInner;
        light.versineOuter = punctual.versineOuter;
        flat_.features |= kFeaturePunctualLights;
        if (punctual.kind == PunctualLight::Kind::Directional) {
            light.kind = kDirectionalLight | punctual.group << kLightGroupShift;
            infinite_.push_back(light);
            irradiances_.push_back(strongestChannel(punctual.intensity));
            return;
        }
        LightBounds bounds{punctual.position, punctual.position};
        light.kind = kPointLight;
        if (punctual.kind == PunctualLight::Kind::Spot) {
            light.kind = kSpotLight;
            bounds.axis = punctual.direction;
            bounds.cosEmission = 1.0F - punctual.versineOuter - 1e-6F;
        }
        light.kind |= punctual.group << kLightGroupShift;
        add({light, bounds}, strongestChannel(punctual.intensity));
    }

    void addEnvironment(const Environment& environment)
    {
        const glm::vec3& radiance = environment.radiance;
        if (!(strongestChannel(radiance) > 0.0)) {
            return;
        }
        if (environment.map && flat_.environmentMap->source != environment.map) {
            flat_.environmentMap = std::make_shared<PackedEnvironment>(packEnvironmentMap(environment.map));
        }
        const double integral = environment.map ? flat_.environmentMap->integral : 4.0 * pi;
        if (!(integral > 0.0)) {
            return;
        }
        flat_.features |= environment.map ? kFeatureEnvironmentMap : 0U;
        flat_.environmentRotation = {std::cos(environment.rotation), std::sin(environment.rotation)};
        flat_.hidesEnvironment = !environment.background;
        FlatLight light{};
        light.kind = kEnvironmentLight | environment.group << kLightGroupShift;
        light.intensity = radiance;
        flat_.features |= kFeatureEnvironment;
        flat_.environment = radiance;
        infinite_.push_back(light);
        irradiances_.push_back(0.25 * integral * strongestChannel(radiance));  // of a surface that faces anywhere, on average
    }

    void finish()
    {
        const auto count = static_cast<std::uint32_t>(finite_.size());
        flat_.finiteLights = count;
        flat_.features |= count > 1 || (count == 1 && !infinite_.empty()) ? kFeatureLightTree : 0U;
        if (count > 0) {
            pushFinite();
        }
        double sum = 0.0;
        for (const double irradiance : irradiances_) {
            sum += irradiance;
        }
        if (count > 0) {
            flat_.infiniteImportance = static_cast<float>(std::min(sum / *std::ranges::max_element(powers_), 1e30));
        }
        for (std::size_t i = 0; i < infinite_.size(); ++i) {
            infinite_[i].probability = static_cast<float>(irradiances_[i] / sum);
            if ((infinite_[i].kind & kLightKindMask) == kEnvironmentLight) {
                flat_.environmentLight = static_cast<std::uint32_t>(flat_.lights.size());
            }
            flat_.lights.push_back(infinite_[i]);
        }
    }

private:
    // Of an instance's triangles: those of the scene before if they are the same.
    std::shared_ptr<const EmissionMeans> meansOf(const Material& material, std::uint32_t first, std::uint32_t end)
    {
        Texture texture = *material.textures[kSlotEmissive];
        const std::uint32_t index = std::exchange(texture.image, 0);
        const std::shared_ptr<const DecodedImage>& image = scene_.images[index].pixels;
        std::vector<glm::vec4> uvs;
        uvs.reserve(3 * std::size_t{end - first});
        for (std::uint32_t i = first; i < end; ++i) {
            for (int v = 0; v < 3; ++v) {
                uvs.push_back(primitives_.vertexUvs[primitives_.vertexIndices[i][v]]);
            }
        }
        const auto known = std::ranges::find_if(meansBefore_, [&](const std::shared_ptr<const EmissionMeans>& before) {
            return before->image.lock() == image && before->texture == texture && before->uvs == uvs;
        });
        if (known != meansBefore_.end()) {
            return flat_.emissionMeans.emplace_back(*known);
        }
        const EmissiveImage& sums = images_.try_emplace(index, *image).first->second;
        std::vector<double> means;
        for (std::size_t i = 0; i < uvs.size(); i += 3) {
            means.push_back(sums.mean(texture, {uvs[i], uvs[i + 1], uvs[i + 2]}));
        }
        return flat_.emissionMeans.emplace_back(
            std::make_shared<const EmissionMeans>(EmissionMeans{image, texture, std::move(uvs), std::move(means)}));
    }

    // An image of one colour is part of the factors.
    bool hasEmissiveImage(const Material& material) const
    {
        return material.textures[kSlotEmissive] && flat_.imageBytes[material.textures[kSlotEmissive]->image] > 0;
    }

    FlatLight surfaceLight(std::uint32_t id) const
    {
        const Material& material = scene_.materials[id];
        const bool uneven = hasEmissiveImage(material) || material.alphaMode != AlphaMode::Opaque || material.clearcoat > 0.0F;
        FlatLight light{};
        light.kind =
            (material.doubleSided ? kDoubleSidedLight : 0U) | (uneven ? kUnevenLight : 0U) | material.lightGroup << kLightGroupShift;
        light.intensity = flat_.materials[id].emission;
        return light;
    }

    // For each triangle the one that makes it a rectangle, or kNoPrimitive.
    std::vector<std::uint32_t> findRectangles(const FlatLight& surface, std::uint32_t first, std::uint32_t end) const
    {
        using Ends = std::array<float, 6>;
        std::vector<std::uint32_t> otherHalf(end - first, kNoPrimitive);
        std::map<Ends, std::uint32_t> open;  // triangles by their longest side
        for (std::uint32_t i = first; i < end; ++i) {
            const int corner = cornerOf(primitives_.triangles[i]);
            const glm::vec3 &a = primitives_.triangles[i].vertices[(corner + 1) % 3],
                            &b = primitives_.triangles[i].vertices[(corner + 2) % 3];
            const Ends ends{a.x, a.y, a.z, b.x, b.y, b.z}, reversed{b.x, b.y, b.z, a.x, a.y, a.z};
            const auto found = open.find(std::max(ends, reversed));
            if (found == open.end()) {
                open.emplace(std::max(ends, reversed), i);
            } else if (rectangleLight(surface, primitives_.triangles[found->second], cornerOf(primitives_.triangles[found->second]),
                                      primitives_.triangles[i])) {
                otherHalf[i - first] = found->second;
                otherHalf[found->second - first] = i;
                open.erase(found);
            }
        }
        return otherHalf;
    }

    // The corner opposite the longest side.
    static int cornerOf(const Triangle& triangle)
    {
        int corner = 0;
        float longest = -1.0F;
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 side = triangle.vertices[(i + 2) % 3] - triangle.vertices[(i + 1) % 3];
            if (glm::dot(side, side) > longest) {
                longest = glm::dot(side, side);
                corner = i;
            }
        }
        return corner;
    }

    // other: the other half of a rectangle, or kNoPrimitive.
    void addPolygon(const FlatLight& surface, std::uint32_t primitive, std::uint32_t other, double factor)
    {
        const Triangle& triangle = primitives_.triangles[primitive];
        const glm::vec3& v0 = triangle.vertices[0];
        FiniteLight light = other == kNoPrimitive ? polygonLight(surface, v0, triangle.vertices[1] - v0, triangle.vertices[2] - v0, false)
                                                  : *rectangleLight(surface, triangle, cornerOf(triangle), primitives_.triangles[other]);
        light.light.primitive = primitive;
        light.light.otherPrimitive = other;
        light.light.primitiveRef = refOfPrimitive_[primitive];
        flat_.features |= other == kNoPrimitive ? kFeatureTriangleLights : kFeatureRectangleLights;
        add(light, factor * static_cast<double>(light.light.size) * strongestChannel(surface.intensity));
    }

    void add(const FiniteLight& light, double power)
    {
        finite_.push_back(light);
        powers_.push_back(power);
    }

    // Half of the diagonal of the box of all triangles and spheres outside of shared meshes.
    float sceneRadius() const
    {
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (const Triangle& triangle : primitives_.triangles) {
            for (const glm::vec3& vertex : triangle.vertices) {
                low = glm::min(low, vertex);
                high = glm::max(high, vertex);
            }
        }
        for (std::size_t i = 0; i < primitives_.spheres.size(); ++i) {
            low = glm::min(low, primitives_.spheres[i].center - primitives_.spheres[i].radius);
            high = glm::max(high, primitives_.spheres[i].center + primitives_.spheres[i].radius);
        }
        return 0.5F * glm::length(high - low);
    }

    // In the order of the tree's leaves.
    void pushFinite()
    {
        // Relative to the strongest, so that sums of them are finite.
        const double strongest = *std::ranges::max_element(powers_);
        std::vector<LightBounds> bounds;
        bounds.reserve(finite_.size());
        for (std::size_t i = 0; i < finite_.size(); ++i) {
            bounds.push_back(finite_[i].bounds);
            bounds.back().power = std::max(static_cast<float>(powers_[i] / strongest), 1e-30F);
        }
        const LightTree tree = buildLightTree(bounds, sceneRadius());
        flat_.lightNodes = tree.nodes;
        flat_.lightPowers = tree.powers;
        flat_.features |= tree.powers.empty() ? 0U : kFeatureLightClusters;
        for (const std::uint32_t i : tree.order) {
            const FlatLight& light = finite_[i].light;
            flat_.lights.push_back(light);
            const std::uint32_t kind = light.kind & kLightKindMask, mark = static_cast<std::uint32_t>(flat_.lights.size());
            if (kind <= kSphereLight) {
                flat_.lightMarks.push_back({light.primitive, mark});
            }
            if (kind == kRectangleLight) {
                flat_.lightMarks.push_back({light.otherPrimitive, mark});
            }
        }
    }

    FlatScene& flat_;
    const Scene& scene_;
    const Primitives& primitives_;
    std::span<const std::uint32_t> refOfPrimitive_;
    std::vector<std::shared_ptr<const EmissionMeans>> meansBefore_;
    std::vector<FiniteLight> finite_;
    std::vector<double> powers_;  // of these, W/sr
    std::vector<FlatLight> infinite_;
    std::vector<double> irradiances_;                // of these, W/m^2
    std::map<std::uint32_t, EmissiveImage> images_;  // by image
};

}  // namespace

void addLights(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> refOfPrimitive)
{
    LightTable table(flat, scene, primitives, refOfPrimitive);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        table.addInstance(i);
    }
    for (std::size_t i = 0; i < primitives.spheres.size(); ++i) {
        table.addSphere(primitives.spheres[i], i);
    }
    for (const PunctualLight& light : scene.lights) {
        table.addPunctual(light);
    }
    if (scene.environment) {
        table.addEnvironment(*scene.environment);
    }
    table.finish();
}

}  // namespace glim
