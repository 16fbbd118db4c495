#include "host/flatten/media.hpp"

#include "host/error.hpp"
#include "host/flatten/bounds.hpp"
#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <limits>

namespace glim {
namespace {

struct Solid {
    std::uint32_t medium;
    Bounds bounds;
};

Bounds computeSolidBounds(const Scene& scene, const MeshInstance& instance)
{
    Bounds bounds;
    for (const glm::dvec3& position : scene.meshes[instance.mesh].positions) {
        bounds.add(glm::dvec3(instance.worldFromMesh * glm::dvec4(position, 1.0)));
    }
    if (scene.meshes[instance.mesh].isCloud) {
        const glm::dvec3 radius(static_cast<double>(computePointRadius(scene, instance)));
        bounds = {bounds.low - radius, bounds.high + radius};
    }
    return bounds;
}

// By their bounding boxes.
bool differentMediaOverlap(const std::vector<Solid>& solids)
{
    for (std::size_t i = 0; i < solids.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (solids[i].medium != solids[j].medium && overlap(solids[i].bounds, solids[j].bounds)) {
                return true;
            }
        }
    }
    return false;
}

class MediaFinder {
public:
    explicit MediaFinder(const Scene& scene)
        : scene_(scene)
    {
        found_.ofMaterial.assign(scene.materials.size(), 0);
    }

    std::uint32_t numberOf(std::uint32_t material)
    {
        const Material& source = scene_.materials[material];
        std::uint32_t& number = found_.ofMaterial[material];
        if (!source.solid || number != 0) {
            return number;
        }
        const MediumData medium{source.absorption + source.scattering, source.ior, (source.ior - 1.0F) * source.dispersion / 20.0F,
                                vec3(0.0F)};
        const ScatteringData scattering = scatteringOf(source);
        std::size_t known = 0;
        while (known < found_.media.size() && !isKnown(known, medium, scattering)) {
            ++known;
        }
        number = static_cast<std::uint32_t>(known) + 1;
        if (known == found_.media.size()) {
            found_.media.push_back(medium);
            found_.scattering.push_back(scattering);
        }
        if (found_.media.size() > kMaxMedia) {
            throw InputError(MessageId::TooLarge,
                             {part::file(scene_.file), ": more than ", part::value(std::to_string(kMaxMedia)),
                              " different volumes (index, attenuation, scattering, dispersion); expected ", part::expected("fewer")});
        }
        found_.disperses = found_.disperses || medium.spread > 0.0F;
        found_.tracked = found_.tracked || found_.disperses || medium.extinction != vec3(0.0F);
        return number;
    }

    Media find()
    {
        std::vector<Solid> solids;
        for (const MeshInstance& instance : scene_.instances) {
            if (const std::uint32_t medium = numberOf(scene_.meshes[instance.mesh].material)) {
                solids.push_back({medium, computeSolidBounds(scene_, instance)});
            }
        }
        for (const Sphere& sphere : scene_.spheres) {
            if (const std::uint32_t medium = numberOf(sphere.material)) {
                const glm::dvec3 center = scene_.origin + glm::dvec3(sphere.center), radius(static_cast<double>(sphere.radius));
                solids.push_back({medium, {center - radius, center + radius}});
            }
        }
        // Of one medium only, thousands of solids need no comparison.
        found_.tracked = found_.tracked || (found_.media.size() > 1 && differentMediaOverlap(solids));
        return std::move(found_);
    }

private:
    // Without scattering the anisotropy tells no media apart.
    static ScatteringData scatteringOf(const Material& source)
    {
        const vec3 extinction = source.absorption + source.scattering;
        const vec3 albedo = source.scattering / glm::max(extinction, vec3(std::numeric_limits<float>::min()));
        return {glm::min(albedo, vec3(1.0F)), albedo == vec3(0.0F) ? 0.0F : source.scatterAnisotropy};
    }

    bool isKnown(std::size_t i, const MediumData& medium, const ScatteringData& scattering) const
    {
        const MediumData& other = found_.media[i];
        const ScatteringData& its = found_.scattering[i];
        return other.extinction == medium.extinction && other.ior == medium.ior && other.spread == medium.spread &&
               its.albedo == scattering.albedo && its.anisotropy == scattering.anisotropy;
    }

    const Scene& scene_;
    Media found_;
};

}  // namespace

Media findMedia(const Scene& scene) { return MediaFinder(scene).find(); }

}  // namespace glim
