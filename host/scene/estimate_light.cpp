#include "host/scene/estimate_light.hpp"

#include "host/image/srgb.hpp"
#include "host/scene/placed_mesh.hpp"
#include "shaders/shared/luminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

namespace glim {
namespace {

constexpr int kSide = 64;  // of the estimate, in pixels
// Radiance of what is just not lost on black; the sRGB code 39 of 255.
constexpr double kShownRadiance = 0.02;
constexpr double kGreyAlbedo = 0.5;
// What has this roughness, or this albedo of a diffuse lobe, shows a lamp over all of its surface.
constexpr double kRough = 0.5, kDiffuse = 0.25;
// Of larger scenes every other triangle, point or light is taken, or every third, and so on.
constexpr std::size_t kMaxShapes = 2'000'000, kMaxLights = 4096;
constexpr std::size_t kLampPoints = 256;  // for all surfaces that emit

std::size_t strideFor(std::size_t count, std::size_t most) { return std::max<std::size_t>(1, (count + most - 1) / most); }

// What a ray of the estimate meets first.
struct SeenPoint {
    double depth = std::numeric_limits<double>::infinity();
    glm::dvec3 position{0.0};
    std::uint32_t material = kNoIndex;
};

// A ray whose parameter is the depth along the camera's axis.
struct DepthRay {
    glm::dvec3 origin, direction;
};

// Surfaces as the camera sees them, the nearest in each pixel.
class DepthPicture {
public:
    explicit DepthPicture(const Camera& camera)
        : isPerspective_(camera.kind == Camera::Kind::Perspective),
          position_(camera.position),
          forward_(camera.forward),
          seen_(std::size_t{kSide} * kSide)
    {
        const double high = std::tan(0.5 * static_cast<double>(camera.yfov));
        const double wide = high * static_cast<double>(camera.aspectRatio.value_or(kUsualAspectRatio));
        right_ = glm::dvec3(camera.right) * (isPerspective_ ? wide : static_cast<double>(camera.halfWidth));
        up_ = glm::dvec3(camera.up) * (isPerspective_ ? high : static_cast<double>(camera.halfHeight));
    }

    void add(const Triangle& triangle, std::uint32_t material, bool meetsBack)
    {
        const std::array<glm::dvec3, 3> corners{triangle.vertices[0], triangle.vertices[1], triangle.vertices[2]};
        const auto& [a, b, c] = corners;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        forEachPixel(
            corners,
            [&, &a = a, &b = b, &c = c](const DepthRay& ray) -> std::optional<double> {
                const double towards = -glm::dot(normal, ray.direction);
                if (!(meetsBack ? towards != 0.0 : towards > 0.0)) {
                    return std::nullopt;
                }
                const glm::dvec3 q = glm::cross(ray.origin - a, ray.direction) / towards;
                const double u = glm::dot(c - a, q), v = -glm::dot(b - a, q);
                return u >= 0.0 && v >= 0.0 && u + v <= 1.0 ? std::optional(glm::dot(normal, ray.origin - a) / towards) : std::nullopt;
            },
            material);
    }

    void addSphere(const glm::dvec3& center, double radius, std::uint32_t material)
    {
        std::array<glm::dvec3, 8> corners{};
        for (unsigned i = 0; i < corners.size(); ++i) {
            corners[i] = center + radius * glm::dvec3(i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0);
        }
        forEachPixel(
            corners,
            [&](const DepthRay& ray) -> std::optional<double> {
                const glm::dvec3 from = ray.origin - center;
                const double a = glm::dot(ray.direction, ray.direction), half = glm::dot(from, ray.direction);
                const double square = half * half - a * (glm::dot(from, from) - radius * radius);
                return square >= 0.0 ? std::optional((-half - std::sqrt(square)) / a) : std::nullopt;
            },
            material);
    }

    const std::vector<SeenPoint>& seen() const { return seen_; }

private:
    // The pixels, [first, second) of the axis, whose centres may lie between two places of the film's plane, from -1 to 1.
    static std::pair<int, int> pixelsBetween(double low, double high)
    {
        const auto indexOf = [](double place) {
            const double index = std::ceil(0.5 * kSide * (place + 1.0) - 0.5);
            return index > 0.0 ? static_cast<int>(std::min(index, double{kSide})) : 0;  // 0 too if it is NaN, as far from the camera
        };
        return {indexOf(low), indexOf(std::nextafter(high, 2.0))};
    }

    // `meet` gives the depth at which a ray meets the shape. The shape lies within the hull of `points`.
    template <class Meet>
    void forEachPixel(std::span<const glm::dvec3> points, const Meet& meet, std::uint32_t material)
    {
        glm::dvec2 low(1.0), high(-1.0);
        bool before = false, behind = false;
        for (const glm::dvec3& point : points) {
            const glm::dvec3 from = point - position_;
            const double depth = glm::dot(from, forward_);
            (depth > 0.0 ? before : behind) = true;
            const glm::dvec2 place(glm::dot(from, right_) / glm::dot(right_, right_), glm::dot(from, up_) / glm::dot(up_, up_));
            const glm::dvec2 projected = isPerspective_ ? place / depth : place;
            low = glm::min(low, projected);
            high = glm::max(high, projected);
        }
        if (!before) {
            return;
        }
        const bool anywhere = behind && isPerspective_;
        const auto [x0, x1] = anywhere ? std::pair(0, kSide) : pixelsBetween(low.x, high.x);
        const auto [y0, y1] = anywhere ? std::pair(0, kSide) : pixelsBetween(low.y, high.y);
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const glm::dvec3 aside = ((2.0 * x + 1.0) / kSide - 1.0) * right_ + ((2.0 * y + 1.0) / kSide - 1.0) * up_;
                const DepthRay ray = isPerspective_ ? DepthRay{position_, forward_ + aside} : DepthRay{position_ + aside, forward_};
                const std::optional<double> depth = meet(ray);
                SeenPoint& seen = seen_[static_cast<std::size_t>(y * kSide + x)];
                if (depth && *depth > 0.0 && *depth < seen.depth) {
                    seen = {*depth, ray.origin + *depth * ray.direction, material};
                }
            }
        }
    }

    bool isPerspective_;
    glm::dvec3 position_, forward_;
    glm::dvec3 right_, up_;  // from the middle of the picture to its edges, at a depth of 1
    std::vector<SeenPoint> seen_;
};

// The mean of a grid of texels, as the file stores them; 1 without a texture.
glm::dvec3 meanTexel(const Scene& scene, const std::optional<Texture>& texture)
{
    if (!texture) {
        return glm::dvec3(1.0);
    }
    constexpr std::size_t kTexels = 1024;
    const DecodedImage& image = *scene.images[texture->image].pixels;
    const std::size_t texels = std::size_t{image.width} * image.height, stride = strideFor(texels, kTexels);
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < texels; i += stride, count += 1.0) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const std::size_t at = 4 * i + channel;
            sum[static_cast<int>(channel)] += image.rgba8.empty() ? image.rgba16[at] / 65535.0 : image.rgba8[at] / 255.0;
        }
    }
    return sum / count;
}

// Luminance of the radiance that a lamp's surface has; 0 of what is no lamp.
double lampRadiance(const Scene& scene, const Material& material)
{
    if (material.isDisplay) {
        return 0.0;
    }
    const glm::dvec3 texel = meanTexel(scene, material.textures[kSlotEmissive]);
    return computeLuminance(glm::dvec3(material.emission) *
                            glm::dvec3(linearFromSrgb(texel.r), linearFromSrgb(texel.g), linearFromSrgb(texel.b)));
}

// Mirrors and glass show what is around them.
bool showsLamps(const Scene& scene, const Material& material)
{
    const glm::dvec3 texel = meanTexel(scene, material.textures[kSlotMetallicRoughness]);
    const double transmission = static_cast<double>(material.transmission) * meanTexel(scene, material.textures[kSlotTransmission]).r;
    const double diffuse = (1.0 - static_cast<double>(material.metallic) * texel.b) * (1.0 - transmission);
    return diffuse >= kDiffuse || static_cast<double>(material.roughness) * texel.g >= kRough;
}

// What stands for a part of the surfaces that emit. Its intensity towards w is power * dot(normal, w), or `power` without a normal.
struct LampPoint {
    glm::dvec3 position, normal;
    double power = 0.0;  // radiance times area, W/sr
    double area = 0.0;
    bool emitsBackwards = false;
};

std::vector<LampPoint> listLamps(const Scene& scene)
{
    std::vector<double> radiances;
    for (const Material& material : scene.materials) {
        radiances.push_back(lampRadiance(scene, material));
    }
    std::vector<LampPoint> all;
    const auto addSphere = [&all](const glm::dvec3& center, double radius, double radiance) {
        const double area = std::numbers::pi * radius * radius;
        if (radiance > 0.0 && area > 0.0) {
            all.push_back({center, glm::dvec3(0.0), radiance * area, area, true});
        }
    };
    for (const MeshInstance& instance : scene.instances) {
        const std::uint32_t material = scene.meshes[instance.mesh].material;
        if (radiances[material] > 0.0) {
            const PlacedMesh placed(scene, instance);
            if (scene.meshes[instance.mesh].isCloud) {
                const double radius = static_cast<double>(computePointRadius(scene, instance));
                for (const glm::vec3& center : placed.positions()) {
                    addSphere(glm::dvec3(center), radius, radiances[material]);
                }
            }
            for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
                const Triangle triangle = placed.triangle(i);
                const glm::dvec3 normal = faceNormal(triangle);
                const double area = 0.5 * glm::length(normal);
                if (area > 0.0) {
                    const glm::dvec3 sum =
                        glm::dvec3(triangle.vertices[0]) + glm::dvec3(triangle.vertices[1]) + glm::dvec3(triangle.vertices[2]);
                    all.push_back(
                        {sum / 3.0, 0.5 * normal / area, radiances[material] * area, area, scene.materials[material].doubleSided});
                }
            }
        }
    }
    for (const Sphere& sphere : scene.spheres) {
        addSphere(glm::dvec3(sphere.center), static_cast<double>(sphere.radius), radiances[sphere.material]);
    }
    return all;
}

// At most kLampPoints, of equal power: a systematic sample.
std::vector<LampPoint> chooseLamps(const std::vector<LampPoint>& all)
{
    if (all.size() <= kLampPoints) {
        return all;
    }
    double power = 0.0, area = 0.0;
    for (const LampPoint& lamp : all) {
        power += lamp.power;
        area += lamp.area;
    }
    std::vector<LampPoint> chosen;
    double sum = 0.0;
    for (LampPoint lamp : all) {
        sum += lamp.power;
        lamp.power = power / kLampPoints;
        lamp.area = area / kLampPoints;
        while (static_cast<double>(chosen.size()) + 0.5 <= sum / lamp.power && chosen.size() < kLampPoints) {
            chosen.push_back(lamp);
        }
    }
    return chosen;
}

// W/m^2 on a surface that faces the lamp. `area` keeps it finite close by.
double irradianceOf(const LampPoint& lamp, const glm::dvec3& position)
{
    const glm::dvec3 way = position - lamp.position;
    const double squared = glm::dot(way, way), along = glm::dot(way, lamp.normal);
    const bool isSphere = lamp.normal == glm::dvec3(0.0);
    const double cosine = isSphere ? 1.0 : (lamp.emitsBackwards ? std::abs(along) : std::max(along, 0.0)) / std::sqrt(squared + lamp.area);
    return lamp.power * cosine / (squared + lamp.area);
}

// The same of a punctual light, which is as bright as in its middle all over its cone and its range.
double irradianceOf(const PunctualLight& light, const glm::dvec3& position)
{
    const double intensity = computeLuminance(glm::dvec3(light.intensity));
    if (light.kind == PunctualLight::Kind::Directional) {
        return intensity;
    }
    const glm::dvec3 way = position - glm::dvec3(light.position);
    const double squared = glm::dot(way, way);
    const double versine = 1.0 - glm::dot(way, glm::dvec3(light.direction)) / std::sqrt(squared);
    const bool isOutside = (light.kind == PunctualLight::Kind::Spot && versine > static_cast<double>(light.versineOuter)) ||
                           (light.range > 0.0F && squared > static_cast<double>(light.range) * static_cast<double>(light.range));
    return isOutside ? 0.0 : intensity / squared;
}

DepthPicture drawDepths(const Scene& scene, const Camera& camera)
{
    const auto countShapes = [&scene](const MeshInstance& instance) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        return mesh.isCloud ? mesh.positions.size() : mesh.indices.size() / 3;
    };
    std::size_t count = 0;
    for (const MeshInstance& instance : scene.instances) {
        count += countShapes(instance);
    }
    const std::size_t stride = strideFor(count, kMaxShapes);
    DepthPicture picture(camera);
    std::size_t next = 0;  // of the instance's triangles or points
    for (const MeshInstance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const bool meetsBack = scene.showsBackFaces || meetsBackFaces(scene.materials[mesh.material]);
        const std::size_t shapes = countShapes(instance);
        if (next < shapes) {
            const PlacedMesh placed(scene, instance);
            const double radius = mesh.isCloud ? static_cast<double>(computePointRadius(scene, instance)) : 0.0;
            for (; next < shapes; next += stride) {
                if (mesh.isCloud) {
                    picture.addSphere(glm::dvec3(placed.positions()[next]), radius, mesh.material);
                } else {
                    picture.add(placed.triangle(next), mesh.material, meetsBack);
                }
            }
        }
        next -= shapes;
    }
    for (const Sphere& sphere : scene.spheres) {
        picture.addSphere(glm::dvec3(sphere.center), static_cast<double>(sphere.radius), sphere.material);
    }
    return picture;
}

}  // namespace

bool hasLight(const Scene& scene)
{
    const std::vector<bool> used = findUsedMaterials(scene);
    bool isLit = false;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        isLit = isLit || (used[i] && !scene.materials[i].isDisplay && scene.materials[i].emission != glm::vec3(0.0F));
    }
    return isLit || !scene.lights.empty() || scene.environment;
}

double estimateLitShare(const Scene& scene, const Camera& camera)
{
    enum class Answer { DoesNotCount, Dark, ByLight };
    std::vector<Answer> answers;
    for (const Material& material : scene.materials) {
        const bool shines = material.unlit || (material.emission != glm::vec3(0.0F) && !material.textures[kSlotEmissive]);
        answers.push_back(shines ? Answer::DoesNotCount : showsLamps(scene, material) ? Answer::ByLight : Answer::Dark);
    }
    const std::vector<LampPoint> lamps = chooseLamps(listLamps(scene));
    const std::size_t stride = strideFor(scene.lights.size(), kMaxLights);
    const double wanted = kShownRadiance * std::numbers::pi / kGreyAlbedo;
    const auto isLit = [&](const glm::dvec3& position) {
        double irradiance = 0.0;
        for (std::size_t i = 0; i < lamps.size() && irradiance < wanted; ++i) {
            irradiance += irradianceOf(lamps[i], position);
        }
        for (std::size_t i = 0; i < scene.lights.size() && irradiance < wanted; i += stride) {
            irradiance += static_cast<double>(stride) * irradianceOf(scene.lights[i], position);
        }
        return irradiance >= wanted;
    };
    const DepthPicture picture = drawDepths(scene, camera);
    double count = 0.0, lit = 0.0;
    for (const SeenPoint& seen : picture.seen()) {
        const Answer answer = seen.material == kNoIndex ? Answer::DoesNotCount : answers[seen.material];
        count += answer != Answer::DoesNotCount ? 1.0 : 0.0;
        lit += answer == Answer::ByLight && isLit(seen.position) ? 1.0 : 0.0;
    }
    return count > 0.0 ? lit / count : 1.0;
}

}  // namespace glim
