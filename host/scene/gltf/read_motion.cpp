#include "host/scene/gltf/read_motion.hpp"

#include "host/scene/gltf/animate_gltf.hpp"
#include "host/scene/gltf/pose_mesh.hpp"
#include "host/scene/gltf/read_accessor.hpp"
#include "host/scene/gltf/read_geometry.hpp"
#include "host/scene/gltf/read_lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace glim {
namespace {

constexpr const char* kMovingLamps = "lamps that move have no motion blur: they stay where they are at the frame's time";
constexpr const char* kMovingSpheres =
    "spheres, points and lines that move have no motion blur: they stay where they are at the frame's time";

// How far what moves may be from where the file has it: shares of a mesh's extent, of a camera's way, and radians.
constexpr double kShareOfExtent = 1e-4, kShareOfWay = 1e-4, kTurn = 1e-5;
constexpr double kFloatRounding = 0x1p-22;  // of a camera's position: twice the step of float32

// Where a file's things are at one time.
struct Moment {
    std::map<std::size_t, std::vector<glm::dmat4>> placings;  // by node that carries a mesh without a skin: of each placing
    std::map<std::size_t, MeshPose> poses;                    // by node that carries a mesh
    std::map<std::size_t, glm::dmat4> spheres;                // by node
    std::vector<Camera> cameras;                              // as in a scene
    std::vector<PunctualLight> lights;
};

void addMesh(const GltfFile& file, const PlacedNode& node, Moment& moment)
{
    const int skin = file.model.nodes[node.index].skin;
    MeshPose& pose = moment.poses[node.index];
    pose.weights = readMorphWeights(file, node.index);
    if (skin >= 0) {
        pose.worldFromBind = placeJoints(file, static_cast<std::size_t>(skin));
        return;
    }
    for (const glm::dmat4& nodeFromInstance : readInstanceTransforms(file, node.index)) {
        moment.placings[node.index].push_back(node.worldFromNode * nodeFromInstance);
    }
}

Moment readMoment(const GltfFile& file, const LoadOptions& options, const glm::dvec3& origin)
{
    Warnings unheard;
    Moment moment;
    Scene scene;
    scene.origin = origin;
    const std::vector<PlacedNode> nodes = placeNodes(file, options, unheard);
    for (const PlacedNode& node : nodes) {
        const tinygltf::Node& source = file.model.nodes[node.index];
        if (source.mesh >= 0) {
            addMesh(file, node, moment);
        }
        if (source.extras.IsObject() && source.extras.Has("sphere")) {
            moment.spheres[node.index] = node.worldFromNode;
        }
    }
    readLightsAndCameras(file, nodes, scene, unheard);
    moment.cameras = std::move(scene.cameras);
    moment.lights = std::move(scene.lights);
    return moment;
}

glm::dmat4 worldFromCamera(const Camera& camera, const glm::dvec3& origin)
{
    return {glm::dvec4(camera.right, 0.0), glm::dvec4(camera.up, 0.0), glm::dvec4(-camera.forward, 0.0),
            glm::dvec4(origin + glm::dvec3(camera.position), 1.0)};
}

bool hasInverse(const glm::dmat4& transform) { return !isFlattening({0, transform}); }

// Whether kernels can move something there: float32 has to hold the cofactors of its stretch, and its place.
bool isMovable(const glm::dmat4& transform)
{
    constexpr double kMinScale = 1e-9, kMaxScale = 1e9, kFarthest = 1e18;
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(transform))));
    return scale >= kMinScale && scale <= kMaxScale && glm::length(glm::dvec3(transform[3])) <= kFarthest;
}

std::array<glm::dvec3, 8> cornersOf(const Mesh& mesh)
{
    glm::dvec3 low(mesh.positions[mesh.indices.front()]), high(low);
    for (const std::uint32_t index : mesh.indices) {
        low = glm::min(low, mesh.positions[index]);
        high = glm::max(high, mesh.positions[index]);
    }
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z};
    }
    return corners;
}

glm::dvec3 placed(const glm::dmat4& by, const glm::dvec3& point) { return glm::dvec3(by * glm::dvec4(point, 1.0)); }

Deviation deviationOf(const std::array<glm::dvec3, 8>& corners, const glm::dmat4& frame)
{
    double extent = 0.0;
    for (const glm::dvec3& corner : corners) {
        extent = std::max(extent, glm::distance(placed(frame, corner), placed(frame, corners[0])));
    }
    return [corners, allowed = kShareOfExtent * extent](const glm::dmat4& exact, const glm::dmat4& followed) {
        double farthest = 0.0;
        for (const glm::dvec3& corner : corners) {
            farthest = std::max(farthest, glm::distance(placed(exact, corner), placed(followed, corner)));
        }
        return allowed > 0.0 ? farthest / allowed : 0.0;
    };
}

// `way`: that the camera goes. `reach`: how far it is from the scene's origin.
Deviation deviationOfCamera(double way, double reach)
{
    return [allowed = kShareOfWay * way + kFloatRounding * reach](const glm::dmat4& exact, const glm::dmat4& followed) {
        const glm::dmat4 off = exact - followed;
        const double turn = std::max({glm::length(off[0]), glm::length(off[1]), glm::length(off[2])}), shift = glm::length(off[3]);
        return std::max(turn / kTurn, shift > 0.0 ? shift / allowed : 0.0);
    };
}

class MotionReader {
public:
    MotionReader(GltfFile& file, const LoadOptions& options, std::size_t animation, double seconds, Scene& scene, Warnings& warnings)
        : file_(file),
          options_(options),
          animation_(animation),
          seconds_(seconds),
          scene_(scene),
          warnings_(warnings)
    {
        listTimes(seconds + options.shutter->open, seconds + options.shutter->close);
    }

    void readInstances();
    void readCameras();
    void noteLights();
    void noteSpheres();
    // The file is as it was.
    void finish() { at(seconds_, true); }

private:
    void listTimes(double open, double close);
    void addCorners(std::set<double>& corners, const GltfAnimation::Sampler& sampler, double open, double close) const;
    const Moment& at(double seconds, bool again = false);
    // Whether `get`, of a moment, is anything else than at the frame's time.
    template <class Get>
    bool changes(const Get& get);
    std::vector<std::size_t> listPlacings(std::size_t node);
    std::optional<glm::dmat4> placingAt(double seconds, std::size_t node, std::size_t placing);
    void readInstance(MeshInstance& instance, std::size_t placing);
    void note(const char* what, std::size_t node) { warnings_.add(MessageId::StaysSharp, what, nodeLabel(file_, node)); }

    GltfFile& file_;
    const LoadOptions& options_;
    std::size_t animation_;
    double seconds_;  // the frame's time
    Scene& scene_;
    Warnings& warnings_;
    std::vector<double> times_;   // where motions have keys at least
    std::vector<double> probes_;  // where something is looked at to see whether it moves
    std::map<double, Moment> moments_;
};

// Where values of one channel have corners, and the moment before they jump.
void MotionReader::addCorners(std::set<double>& corners, const GltfAnimation::Sampler& sampler, double open, double close) const
{
    const std::vector<double> times = readNumbers(file_, sampler.input, 1, "times of an animation");
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool jumps = sampler.interpolation == Interpolation::Step || (i > 0 && times[i] <= times[i - 1]);
        if (times[i] > open && times[i] < close) {
            corners.insert(times[i]);
        }
        if (times[i] > open && times[i] <= close && jumps) {
            corners.insert(std::nextafter(times[i], open));
        }
    }
}

void MotionReader::listTimes(double open, double close)
{
    const GltfAnimation& source = file_.animations[animation_];
    std::set<double> corners;
    for (const GltfAnimation::Channel& channel : source.channels) {
        if (!channel.pointer.empty() && channel.sampler < source.samplers.size()) {
            addCorners(corners, source.samplers[channel.sampler], open, close);
        }
    }
    if (corners.size() > kMaxMotionKeys / 2) {
        corners.clear();  // so many keys are followed as a curve
    }
    corners.insert({open, seconds_, close});
    times_.assign(corners.begin(), corners.end());
    for (std::size_t i = 0; i < times_.size(); ++i) {
        probes_.push_back(times_[i]);
        if (i + 1 < times_.size()) {
            probes_.push_back(0.5 * (times_[i] + times_[i + 1]));
        }
    }
}

const Moment& MotionReader::at(double seconds, bool again)
{
    const auto [found, isNew] = moments_.try_emplace(seconds);
    if (isNew || again) {
        Warnings unheard;
        animateGltf(file_, animation_, seconds, unheard);
        found->second = readMoment(file_, options_, scene_.origin);
    }
    return found->second;
}

template <class Get>
bool MotionReader::changes(const Get& get)
{
    const auto now = get(at(seconds_));
    return std::ranges::any_of(probes_, [&](double seconds) { return get(at(seconds)) != now; });
}

// Of those that are drawn at the frame's time, their places among all.
std::vector<std::size_t> MotionReader::listPlacings(std::size_t node)
{
    const std::vector<glm::dmat4>& all = at(seconds_).placings.at(node);
    std::vector<std::size_t> drawn;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (hasInverse(all[i])) {
            drawn.push_back(i);
        }
    }
    return drawn;
}

// Nothing where it has no inverse, or mirrors other than at the frame's time, so that it has had none before.
std::optional<glm::dmat4> MotionReader::placingAt(double seconds, std::size_t node, std::size_t placing)
{
    const auto mirrors = [](const glm::dmat4& transform) { return glm::determinant(glm::dmat3(transform)) < 0.0; };
    const std::vector<glm::dmat4>&all = at(seconds).placings.at(node), &now = at(seconds_).placings.at(node);
    const bool isUsual = placing < all.size() && hasInverse(all[placing]) && isMovable(all[placing]);
    return isUsual && mirrors(all[placing]) == mirrors(now[placing]) ? std::optional(all[placing]) : std::nullopt;
}

void MotionReader::readInstance(MeshInstance& instance, std::size_t placing)
{
    const std::size_t node = instance.node;
    const Mesh& mesh = scene_.meshes[instance.mesh];
    if (!changes([&](const Moment& moment) { return moment.placings.at(node).at(placing); })) {
        return;
    }
    if (mesh.isCloud || mesh.indices.empty()) {
        note(kMovingSpheres, node);
    } else if (scene_.materials[mesh.material].emission != glm::vec3(0.0F)) {
        note(kMovingLamps, node);
    } else if (const std::optional<Motion> motion = followMotion([&](double seconds) { return placingAt(seconds, node, placing); }, times_,
                                                                 deviationOf(cornersOf(mesh), instance.worldFromMesh))) {
        instance.motion = std::make_shared<const Motion>(*motion);
    } else {
        note("what vanishes, turns over or leaves the range of numbers while the shutter is open has no motion blur", node);
    }
}

void MotionReader::readInstances()
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> uses;  // of a mesh by a node
    std::map<std::size_t, std::vector<std::size_t>> placings;             // by node
    std::set<std::size_t> bent;
    for (MeshInstance& instance : scene_.instances) {
        const std::size_t node = instance.node, use = uses[{instance.node, instance.mesh}]++;
        if (changes([&](const Moment& moment) { return moment.poses.at(node); }) && bent.insert(node).second) {
            note("what skins and morph targets bend has no motion blur of that: it is bent as at the frame's time", node);
        }
        if (file_.model.nodes[node].skin >= 0) {
            continue;
        }
        const auto [found, isNew] = placings.try_emplace(node);
        found->second = isNew ? listPlacings(node) : found->second;
        readInstance(instance, found->second.at(use));
    }
}

void MotionReader::readCameras()
{
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
        const auto poseAt = [&](double seconds) { return worldFromCamera(at(seconds).cameras[i], scene_.origin); };
        const glm::dmat4 now = poseAt(seconds_);
        if (std::ranges::all_of(probes_, [&](double seconds) { return poseAt(seconds) == now; })) {
            continue;
        }
        double way = 0.0;
        for (const double seconds : probes_) {
            way = std::max(way, glm::length(poseAt(seconds)[3] - now[3]));
        }
        Motion motion = *followMotion(poseAt, times_, deviationOfCamera(way, glm::length(glm::dvec3(scene_.cameras[i].position)) + way));
        const glm::dquat back = glm::conjugate(splitTransform(now).rotation);
        for (MotionKey& key : motion) {
            key.rotation = key.rotation * back;
            key.stretch = glm::dmat3(1.0);
        }
        scene_.cameras[i].motion = std::make_shared<const Motion>(std::move(motion));
    }
}

void MotionReader::noteLights()
{
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const bool moves = changes([i](const Moment& moment) {
            return i < moment.lights.size() ? std::pair(moment.lights[i].position, moment.lights[i].direction)
                                            : std::pair(glm::vec3(0.0F), glm::vec3(0.0F));
        });
        if (moves) {
            const std::string& name = scene_.lights[i].name;
            warnings_.add(MessageId::StaysSharp, kMovingLamps, name.empty() ? "light " + std::to_string(i) : name);
        }
    }
}

void MotionReader::noteSpheres()
{
    for (const Sphere& sphere : scene_.spheres) {
        if (changes([&](const Moment& moment) { return moment.spheres.at(sphere.node); })) {
            note(kMovingSpheres, sphere.node);
        }
    }
}

}  // namespace

void readMotion(GltfFile& file, const LoadOptions& options, std::size_t animation, double seconds, Scene& scene, Warnings& warnings)
{
    MotionReader reader(file, options, animation, seconds, scene, warnings);
    reader.readInstances();
    reader.readCameras();
    reader.noteLights();
    reader.noteSpheres();
    reader.finish();
}

}  // namespace glim
