#include "host/flatten/caustics.hpp"

#include "host/flatten/piecewise_constant.hpp"
#include "host/flatten/place_instances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

namespace glim {
namespace {

using std::numbers::pi;

// As kMinAlpha of shaders/lib/bsdf/ggx.glsl: below it a lobe is a delta.
constexpr float kMinLobeAlpha = 1e-3F;
// Above the largest difference of two indices that the kernels take for none (kMinEtaStep of lib/bsdf/ggx_transmission.glsl).
constexpr float kSameIor = 2e-4F;
// Of the versine of a spot that grazes a target, as in shaders/lib/caustic_target.glsl.
constexpr double kSlack = 1e-6;
// Targets grow by this share, for rounding.
constexpr double kTargetMargin = 1e-4;

struct BoundingSphere {
    glm::dvec3 center{0.0};
    double radius = 0.0;
    double area = 0.0;  // of the surfaces within
};

BoundingSphere boundingSphere(std::span<const BoundingSphere> spheres)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const BoundingSphere& sphere : spheres) {
        low = glm::min(low, sphere.center - sphere.radius);
        high = glm::max(high, sphere.center + sphere.radius);
    }
    BoundingSphere bound{0.5 * (low + high), 0.0};
    for (const BoundingSphere& sphere : spheres) {
        bound.radius = std::max(bound.radius, glm::length(sphere.center - bound.center) + sphere.radius);
        bound.area += sphere.area;
    }
    return bound;
}

BoundingSphere computeBoundingSphere(const PlacedSphere& sphere)
{
    const double radius = static_cast<double>(sphere.radius), half = 0.5 * static_cast<double>(glm::length(sphere.axis));
    return {sphere.center + 0.5F * sphere.axis, radius + half, 4.0 * pi * radius * (radius + half)};
}

BoundingSphere boundingSphere(std::span<const Triangle> triangles)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const Triangle& triangle : triangles) {
        for (const glm::vec3& v : triangle.vertices) {
            low = glm::min(low, glm::dvec3(v));
            high = glm::max(high, glm::dvec3(v));
        }
    }
    BoundingSphere bound{0.5 * (low + high), 0.0};
    for (const Triangle& triangle : triangles) {
        for (const glm::vec3& v : triangle.vertices) {
            bound.radius = std::max(bound.radius, glm::length(glm::dvec3(v) - bound.center));
        }
        const glm::dvec3 v0 = triangle.vertices[0];
        bound.area += 0.5 * glm::length(glm::cross(glm::dvec3(triangle.vertices[1]) - v0, glm::dvec3(triangle.vertices[2]) - v0));
    }
    return bound;
}

// About the mesh's sphere; its area is about that of a uniform scale.
BoundingSphere computeBoundingSphere(const Placement& placement, const BoundingSphere& mesh)
{
    const glm::dmat3& linear = placement.linear;
    // The Frobenius norm is at least the greatest stretch.
    const double stretch = std::sqrt(glm::dot(linear[0], linear[0]) + glm::dot(linear[1], linear[1]) + glm::dot(linear[2], linear[2]));
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    BoundingSphere sphere{linear * mesh.center + placement.translation, stretch * mesh.radius, mesh.area * scale * scale};
    if (placement.motion) {
        const Box around{glm::vec3(mesh.center - mesh.radius), glm::vec3(mesh.center + mesh.radius)};
        const Box swept = placeBoxes(placement, std::span(&around, 1));
        sphere.center = 0.5 * (glm::dvec3(swept.lo) + glm::dvec3(swept.hi));
        sphere.radius = glm::length(glm::dvec3(swept.hi) - sphere.center);
    }
    return sphere;
}

// Of each instance of a shared mesh.
std::vector<BoundingSphere> spheresOfPlacements(const Primitives& primitives)
{
    std::vector<BoundingSphere> meshes, spheres;
    for (const SharedMesh& mesh : primitives.sharedMeshes) {
        meshes.push_back(mesh.triangles.empty() ? BoundingSphere{} : boundingSphere(mesh.triangles));
    }
    for (const Placement& placement : primitives.placements) {
        spheres.push_back(computeBoundingSphere(placement, meshes[placement.sharedMesh]));
    }
    return spheres;
}

// The least value of a channel, in [0, 1].
float findMin(const DecodedImage& image, std::size_t channel)
{
    std::uint32_t least = 65535;
    for (std::size_t at = channel; at < image.rgba8.size(); at += 4) {
        least = std::min(least, image.rgba8[at] * 257U);
    }
    for (std::size_t at = channel; at < image.rgba16.size(); at += 4) {
        least = std::min<std::uint32_t>(least, image.rgba16[at]);
    }
    return static_cast<float>(least) / 65535.0F;
}

class SpecularMaterials {
public:
    SpecularMaterials(const FlatScene& flat, const Scene& scene)
        : flat_(flat),
          scene_(scene)
    {
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            specular_.push_back(mayBeSpecular(i));
        }
    }

    bool operator[](std::size_t material) const { return specular_[material]; }
    bool any() const { return std::ranges::find(specular_, true) != specular_.end(); }

private:
    bool isSmooth(float roughness, const std::optional<Texture>& texture) const
    {
        const float least = roughness * (texture ? findMin(*scene_.images[texture->image].pixels, 1) : 1.0F);
        return least * least < kMinLobeAlpha;
    }

    // A solid has no interface where it meets another one of the same index; light passes there as through smooth glass.
    bool mayMatchIndex(const Material& material) const
    {
        const auto matches = [&](float ior) { return std::abs(material.ior / ior - 1.0F) < kSameIor; };
        return material.solid && material.transmission > 0.0F &&
               (matches(1.0F) ||
                std::ranges::any_of(flat_.media,
                                    [&](const MediumData& medium) { return medium.ior != material.ior && matches(medium.ior); }) ||
                std::ranges::count(flat_.media, material.ior, &MediumData::ior) > 1);
    }

    bool mayBeSpecular(std::size_t id) const
    {
        const std::uint32_t type = flat_.materials[id].type;
        if (type != kPrincipled) {
            return type == kMirror || type == kDielectric;
        }
        const Material& material = scene_.materials[id];
        const bool smooth = material.glossy ? material.roughness > 1.0F - std::sqrt(kMinLobeAlpha) || material.textures[kSlotSpecularColor]
                                            : isSmooth(material.roughness, material.textures[kSlotMetallicRoughness]);
        return smooth || mayMatchIndex(material) ||
               (material.clearcoat > 0.0F && isSmooth(material.clearcoatRoughness, material.textures[kSlotClearcoatRoughness]));
    }

    const FlatScene& flat_;
    const Scene& scene_;
    std::vector<bool> specular_;
};

std::vector<BoundingSphere> findTargets(const SpecularMaterials& specular, const Scene& scene, const Primitives& primitives,
                                        std::span<const BoundingSphere> placed)
{
    std::vector<BoundingSphere> targets;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t first = primitives.firstTriangles[i], end = primitives.firstTriangles[i + 1];
        if (end > first && specular[scene.meshes[scene.instances[i].mesh].material]) {
            targets.push_back(boundingSphere(std::span(primitives.triangles).subspan(first, end - first)));
        }
    }
    for (std::size_t i = 0; i < placed.size(); ++i) {
        if (specular[scene.meshes[primitives.sharedMeshes[primitives.placements[i].sharedMesh].mesh].material]) {
            targets.push_back(placed[i]);
        }
    }
    for (const PlacedSphere& sphere : primitives.spheres.all()) {
        if (specular[sphere.material]) {
            targets.push_back(computeBoundingSphere(sphere));
        }
    }
    return targets;
}

// At most kMaxCausticTargets spheres around all of `targets`. The largest group is split at the middle of its longest side, again and
// again.
std::vector<BoundingSphere> grouped(std::vector<BoundingSphere> targets)
{
    using Group = std::span<BoundingSphere>;
    std::vector<Group> groups{targets};
    const auto size = [](const Group& group) { return group.size() > 1 ? boundingSphere(group).radius : 0.0; };
    while (groups.size() < kMaxCausticTargets) {
        const auto largest = std::ranges::max_element(groups, {}, size);
        if (largest->size() < 2) {
            break;
        }
        glm::dvec3 low(INFINITY), high(-INFINITY);
        for (const BoundingSphere& sphere : *largest) {
            low = glm::min(low, sphere.center);
            high = glm::max(high, sphere.center);
        }
        const glm::dvec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        std::ranges::sort(*largest, {}, [axis](const BoundingSphere& sphere) { return sphere.center[axis]; });
        const double middle = 0.5 * (low[axis] + high[axis]);
        const auto second = std::ranges::find_if(*largest, [&](const BoundingSphere& s) { return s.center[axis] > middle; });
        const auto count = std::clamp<std::size_t>(static_cast<std::size_t>(second - largest->begin()), 1, largest->size() - 1);
        const Group rest = largest->subspan(count);
        *largest = largest->first(count);
        groups.push_back(rest);
    }
    std::vector<BoundingSphere> bounds;
    for (const Group& group : groups) {
        bounds.push_back(boundingSphere(std::span<const BoundingSphere>(group)));
        bounds.back().radius *= 1.0 + kTargetMargin;
    }
    return bounds;
}

bool isDoubleSided(const FlatLight& light) { return (light.kind & kDoubleSidedLight) != 0; }

// Of a light's flux about the share that meets the target; 0 only if none can.
double shareOf(const FlatLight& light, const BoundingSphere& target)
{
    const std::uint32_t kind = light.kind & kLightKindMask;
    glm::dvec3 center(light.position), axis(0.0);
    double radius = 0.0;
    if (kind == kTriangleLight || kind == kRectangleLight) {
        const glm::dvec3 edge1(light.edge1), edge2(light.edge2);
        center += (edge1 + edge2) / (kind == kTriangleLight ? 3.0 : 2.0);
        radius = std::max(glm::length(edge1), glm::length(edge2)) + glm::length(edge1 - edge2);
        axis = glm::normalize(glm::cross(edge1, edge2));
    } else if (kind == kSphereLight) {
        radius = static_cast<double>(light.size);
    } else if (kind == kSpotLight) {
        axis = glm::dvec3(light.edge1);
    }
    const glm::dvec3 towards = target.center - center;
    const double distance = glm::length(towards);
    if (distance <= radius + target.radius) {
        return 1.0;
    }
    const double spread = std::asin((radius + target.radius) / distance);
    const double sin2 = std::pow(target.radius / distance, 2.0);
    if (axis == glm::dvec3(0.0)) {
        return 0.5 * (1.0 - std::sqrt(1.0 - sin2));
    }
    double cosine = std::clamp(glm::dot(axis, towards) / distance, -1.0, 1.0);
    cosine = isDoubleSided(light) ? std::abs(cosine) : cosine;
    const double nearest = std::max(0.0, std::acos(cosine) - spread);
    if (kind == kSpotLight) {
        return 1.0 - std::cos(nearest) < static_cast<double>(light.versineOuter) + kSlack ? 0.5 * (1.0 - std::sqrt(1.0 - sin2)) : 0.0;
    }
    return sin2 * std::max(0.0, std::cos(nearest));
}

// W.
double computeFlux(const FlatLight& light)
{
    const std::uint32_t kind = light.kind & kLightKindMask;
    const double size = static_cast<double>(light.size);
    if (kind == kPointLight || kind == kSpotLight) {
        return 4.0 * pi * strongestChannel(light.intensity);
    }
    const double area = kind == kSphereLight ? 4.0 * pi * size * size : size;
    return pi * area * (isDoubleSided(light) ? 2.0 : 1.0) * strongestChannel(light.intensity);
}

// W/m^2 across an infinite light's direction; of the environment, what light paths carry.
double computeIrradiance(const FlatLight& light, const PackedEnvironment& map)
{
    return strongestChannel(light.intensity) * ((light.kind & kLightKindMask) == kEnvironmentLight ? map.brightIntegral : 1.0);
}

bool isInfinite(const FlatLight& light) { return (light.kind & kLightKindMask) >= kDirectionalLight; }

double fluxToTargets(const FlatLight& light, const PackedEnvironment& map, std::span<const BoundingSphere> targets)
{
    double sum = 0.0;
    for (const BoundingSphere& target : targets) {
        sum += isInfinite(light) ? pi * target.radius * target.radius * computeIrradiance(light, map) : shareOf(light, target);
    }
    return isInfinite(light) ? sum : std::min(sum, 1.0) * computeFlux(light);
}

// W/(sr m^2), about.
double computeBrightness(const FlatLight& light, const PackedEnvironment& map, double sceneRadius)
{
    const double intensity = strongestChannel(light.intensity);
    return isInfinite(light)                               ? computeIrradiance(light, map)
           : (light.kind & kLightKindMask) <= kSphereLight ? intensity
                                                           : intensity / (sceneRadius * sceneRadius);
}

bool hasNoExtent(const FlatLight& light)
{
    const std::uint32_t kind = light.kind & kLightKindMask;
    return kind == kPointLight || kind == kSpotLight || kind == kDirectionalLight;
}

uvec4 packTarget(const BoundingSphere& sphere)
{
    const glm::vec3 center(sphere.center);
    return {std::bit_cast<std::uint32_t>(center.x), std::bit_cast<std::uint32_t>(center.y), std::bit_cast<std::uint32_t>(center.z),
            std::bit_cast<std::uint32_t>(static_cast<float>(sphere.radius))};
}

}  // namespace

void addCaustics(FlatScene& flat, const Scene& scene, const Primitives& primitives)
{
    const SpecularMaterials specular(flat, scene);
    const PackedEnvironment& map = *flat.environmentMap;
    const bool isBright = (flat.features & kFeatureEnvironmentMap) != 0 && !map.brightCells.empty();
    const std::size_t lights = flat.lights.size() - ((flat.features & kFeatureEnvironment) != 0 && !isBright ? 1 : 0);
    if (!specular.any() || lights == 0) {
        return;
    }
    const std::vector<BoundingSphere> placed = spheresOfPlacements(primitives);
    std::vector<BoundingSphere> targets = findTargets(specular, scene, primitives, placed);
    if (targets.empty()) {
        return;
    }
    targets = grouped(std::move(targets));
    std::vector<BoundingSphere> all = placed;
    if (!primitives.triangles.empty()) {
        all.push_back(boundingSphere(primitives.triangles));
    }
    for (const PlacedSphere& sphere : primitives.spheres.all()) {
        all.push_back(computeBoundingSphere(sphere));
    }
    const BoundingSphere whole = boundingSphere(std::span<const BoundingSphere>(all));
    std::vector<double> fluxes;
    double brightness = 0.0, sum = 0.0;
    bool hasHidden = false;
    for (std::size_t i = 0; i < lights; ++i) {
        fluxes.push_back(fluxToTargets(flat.lights[i], map, targets));
        sum += fluxes.back();
        hasHidden = hasHidden || (hasNoExtent(flat.lights[i]) && fluxes.back() > 0.0);
        brightness = std::max(brightness, computeBrightness(flat.lights[i], map, whole.radius));
    }
    if (!(sum > 0.0)) {
        return;
    }
    flat.features |= kFeatureCaustics | (isBright ? kFeatureBrightEnvironment : 0U);
    flat.causticTargets = static_cast<std::uint32_t>(targets.size());
    flat.causticLights = static_cast<std::uint32_t>(lights);
    flat.brightness = static_cast<float>(brightness);
    flat.hasHiddenCaustics = hasHidden;
    for (const BoundingSphere& target : targets) {
        flat.caustics.push_back(packTarget(target));
    }
    flat.caustics.resize(kSceneSphere);
    flat.caustics.push_back(packTarget(whole));
    for (const PiecewiseConstantEntry& entry : buildPiecewiseConstant(fluxes)) {
        flat.caustics.emplace_back(entry.first, entry.last, entry.searchBegin, entry.searchEnd);
    }
    if (isBright) {
        flat.caustics.insert(flat.caustics.end(), map.brightCells.begin(), map.brightCells.end());
    }
}

}  // namespace glim
