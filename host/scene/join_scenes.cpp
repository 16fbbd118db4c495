#include "host/scene/join_scenes.hpp"

#include "host/error.hpp"
#include "host/scene/uniform_scale.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// Farther away, squares of coordinates do not fit float32. The limit is that of one file's extent (gltf/read_geometry.cpp).
constexpr double kMaxDistance = 1e18;

template <class T>
void append(std::vector<T>& values, const std::vector<T>& others)
{
    values.insert(values.end(), others.begin(), others.end());
}

// Numbers of the first things that are added.
struct Firsts {
    std::uint32_t mesh, material, image, node, fileMesh;
};

class Joiner {
public:
    explicit Joiner(Scene& scene)
        : scene_(scene)
    {}

    Firsts firsts(std::size_t meshes) const
    {
        const auto count = [](std::size_t size) { return static_cast<std::uint32_t>(size); };
        return {count(meshes), count(scene_.materials.size()), count(scene_.images.size()), count(scene_.nodeNames.size()),
                count(scene_.meshNames.size())};
    }

    void add(const AddedScene& added, const Firsts& first)
    {
        const Scene& other = added.scene;
        for (Material material : other.materials) {
            for (std::optional<Texture>& texture : material.textures) {
                if (texture) {
                    texture->image += first.image;
                }
            }
            scene_.materials.push_back(std::move(material));
        }
        for (MeshInstance instance : other.instances) {
            instance.mesh += first.mesh;
            instance.node += first.node;
            instance.worldFromMesh = added.worldFromScene * instance.worldFromMesh;
            checkDistance(added, instance, other.meshes[instance.mesh - first.mesh]);
            scene_.instances.push_back(std::move(instance));
        }
        for (const Sphere& sphere : other.spheres) {
            addSphere(added, sphere, first);
        }
        for (const PunctualLight& light : other.lights) {
            addLight(added, light);
        }
        scene_.addedInstances += other.instances.size();
        scene_.addedSpheres += other.spheres.size();
        scene_.flattened += other.flattened;
        append(scene_.nodeNames, other.nodeNames);
        append(scene_.meshNames, other.meshNames);
        append(scene_.images, other.images);
        append(scene_.files, other.files);
    }

private:
    // By the corners of a box around the mesh.
    void checkDistance(const AddedScene& added, const MeshInstance& instance, const Mesh& mesh) const
    {
        if (mesh.positions.empty()) {
            return;
        }
        glm::dvec3 low = mesh.positions.front(), high = low;
        for (const glm::dvec3& position : mesh.positions) {
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 corner((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
            checkDistance(added, glm::dvec3(instance.worldFromMesh * glm::dvec4(corner, 1.0)));
        }
    }

    void checkDistance(const AddedScene& added, const glm::dvec3& world) const
    {
        const double distance = glm::length(world - scene_.origin);
        if (!(distance <= kMaxDistance)) {
            throw InputError(MessageId::TooLarge, {part::file(added.scene.file), " is added ", part::value(exactText(distance)),
                                                   " m away from the scene; expected ", part::expected("at most 1e18 m")});
        }
    }

    glm::vec3 place(const AddedScene& added, const glm::vec3& point) const
    {
        const glm::dvec3 world = glm::dmat3(added.worldFromScene) * (glm::dvec3(point) + added.scene.origin);
        checkDistance(added, world + glm::dvec3(added.worldFromScene[3]));
        return world + (glm::dvec3(added.worldFromScene[3]) - scene_.origin);
    }

    void addSphere(const AddedScene& added, Sphere sphere, const Firsts& first)
    {
        const double scale = computeUniformScale(glm::dmat3(added.worldFromScene));
        if (scale == 0.0) {
            throw InputError(MessageId::Unsupported,
                             {part::file(added.scene.file), " has spheres, and its matrix scales them unevenly or shears them; expected ",
                              part::expected("a uniform scale")});
        }
        sphere.center = place(added, sphere.center);
        sphere.radius = static_cast<float>(scale * static_cast<double>(sphere.radius));
        sphere.material += first.material;
        sphere.node += first.node;
        scene_.spheres.push_back(std::move(sphere));
    }

    void addLight(const AddedScene& added, PunctualLight light)
    {
        light.position = place(added, light.position);
        light.direction = glm::normalize(glm::dmat3(added.worldFromScene) * glm::dvec3(light.direction));
        scene_.lights.push_back(std::move(light));
    }

    Scene& scene_;
};

bool areSame(const std::vector<SharedVector<Mesh>>& a, const std::vector<SharedVector<Mesh>>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const SharedVector<Mesh>& x, const SharedVector<Mesh>& y) { return x.isSameAs(y); });
}

}  // namespace

Scene joinScenes(Scene scene, const std::vector<AddedScene>& others, JoinedMeshes& joined)
{
    Joiner joiner(scene);
    std::vector<SharedVector<Mesh>> parts{scene.meshes};
    std::vector<Firsts> firsts;
    std::vector<std::uint32_t> firstMaterials;
    std::size_t meshes = scene.meshes.size();
    for (const AddedScene& added : others) {
        firsts.push_back(joiner.firsts(meshes));
        firstMaterials.push_back(firsts.back().material);
        joiner.add(added, firsts.back());
        parts.push_back(added.scene.meshes);
        meshes += added.scene.meshes.size();
    }
    std::uint64_t bytes = 0;
    for (const TextureImage& image : scene.images) {
        bytes += image.pixels->rgba8.size() + 2 * image.pixels->rgba16.size();
    }
    if (bytes > kMaxTextureBytes) {
        throw InputError(MessageId::TooLarge, {part::file(scene.file), " and the files that are added have textures of more than ",
                                               part::value(std::to_string(kMaxTextureBytes >> 20U)), " MiB; expected ",
                                               part::expected("fewer or smaller ones (--max-texture)")});
    }
    // An edit may hide the last sphere of the default material, and then the numbers behind it change.
    if (firstMaterials != joined.firstMaterials || !areSame(parts, joined.parts)) {
        std::vector<Mesh> all(scene.meshes.begin(), scene.meshes.end());
        for (std::size_t i = 0; i < others.size(); ++i) {
            for (Mesh mesh : others[i].scene.meshes) {
                mesh.material += firsts[i].material;
                mesh.fileMesh += mesh.fileMesh == kNoIndex ? 0 : firsts[i].fileMesh;
                all.push_back(std::move(mesh));
            }
        }
        joined = {std::move(parts), std::move(firstMaterials), std::move(all)};
    }
    scene.meshes = joined.meshes;
    return scene;
}

}  // namespace glim
