#include "host/scene/join_scenes.hpp"

#include "host/error.hpp"

#include <cmath>

namespace glim {
namespace {

// The factor by which the matrix lengthens everything, or 0 if it lengthens one direction more than another.
double uniformScaleOf(const glm::dmat3& linear)
{
    constexpr double kRounding = 1e-5;  // of matrices that are printed floats
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    const glm::dmat3 difference = glm::transpose(linear) * linear - glm::dmat3(scale * scale);
    for (int c = 0; c < 9; ++c) {
        if (!(std::abs(difference[c / 3][c % 3]) <= kRounding * scale * scale)) {
            return 0.0;
        }
    }
    return scale;
}

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
    glm::vec3 place(const AddedScene& added, const glm::vec3& point) const
    {
        const glm::dvec3 world = glm::dmat3(added.worldFromScene) * (glm::dvec3(point) + added.scene.origin);
        return world + (glm::dvec3(added.worldFromScene[3]) - scene_.origin);
    }

    void addSphere(const AddedScene& added, Sphere sphere, const Firsts& first)
    {
        const double scale = uniformScaleOf(glm::dmat3(added.worldFromScene));
        if (scale == 0.0) {
            throw InputError(added.scene.file +
                             " has spheres, and its matrix scales them unevenly or shears them; expected a uniform scale");
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
    std::size_t meshes = scene.meshes.size();
    for (const AddedScene& added : others) {
        firsts.push_back(joiner.firsts(meshes));
        joiner.add(added, firsts.back());
        parts.push_back(added.scene.meshes);
        meshes += added.scene.meshes.size();
    }
    if (!areSame(parts, joined.parts)) {
        std::vector<Mesh> all(scene.meshes.begin(), scene.meshes.end());
        for (std::size_t i = 0; i < others.size(); ++i) {
            for (Mesh mesh : others[i].scene.meshes) {
                mesh.material += firsts[i].material;
                mesh.fileMesh += mesh.fileMesh == kNoIndex ? 0 : firsts[i].fileMesh;
                all.push_back(std::move(mesh));
            }
        }
        joined = {std::move(parts), std::move(all)};
    }
    scene.meshes = joined.meshes;
    return scene;
}

}  // namespace glim
