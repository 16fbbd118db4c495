#include "host/render/surfaces.hpp"

#include "host/flatten/project.hpp"
#include "host/image/exr.hpp"
#include "host/render/film_place.hpp"
#include "version.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace glim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kRowsPixels = 1U << 18;
constexpr const char* kFlows[] = {"forwardFlow.", "backwardFlow."};

// Objects by what they are in the file: a node's are in the order of the scene.
std::vector<std::uint32_t> matchObjects(const Scene& from, const Scene& to)
{
    const auto keysOf = [](const Scene& scene) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
        std::vector<std::array<std::uint32_t, 3>> keys;
        const auto add = [&](std::uint32_t node, std::uint32_t mesh) { keys.push_back({node, mesh, counts[{node, mesh}]++}); };
        for (const MeshInstance& instance : scene.instances) {
            add(instance.node, scene.meshes[instance.mesh].fileMesh);
        }
        for (const Sphere& sphere : scene.spheres) {
            add(sphere.node, kNoIndex);
        }
        return keys;
    };
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> places;
    for (const auto& key : keysOf(to)) {
        places.emplace(key, static_cast<std::uint32_t>(places.size()));
    }
    std::vector<std::uint32_t> matches;
    for (const auto& key : keysOf(from)) {
        const auto found = places.find(key);
        matches.push_back(found == places.end() ? kNoIndex : found->second);
    }
    return matches;
}

bool haveSameBits(const Triangle& a, const Triangle& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Which triangles of the mesh `kept` are: some in their order. Those that were lifted after they were placed are not found if others were
// left out, which is kNoIndex.
std::vector<std::uint32_t> findTriangles(const PlacedMesh& placed, std::span<const Triangle> kept)
{
    std::vector<std::uint32_t> found(kept.size());
    std::iota(found.begin(), found.end(), 0U);
    if (kept.size() == placed.triangleCount()) {
        return found;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        std::size_t at = next;
        while (at < placed.triangleCount() && !haveSameBits(placed.triangle(at), kept[i])) {
            ++at;
        }
        const bool isFound = at < placed.triangleCount();
        found[i] = isFound ? static_cast<std::uint32_t>(at) : kNoIndex;
        next = isFound ? at + 1 : next;
    }
    return found;
}

glm::dvec3 originOf(const Scene& scene, const FlatCamera& camera) { return scene.origin + glm::dvec3(camera.position); }

glm::dvec2 pixelOf(const glm::dvec2& film, const glm::dvec2& size) { return 0.5 * size * glm::dvec2(1.0 + film.x, 1.0 - film.y); }

// Where the values of pixels go.
struct Planes {
    Planes(Image& image, std::size_t flowCount)
        : instance(image.counts["instance.X"])
    {
        const std::size_t pixels = std::size_t{image.width} * image.height;
        instance.assign(pixels, kNoIndex);
        const auto allocate = [&](const std::string& name, float value) {
            image.channels[name].assign(pixels, value);
            return image.channels[name].data();
        };
        constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
        position = {allocate("position.X", kNone), allocate("position.Y", kNone), allocate("position.Z", kNone)};
        uv = {allocate("uv.U", kNone), allocate("uv.V", kNone)};
        distance = allocate("distance.Y", std::numeric_limits<float>::infinity());
        for (const std::string flow : std::span(kFlows).first(flowCount)) {
            flows.push_back({allocate(flow + "X", kNone), allocate(flow + "Y", kNone)});
        }
    }

    std::vector<std::uint32_t>& instance;
    std::array<float*, 3> position{};
    std::array<float*, 2> uv{};
    float* distance = nullptr;
    std::vector<std::array<float*, 2>> flows;
};

template <std::size_t N, class Vector>
void store(const std::array<float*, N>& planes, std::size_t pixel, const Vector& value)
{
    for (std::size_t k = 0; k < N; ++k) {
        planes[k][pixel] = static_cast<float>(value[static_cast<int>(k)]);
    }
}

bool seesNothing(const PathRay& ray) { return ray.origin.x > 1e14F; }  // rayOfNothing of shaders/lib/camera.glsl

}  // namespace

// A point of a surface in the world, and which one.
struct SurfaceTracer::Meeting {
    ScenePart part;
    glm::dvec3 world{kNan};
    glm::uvec3 corners{kNoIndex};  // of the mesh, of a triangle that was found
    glm::dvec3 weights{0.0};
};

SurfaceTracer::SurfaceTracer(const Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera,
                             const SceneInstances& instances, const Flow* flow, std::shared_ptr<const CameraRayKernels> kernels)
    : prepared_(prepared),
      instances_(instances),
      size_(renderer.settings().width, renderer.settings().height),
      rays_(renderer.resources().device, *renderer.resources().shared, prepared.flat, camera, renderer.settings(), std::move(kernels),
            RayPlace::Centers)
{
    if (flow != nullptr) {
        for (const OtherMoment* other : {&flow->after, &flow->before}) {
            moments_.push_back({*other, matchObjects(prepared.scene, other->scene)});
        }
    }
}

const std::vector<std::uint32_t>& SurfaceTracer::trianglesOf(std::uint32_t object)
{
    const auto [found, isNew] = triangles_.try_emplace(object);
    if (isNew) {
        const Primitives& primitives = prepared_.primitives;
        const MeshInstance& instance = prepared_.scene.instances[object];
        const auto shared = std::ranges::find(primitives.sharedMeshes, instance.mesh, &SharedMesh::mesh);
        const std::uint32_t first = primitives.firstTriangles[object], end = primitives.firstTriangles[object + 1];
        found->second =
            shared != primitives.sharedMeshes.end()
                ? findTriangles(PlacedMesh(prepared_.scene.meshes[instance.mesh], Placing(glm::dmat3(1.0), -shared->center)),
                                shared->triangles)
                : findTriangles(PlacedMesh(prepared_.scene, instance), std::span(primitives.triangles).subspan(first, end - first));
    }
    return found->second;
}

SurfaceTracer::Meeting SurfaceTracer::meet(const PathRay& ray, const PathHit& hit)
{
    Meeting meeting;
    meeting.part = findPart(prepared_, hit.primitiveRef);
    if (meeting.part.object == kNoIndex) {
        return meeting;
    }
    const Scene& scene = prepared_.scene;
    meeting.world = scene.origin + glm::dvec3(ray.origin) + static_cast<double>(hit.t) * glm::dvec3(ray.direction);
    if (meeting.part.object >= scene.instances.size() || meeting.part.point != kNoIndex) {
        return meeting;
    }
    const std::uint32_t triangle = trianglesOf(meeting.part.object)[meeting.part.triangle];
    if (triangle != kNoIndex) {
        const MeshInstance& instance = scene.instances[meeting.part.object];
        const Mesh& mesh = scene.meshes[instance.mesh];
        const bool mirrors = glm::determinant(glm::dmat3(instance.worldFromMesh)) < 0.0;  // as PlacedMesh::corners; shared ones never do
        const std::uint32_t* corner = &mesh.indices[std::size_t{3} * triangle];
        const bool isSwapped = mirrors && !isInstanced(prepared_.flat, hit.primitiveRef);
        meeting.corners = isSwapped ? glm::uvec3(corner[0], corner[2], corner[1]) : glm::uvec3(corner[0], corner[1], corner[2]);
        const glm::dvec2 b(hit.barycentric);
        meeting.weights = {1.0 - b.x - b.y, b.x, b.y};
    }
    return meeting;
}

namespace {

template <class Values, class Weights>
auto blend(const Values& values, const glm::uvec3& corners, const Weights& weights)
{
    return weights.x * values[corners.x] + weights.y * values[corners.y] + weights.z * values[corners.z];
}

glm::dvec3 transform(const glm::dmat4& matrix, const glm::dvec3& point) { return glm::dvec3(matrix * glm::dvec4(point, 1.0)); }

// Where a point of a cloud or of a mesh that was not found is in the mesh's space, from the place that it goes with.
glm::dvec3 anchorOf(const Mesh& mesh, std::uint32_t point)
{
    return point == kNoIndex ? glm::dvec3(0.0) : mesh.positions[mesh.lines.empty() ? point : mesh.lines[point].x];
}

}  // namespace

// In pixels.
glm::dvec2 SurfaceTracer::flowTo(const Moment& moment, const Meeting& meeting, const PathRay& ray, const glm::dvec2& center) const
{
    const Scene &now = prepared_.scene, &then = moment.other.scene;
    const FlatCamera& camera = moment.other.camera;
    const auto from = [&]() -> std::optional<glm::dvec3> {
        if (meeting.part.object == kNoIndex) {
            const bool isDirection = camera.kind != kOrthographic && !seesNothing(ray);
            return isDirection ? std::optional(glm::dvec3(ray.direction)) : std::nullopt;
        }
        const std::uint32_t object = moment.objects[meeting.part.object];
        if (object == kNoIndex) {
            return std::nullopt;
        }
        if (meeting.part.object >= now.instances.size()) {
            const Sphere& before = now.spheres[meeting.part.object - now.instances.size()];
            const Sphere& after = then.spheres[object - then.instances.size()];
            const glm::dvec3 offset = meeting.world - (now.origin + glm::dvec3(before.center));
            const double scale = static_cast<double>(after.radius) / static_cast<double>(before.radius);
            return then.origin + glm::dvec3(after.center) + scale * offset - originOf(then, camera);
        }
        const MeshInstance &before = now.instances[meeting.part.object], &after = then.instances[object];
        const Mesh &meshNow = now.meshes[before.mesh], &meshThen = then.meshes[after.mesh];
        if (meshNow.positions.size() != meshThen.positions.size()) {
            return std::nullopt;
        }
        const bool isFound = meeting.corners.x != kNoIndex;
        const glm::dvec3 inMesh = isFound ? blend(meshThen.positions, meeting.corners, meeting.weights)
                                          : transform(glm::inverse(before.worldFromMesh), meeting.world) -
                                                anchorOf(meshNow, meeting.part.point) + anchorOf(meshThen, meeting.part.point);
        return transform(after.worldFromMesh, inMesh) - originOf(then, camera);
    }();
    const std::optional<glm::dvec2> film = from ? projectToFilm(camera, *from) : std::nullopt;
    return film ? pixelOf(*film, size_) - center : glm::dvec2(kNan);
}

glm::dvec2 SurfaceTracer::uvOf(const Meeting& meeting) const
{
    if (meeting.corners.x == kNoIndex) {
        return glm::dvec2(kNan);
    }
    const Mesh& mesh = prepared_.scene.meshes[prepared_.scene.instances[meeting.part.object].mesh];
    return mesh.uv0.empty() ? glm::dvec2(kNan) : glm::dvec2(blend(mesh.uv0, meeting.corners, glm::vec3(meeting.weights)));
}

Image SurfaceTracer::rows(std::uint32_t width, std::uint32_t first, std::uint32_t count)
{
    Image image;
    image.width = width;
    image.height = count;
    Planes planes(image, moments_.size());
    std::vector<std::uint32_t> chosen;
    for (std::size_t begin = 0; begin < planes.instance.size(); begin += chosen.size()) {
        chosen.resize(std::min<std::size_t>(planes.instance.size() - begin, rays_.rayCount()));
        std::iota(chosen.begin(), chosen.end(), static_cast<std::uint32_t>(std::size_t{first} * width + begin));
        const std::vector<PathHit> hits = rays_.trace(chosen, 0, 1);
        const std::vector<PathRay> rays = rays_.rays(chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const std::size_t at = begin + i;
            const Meeting meeting = meet(rays[i], hits[i]);
            if (meeting.part.object != kNoIndex) {
                planes.instance[at] = instances_.ofObject(meeting.part.object);
                planes.distance[at] = hits[i].t;
            }
            store(planes.position, at, meeting.world);
            store(planes.uv, at, uvOf(meeting));
            const glm::dvec2 center(chosen[i] % width + 0.5, chosen[i] / width + 0.5);
            for (std::size_t k = 0; k < moments_.size(); ++k) {
                store(planes.flows[k], at, flowTo(moments_[k], meeting, rays[i], center));
            }
        }
    }
    return image;
}

std::vector<MetInstances> SurfaceTracer::meetAll(std::span<const std::uint32_t> pixels)
{
    constexpr double kStep = 1e-5;       // of the distance and of coordinates: float32 rounds them by 6e-8
    constexpr int kMostSurfaces = 4096;  // that a ray passes, or rays that rounding holds on one would never end
    std::vector<MetInstances> met(pixels.size());
    std::vector<std::uint32_t> places(pixels.size()), chosen(pixels.begin(), pixels.end());
    std::iota(places.begin(), places.end(), 0U);
    std::vector<PathHit> hits = rays_.trace(chosen, 0, 1);
    std::vector<PathRay> rays = rays_.rays(chosen.size());
    const std::vector<PathRay> cameraRays = rays;
    std::vector<double> distances(pixels.size(), 0.0);
    for (int passed = 0; passed < kMostSurfaces && !chosen.empty(); ++passed) {
        std::size_t left = 0;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const std::uint32_t object = findPart(prepared_, hits[i].primitiveRef).object, place = places[i];
            if (object == kNoIndex) {
                continue;
            }
            auto& [seen, all] = met[place];
            const std::uint32_t instance = instances_.ofObject(object);
            seen = all.empty() ? instance : seen;
            if (const auto at = std::ranges::lower_bound(all, instance); at == all.end() || *at != instance) {
                all.insert(at, instance);
            }
            const glm::dvec3 from(cameraRays[place].origin), along(cameraRays[place].direction);
            double& distance = distances[place];
            distance += static_cast<double>(hits[i].t);
            const glm::dvec3 reached = glm::abs(from + distance * along);
            distance += kStep * std::max({distance, reached.x, reached.y, reached.z});  // more than float32 rounds places by
            rays[left] = {vec3(from + distance * along), kNoPrimitive, cameraRays[place].direction, 0};
            chosen[left] = chosen[i];
            places[left++] = place;
        }
        chosen.resize(left);
        places.resize(left);
        rays.resize(left);
        hits = chosen.empty() ? std::vector<PathHit>() : rays_.trace(chosen, rays);
    }
    return met;
}

void writeSurfaces(const std::filesystem::path& path, SurfaceTracer& tracer, const Film& film)
{
    const std::uint32_t most = std::max(1U, kRowsPixels / film.width);
    const auto bandAt = [&](std::uint32_t first) { return tracer.rows(film.width, first, std::min(most, film.height - first)); };
    Image band = bandAt(0), picture;
    picture.attributes["software"] = "glim " GLIM_VERSION;
    for (const auto& [name, values] : band.channels) {
        picture.channels[name];
    }
    picture.counts["instance.X"];
    describePlace(picture, film);
    ExrWriter writer(path, picture);
    for (std::uint32_t first = 0; first < film.height; first += band.height) {
        band = first == 0 ? std::move(band) : bandAt(first);
        writer.write(band);
    }
    writer.commit();
}

}  // namespace glim
