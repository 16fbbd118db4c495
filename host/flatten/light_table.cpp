#include "host/flatten/light_table.hpp"

#include "host/flatten/alias_table.hpp"

#include <algorithm>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;

// A colour counts by its strongest channel, which does not change when channels are swapped.
double strength(const glm::vec3& color) { return static_cast<double>(std::max({color.r, color.g, color.b})); }

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
        const Material& material = scene_.materials[scene_.meshes[scene_.instances[instance].mesh].material];
        const std::uint32_t first = primitives_.firstTriangles[instance], count = primitives_.firstTriangles[instance + 1] - first;
        if (count == 0 || !(strength(material.emission) > 0.0)) {
            return;
        }
        std::vector<double> areas;
        for (std::uint32_t i = 0; i < count; ++i) {
            areas.push_back(area(primitives_.triangles[first + i]));
        }
        const AliasTable table = buildAliasTable(areas);
        FlatLight light = surfaceLight(kTriangleLight, material, count);
        flat_.features |= kFeatureTriangleLights;
        double total = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto areaPdf = static_cast<float>(table.probabilities[i] / areas[i]);
            addEmitter(first + i, areaPdf, table.entries[i]);
            total += areas[i];
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
        FlatLight light = surfaceLight(kSphereLight, material, 1);
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

    void addEnvironment(const glm::vec3& radiance)
    {
        if (!(strength(radiance) > 0.0)) {
            return;
        }
        FlatLight light{};
        light.kind = kEnvironmentLight;
        light.intensity = radiance;
        flat_.features |= kFeatureEnvironment;
        flat_.environment = radiance;
        flat_.environmentLight = static_cast<std::uint32_t>(flat_.lights.size());
        add(light, 4.0 * kPi * kPi * radius_ * radius_ * strength(radiance));
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
    FlatLight surfaceLight(std::uint32_t kind, const Material& material, std::uint32_t emitters) const
    {
        FlatLight light{};
        light.kind = kind;
        light.firstEmitter = static_cast<std::uint32_t>(flat_.emitters.size());
        light.emitterCount = emitters;
        light.intensity = material.emission;
        light.doubleSided = material.doubleSided ? 1 : 0;
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
