#include "host/flatten/light_table.hpp"

#include "host/flatten/alias_table.hpp"
#include "host/flatten/box_sums.hpp"
#include "host/flatten/environment_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;

// A colour counts by its strongest channel, which does not change when channels are swapped.
double strength(const glm::vec3& color) { return static_cast<double>(std::max({color.r, color.g, color.b})); }

// The strength of an image's texels in linear light, about; 0 only where a texel is black.
class EmissiveImage {
public:
    explicit EmissiveImage(const DecodedImage& image)
        : sums_(image.width, image.height, [&image](std::uint32_t x, std::uint32_t y) {
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
        return sums_.mean(uvBoxOf(texture, uv), texture) / kOne;
    }

private:
    static constexpr double kOne = 1 << 20;

    BoxSums sums_;
};

double area(const Triangle& triangle) { return 0.5 * glm::length(faceNormal(triangle)); }

// Half the diagonal of the scene's box, metres. Directional lights and the environment shine on a disk of this radius.
double sceneRadius(const Primitives& primitives)
{
    glm::dvec3 lo(1e300), hi(-1e300);
    for (const Triangle& triangle : primitives.triangles) {
        for (const glm::vec3& v : triangle.vertices) {
            lo = glm::min(lo, glm::dvec3(v));
            hi = glm::max(hi, glm::dvec3(v));
        }
    }
    for (const Sphere& sphere : primitives.spheres) {
        lo = glm::min(lo, glm::dvec3(sphere.center) - static_cast<double>(sphere.radius));
        hi = glm::max(hi, glm::dvec3(sphere.center) + static_cast<double>(sphere.radius));
    }
    return 0.5 * glm::length(hi - lo);
}

// Collects lights with their powers in watts (up to a factor common to all).
class LightTable {
public:
    LightTable(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> recordOf)
        : flat_(flat),
          scene_(scene),
          primitives_(primitives),
          recordOf_(recordOf),
          radius_(sceneRadius(primitives))
    {}

    void addInstance(std::size_t instance)
    {
        const std::uint32_t id = scene_.meshes[scene_.instances[instance].mesh].material;
        const Material& material = scene_.materials[id];
        const std::uint32_t first = primitives_.firstTriangles[instance], count = primitives_.firstTriangles[instance + 1] - first;
        if (count == 0 || !(strength(material.emission) > 0.0)) {
            return;
        }
        std::vector<double> areas, weights;
        std::vector<std::uint32_t> emitting;
        double total = 0.0;
        for (std::uint32_t i = first; i < first + count; ++i) {
            const double strength = emissionOf(id, i);
            if (strength > 0.0) {
                emitting.push_back(i);
                areas.push_back(area(primitives_.triangles[i]));
                weights.push_back(areas.back() * strength);
                total += weights.back();
            }
        }
        if (emitting.empty()) {
            return;
        }
        const AliasTable table = buildAliasTable(weights);
        FlatLight light = surfaceLight(kTriangleLight, id, static_cast<std::uint32_t>(emitting.size()));
        flat_.features |= kFeatureTriangleLights;
        for (std::size_t i = 0; i < emitting.size(); ++i) {
            addEmitter(emitting[i], static_cast<float>(table.probabilities[i] / areas[i]), table.entries[i]);
        }
        add(light, kPi * total * strength(material.emission) * (material.doubleSided ? 2.0 : 1.0));
    }

    void addSphere(const Sphere& sphere, std::size_t index)
    {
        const Material& material = scene_.materials[sphere.material];
        if (!(strength(material.emission) > 0.0)) {
            return;
        }
        const double radius = static_cast<double>(sphere.radius);
        const double surface = 4.0 * kPi * radius * radius;
        FlatLight light = surfaceLight(kSphereLight, sphere.material, 1);
        flat_.features |= kFeatureSphereLights;
        light.position = sphere.center;
        light.radius = sphere.radius;
        addEmitter(static_cast<std::uint32_t>(primitives_.triangles.size() + index), static_cast<float>(1.0 / surface), {0xffffffffU, 0});
        add(light, kPi * surface * strength(material.emission) * (material.doubleSided ? 2.0 : 1.0));
    }

    void addPunctual(const PunctualLight& punctual)
    {
        if (!(strength(punctual.intensity) > 0.0)) {
            return;
        }
        FlatLight light{};
        light.position = punctual.position;
        light.radius = punctual.range;
        light.direction = punctual.direction;
        light.intensity = punctual.intensity;
        light.cosInner = punctual.cosInner;
        light.cosOuter = punctual.cosOuter;
        double steradians = 4.0 * kPi;
        light.kind = kPointLight;
        if (punctual.kind == PunctualLight::Kind::Spot) {
            light.kind = kSpotLight;
            steradians = 2.0 * kPi * (1.0 - 0.5 * static_cast<double>(punctual.cosInner + punctual.cosOuter));
        } else if (punctual.kind == PunctualLight::Kind::Directional) {
            light.kind = kDirectionalLight;
            steradians = kPi * radius_ * radius_;  // square metres here: W/m^2 over the scene's disk
        }
        flat_.features |= kFeaturePunctualLights;
        add(light, strength(punctual.intensity) * steradians);
    }

    void addEnvironment(const Environment& environment)
    {
        const glm::vec3& radiance = environment.radiance;
        const double integral = environment.map && strength(radiance) > 0.0 ? flattenEnvironmentMap(flat_, *environment.map) : 4.0 * kPi;
        if (!(strength(radiance) > 0.0) || !(integral > 0.0)) {
            return;
        }
        flat_.features |= environment.map ? kFeatureEnvironmentMap : 0U;
        flat_.environmentTurn = {std::cos(environment.rotation), std::sin(environment.rotation)};
        flat_.hidesEnvironment = !environment.background;
        FlatLight light{};
        light.kind = kEnvironmentLight;
        light.intensity = radiance;
        flat_.features |= kFeatureEnvironment;
        flat_.environment = radiance;
        flat_.environmentLight = static_cast<std::uint32_t>(flat_.lights.size());
        add(light, integral * kPi * radius_ * radius_ * strength(radiance));
    }

    // Turns powers into probabilities.
    void finish()
    {
        if (flat_.lights.empty()) {
            return;
        }
        const AliasTable table = buildAliasTable(powers_);
        for (std::size_t i = 0; i < flat_.lights.size(); ++i) {
            flat_.lights[i].alias = table.entries[i];
            flat_.lights[i].probability = static_cast<float>(table.probabilities[i]);
        }
    }

private:
    // What the emission of a triangle is multiplied by on average.
    double emissionOf(std::uint32_t id, std::uint32_t triangle)
    {
        const Material& material = scene_.materials[id];
        if (!material.emissiveTexture) {
            return 1.0;
        }
        const std::uint32_t image = material.emissiveTexture->image;
        const auto known = images_.find(image);
        const EmissiveImage& sums =
            known != images_.end() ? known->second : images_.emplace(image, EmissiveImage(scene_.images[image].pixels)).first->second;
        glm::vec4 uvs[3];
        for (int v = 0; v < 3; ++v) {
            uvs[v] = primitives_.vertexUvs[primitives_.vertexIndices[triangle][v]];
        }
        return sums.mean(*material.emissiveTexture, uvs);
    }

    FlatLight surfaceLight(std::uint32_t kind, std::uint32_t id, std::uint32_t emitters) const
    {
        const Material& material = scene_.materials[id];
        FlatLight light{};
        light.kind = kind;
        light.firstEmitter = static_cast<std::uint32_t>(flat_.emitters.size());
        light.emitterCount = emitters;
        light.intensity = flat_.materials[id].emission;  // a texture of one colour is part of it
        light.doubleSided = material.doubleSided ? 1 : 0;
        light.uneven = material.emissiveTexture || material.alphaMode != AlphaMode::Opaque || material.clearcoat > 0.0F ? 1 : 0;
        return light;
    }

    void addEmitter(std::uint32_t primitive, float areaPdf, AliasEntry alias)
    {
        const std::uint32_t record = recordOf_[primitive];
        flat_.emitters.push_back({alias, record, static_cast<std::uint32_t>(flat_.lights.size()), areaPdf, primitive, uvec2(0)});
        flat_.records[record * kRecordTexels + 2].w = static_cast<std::uint32_t>(flat_.emitters.size());
    }

    void add(const FlatLight& light, double power)
    {
        flat_.lights.push_back(light);
        powers_.push_back(power);
    }

    FlatScene& flat_;
    const Scene& scene_;
    const Primitives& primitives_;
    std::span<const std::uint32_t> recordOf_;
    double radius_;
    std::vector<double> powers_;
    std::map<std::uint32_t, EmissiveImage> images_;  // by image
};

}  // namespace

void addLights(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> recordOf)
{
    LightTable table(flat, scene, primitives, recordOf);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        table.addInstance(i);
    }
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
        table.addSphere(scene.spheres[i], i);
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
