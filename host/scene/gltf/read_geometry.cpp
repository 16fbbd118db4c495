#include "host/scene/gltf/read_geometry.hpp"

#include "host/scene/choose_origin.hpp"
#include "host/scene/gltf/read_material.hpp"
#include "host/scene/make_tangents.hpp"
#include "host/scene/placed_mesh.hpp"
#include "host/scene/point_spacing.hpp"
#include "host/scene/share_meshes.hpp"
#include "host/scene/uniform_scale.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace glim {
namespace {

// The box's centre is rounded to 2^-8 of the extent, so that subtracting it is exact even where the centre
// itself needs all 53 bits.
constexpr int kOriginBits = 8;

// So many triangles, or points, are looked at, and at least one of each instance, to place the origin.
constexpr std::size_t kMaxPlaces = std::size_t{1} << 16U;

struct WorldSphere {
    Sphere sphere;  // without its centre
    glm::dvec3 center;
};

struct Box {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    void extend(const glm::dvec3& point)
    {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
};

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void checkPoint(const GltfFile& file, std::size_t node, const glm::dvec3& point)
{
    if (!isFinite(point)) {
        refuse(file, MessageId::OutOfRange,
               {part::place(nodeLabel(file, node)), " places a point at ",
                part::value(toText(point.x) + " " + toText(point.y) + " " + toText(point.z)), "; expected ",
                part::expected("finite coordinates")});
    }
}

double chooseExtent(const Box& box) { return std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}); }

glm::dvec3 roundedCenter(const Box& box)
{
    const glm::dvec3 center = 0.5 * box.min + 0.5 * box.max;
    const double extent = chooseExtent(box);
    if (!std::isfinite(extent) || extent == 0.0) {
        return center;
    }
    const double grid = std::ldexp(1.0, std::ilogb(extent) - kOriginBits);
    return glm::dvec3(std::round(center.x / grid), std::round(center.y / grid), std::round(center.z / grid)) * grid +
           0.0;  // no negative zero
}

WorldSphere readSphere(const GltfFile& file, const PlacedNode& node, std::uint32_t defaultMaterial)
{
    const tinygltf::Value& source = file.model.nodes[node.index].extras.Get("sphere");
    const glm::dmat3 linear = readLinear(file, node);
    const double scale = computeUniformScale(linear);
    if (scale == 0.0) {
        refuse(file, MessageId::Unsupported,
               {part::place(nodeLabel(file, node.index)), " scales its sphere by ",
                part::value(toText(glm::length(linear[0])) + " " + toText(glm::length(linear[1])) + " " + toText(glm::length(linear[2]))),
                " or shears it; expected ", part::expected("a uniform scale")});
    }
    WorldSphere world;
    world.sphere.node = static_cast<std::uint32_t>(node.index);
    world.center = glm::dvec3(node.worldFromNode[3]);
    world.sphere.name = file.model.nodes[node.index].name;
    world.sphere.radius = static_cast<float>(scale * source.Get("radius").GetNumberAsDouble());
    world.sphere.material = source.Has("material") ? static_cast<std::uint32_t>(source.Get("material").GetNumberAsInt()) : defaultMaterial;
    if (!std::isfinite(world.sphere.radius)) {
        refuse(file, MessageId::OutOfRange,
               {part::place(nodeLabel(file, node.index)), " has a sphere of infinite radius; expected ",
                part::expected("one that fits a float")});
    }
    return world;
}

// What a cloud without a radius of its own has: points half of the distance to their neighbours, lines a small share of their cloud's size.
double guessRadius(const Mesh& cloud)
{
    constexpr double kShareOfLines = 1.0 / 500.0;
    if (cloud.lines.empty()) {
        return 0.5 * computePointSpacing(cloud.positions);
    }
    Box box;
    for (const glm::dvec3& position : cloud.positions) {
        box.extend(position);
    }
    return kShareOfLines * glm::distance(box.min, box.max);
}

// The texture coordinates that the material's tangents follow, if it needs any.
std::optional<std::uint32_t> uvSetOfTangents(const Material& material)
{
    for (const TextureSlot& slot : kTextureSlots) {
        if (slot.holds == TexelKind::Direction && material.textures[slot.number]) {
            return material.textures[slot.number]->uvSet;
        }
    }
    return material.anisotropy > 0.0F ? std::optional<std::uint32_t>(0) : std::nullopt;
}

std::vector<ReadMeshes::Needs> listNeeds(const GltfFile& file)
{
    std::vector<ReadMeshes::Needs> needs;
    Warnings unheard;
    const auto add = [&](int index) {
        const Material material = readMaterial(file, index, unheard);
        needs.push_back({material.uvSets, uvSetOfTangents(material)});
    };
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) {
        add(static_cast<int>(i));
    }
    add(-1);
    return needs;
}

// A mesh that is drawn with a normal map and has no tangents gets them, by the texture coordinates of that map. Flat meshes have those of
// their faces, whatever the file says.
void giveTangents(Mesh& mesh, std::uint32_t uvSet, Warnings& warnings)
{
    if (!mesh.tangents.empty() && !mesh.normals.empty()) {
        return;
    }
    mesh.tangents.clear();
    if ((uvSet == 0 ? mesh.uv0 : mesh.uv1).empty()) {
        warnings.add(MessageId::NoTextureCoordinates, "normal maps and anisotropy without texture coordinates are ignored", mesh.name);
    } else if (addTangents(mesh, uvSet == 1) > 0) {
        warnings.add(MessageId::FlatTextureCoordinates, "texture coordinates of normal maps have no area in some triangles", mesh.name);
    }
}

class GeometryReader {
public:
    GeometryReader(const GltfFile& file, Scene& scene, ReadMeshes& read, Warnings& warnings)
        : file_(file),
          scene_(scene),
          read_(read),
          warnings_(warnings),
          defaultMaterial_(static_cast<std::uint32_t>(file.model.materials.size()))
    {}

    void addNode(const PlacedNode& node);
    void finish();

private:
    void addSphere(const PlacedNode& node);
    void leaveOut(const PlacedNode& node);
    void addInstances(const PlacedNode& node, std::size_t mesh);
    void addInstance(const PlacedNode& placed, std::size_t mesh);
    std::size_t useOf(std::size_t node, std::size_t mesh);
    void readUses();
    void placeUses();
    void countShapes();
    static std::array<glm::dvec3, 8> cornersOf(const Mesh& mesh);
    // The vertices of the instance's mesh, or its points; of a scene with very many triangles the corners of a box around them.
    template <class Visit>
    void forEachPoint(const MeshInstance& instance, const Visit& visit) const;
    Box computeBox() const;
    void growByPoints(Box& box) const;
    void chooseLonePointRadius(const Box& box);
    void checkExtent(const Box& box) const;
    std::vector<Place> placesOf() const;
    void addPlaces(const MeshInstance& instance, std::size_t step, std::vector<Place>& places) const;
    void placeOrigin(const Box& box);

    const GltfFile& file_;
    Scene& scene_;
    ReadMeshes& read_;
    Warnings& warnings_;
    std::uint32_t defaultMaterial_;
    // By mesh of the file, skin and weights of morph targets: nodes that agree in these share meshes.
    std::map<std::tuple<std::size_t, int, std::vector<double>>, std::size_t> indices_;
    std::vector<ReadMeshes::Use> uses_;
    std::vector<std::pair<PlacedNode, std::size_t>> placed_;  // each with its use
    std::vector<WorldSphere> spheres_;
    std::size_t triangles_ = 0, points_ = 0, emptySpheres_ = 0;
};

void GeometryReader::addNode(const PlacedNode& node)
{
    const tinygltf::Node& source = file_.model.nodes[node.index];
    if (source.mesh >= 0) {
        addInstances(node, static_cast<std::size_t>(source.mesh));
    }
    if (source.extras.IsObject() && source.extras.Has("sphere")) {
        addSphere(node);
    }
}

void GeometryReader::addSphere(const PlacedNode& node)
{
    if (isFlattening(node)) {
        leaveOut(node);
        return;
    }
    WorldSphere sphere = readSphere(file_, node, defaultMaterial_);
    if (sphere.sphere.radius > 0.0F) {
        spheres_.push_back(std::move(sphere));
    } else {
        ++emptySpheres_;
    }
}

void GeometryReader::leaveOut(const PlacedNode& node)
{
    ++scene_.flattened;
    warnings_.add(MessageId::FlattenedNode, "meshes and spheres that are scaled to a plane, a line or a point are left out",
                  nodeLabel(file_, node.index));
}

std::size_t GeometryReader::useOf(std::size_t node, std::size_t mesh)
{
    const int skin = file_.model.nodes[node].skin;
    MeshPose pose;
    pose.weights = readMorphWeights(file_, node);
    const auto [found, isNew] = indices_.try_emplace({mesh, skin, pose.weights}, uses_.size());
    if (isNew) {
        if (skin >= 0) {
            pose.skin = static_cast<std::size_t>(skin);
            pose.worldFromBind = placeJoints(file_, *pose.skin);
        }
        uses_.push_back({mesh, std::move(pose)});
    }
    return found->second;
}

void GeometryReader::readUses()
{
    std::vector<ReadMeshes::Needs> needs = listNeeds(file_);
    const std::array hasRadii{scene_.pointRadius.has_value(), scene_.lineRadius.has_value()};
    if (uses_ == read_.uses && needs == read_.needs && file_.variant == read_.variant && hasRadii == read_.hasRadii) {
        return;
    }
    read_ = {};
    std::vector<Mesh> meshes;
    for (const ReadMeshes::Use& use : uses_) {
        std::vector<std::uint32_t>& ids = read_.meshesOf.emplace_back();
        for (Mesh& mesh : readMeshes(file_, use.mesh, use.pose, read_.warnings)) {
            if (mesh.isCloud) {
                const bool isGiven = hasRadii[mesh.lines.empty() ? 0 : 1];
                mesh.pointRadius = isGiven || mesh.pointRadius > 0.0 ? mesh.pointRadius : guessRadius(mesh);
            } else if (const std::optional<std::uint32_t> uvSet = needs[mesh.material].uvSetOfTangents) {
                giveTangents(mesh, *uvSet, read_.warnings);
            }
            ids.push_back(static_cast<std::uint32_t>(meshes.size()));
            meshes.push_back(std::move(mesh));
        }
    }
    read_.meshes = std::move(meshes);
    read_.needs = std::move(needs);
    read_.variant = file_.variant;
    read_.hasRadii = hasRadii;
    read_.uses = std::move(uses_);
}

void GeometryReader::placeUses()
{
    scene_.meshes = read_.meshes;
    warnings_.add(read_.warnings);
    for (const auto& [placed, use] : placed_) {
        const std::string& name = file_.model.nodes[placed.index].name;
        for (const std::uint32_t id : read_.meshesOf[use]) {
            scene_.instances.push_back(
                {name.empty() ? scene_.meshes[id].name : name, id, placed.worldFromNode, static_cast<std::uint32_t>(placed.index)});
        }
    }
}

// glTF 2.0, section 3.7.3.3: a skinned mesh does not follow its node, only the skin's joints.
void GeometryReader::addInstances(const PlacedNode& node, std::size_t mesh)
{
    const tinygltf::Node& source = file_.model.nodes[node.index];
    if (source.skin >= 0) {
        addInstance({node.index, glm::dmat4(1.0)}, mesh);
        return;
    }
    for (const glm::dmat4& nodeFromInstance : readInstanceTransforms(file_, node.index)) {
        const PlacedNode instance{node.index, node.worldFromNode * nodeFromInstance};
        if (isFlattening(instance)) {
            leaveOut(instance);
            continue;
        }
        readLinear(file_, instance);  // refuses one that is not finite
        addInstance(instance, mesh);
    }
}

void GeometryReader::addInstance(const PlacedNode& placed, std::size_t mesh) { placed_.emplace_back(placed, useOf(placed.index, mesh)); }

void GeometryReader::countShapes()
{
    for (const MeshInstance& instance : scene_.instances) {
        const Mesh& mesh = scene_.meshes[instance.mesh];
        triangles_ += mesh.indices.size() / 3;
        points_ += mesh.isCloud ? std::max(mesh.positions.size(), mesh.lines.size()) : 0;
    }
    if (triangles_ + points_ > std::numeric_limits<std::uint32_t>::max()) {
        refuse(file_, MessageId::TooLarge,
               {"the scene has ", part::value(std::to_string(triangles_ + points_)), " triangles, points and lines; expected ",
                part::expected("at most 4294967295")});
    }
    if (triangles_ > kMaxFlatTriangles && read_.corners.empty()) {
        for (const Mesh& mesh : scene_.meshes) {
            read_.corners.push_back(cornersOf(mesh));
        }
    }
}

std::array<glm::dvec3, 8> GeometryReader::cornersOf(const Mesh& mesh)
{
    Box box;
    for (const std::uint32_t index : mesh.indices) {
        box.extend(mesh.positions[index]);
    }
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = {(i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y, (i & 4U) != 0 ? box.max.z : box.min.z};
    }
    return corners;
}

template <class Visit>
void GeometryReader::forEachPoint(const MeshInstance& instance, const Visit& visit) const
{
    const Mesh& mesh = scene_.meshes[instance.mesh];
    for (std::size_t i = 0; mesh.isCloud && i < mesh.positions.size(); ++i) {
        visit(mesh.positions[i]);
    }
    if (mesh.indices.empty()) {
        return;
    }
    if (triangles_ > kMaxFlatTriangles) {
        for (const glm::dvec3& corner : read_.corners[instance.mesh]) {
            visit(corner);
        }
        return;
    }
    for (const std::uint32_t index : mesh.indices) {
        visit(mesh.positions[index]);
    }
}

Box GeometryReader::computeBox() const
{
    Box box;
    for (const MeshInstance& instance : scene_.instances) {
        const glm::dmat3 linear(instance.worldFromMesh);
        const glm::dvec3 translation(instance.worldFromMesh[3]);
        forEachPoint(instance, [&](const glm::dvec3& point) {
            const glm::dvec3 world = linear * point + translation;
            checkPoint(file_, instance.node, world);
            box.extend(world);
        });
    }
    for (const WorldSphere& sphere : spheres_) {
        checkPoint(file_, sphere.sphere.node, sphere.center);
        box.extend(sphere.center - static_cast<double>(sphere.sphere.radius));
        box.extend(sphere.center + static_cast<double>(sphere.sphere.radius));
    }
    return box;
}

// By the radii of points: the box holds their centres.
void GeometryReader::growByPoints(Box& box) const
{
    double radius = 0.0;
    for (const MeshInstance& instance : scene_.instances) {
        if (scene_.meshes[instance.mesh].isCloud) {
            radius = std::max(radius, static_cast<double>(computePointRadius(scene_, instance)));
        }
    }
    box = {box.min - radius, box.max + radius};
}

// 1 % of the scene, or 1 cm where that has no size.
void GeometryReader::chooseLonePointRadius(const Box& box)
{
    constexpr double kShare = 0.01;
    const bool isAsked = std::ranges::any_of(scene_.meshes, [](const Mesh& mesh) { return mesh.isCloud && mesh.pointRadius == 0.0; });
    if (isAsked) {
        const double extent = chooseExtent(box);
        scene_.lonePointRadius = kShare * (extent > 0.0 ? extent : 1.0);
    }
}

// Areas and volumes of what is drawn have to fit float32. What is too small may be one moment of an animation, whose picture is empty
// rightly.
void GeometryReader::checkExtent(const Box& box) const
{
    constexpr double kMin = 1e-12, kMax = 1e18;
    const double extent = chooseExtent(box);
    if (extent > kMax) {
        refuse(file_, MessageId::TooLarge,
               {"the scene is ", part::value(toText(extent)), " m large; expected ", part::expected("at most " + toText(kMax) + " m")});
    }
    if (extent > 0.0 && extent < kMin) {
        warnings_.add(
            {MessageId::TinyScene,
             {"the scene is ", part::value(toText(extent)), " m large: below ", toText(kMin), " m its picture may lack what is there"}});
    }
}

// Every step-th triangle or point.
void GeometryReader::addPlaces(const MeshInstance& instance, std::size_t step, std::vector<Place>& places) const
{
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const glm::dmat3 linear(instance.worldFromMesh);
    const glm::dvec3 translation(instance.worldFromMesh[3]);
    const double diameter = mesh.isCloud ? 2.0 * static_cast<double>(computePointRadius(scene_, instance)) : 0.0;
    for (std::size_t i = 0; diameter > 0.0 && i < mesh.positions.size(); i += step) {
        places.push_back({linear * mesh.positions[i] + translation, diameter,
                          static_cast<double>(std::min(step, mesh.positions.size() - i)), instance.node});
    }
    const std::size_t count = mesh.indices.size() / 3;
    for (std::size_t i = 0; i < count; i += step) {
        Box box;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            box.extend(linear * mesh.positions[mesh.indices[3 * i + corner]] + translation);
        }
        if (const double size = chooseExtent(box); size > 0.0) {
            places.push_back({0.5 * box.min + 0.5 * box.max, size, static_cast<double>(std::min(step, count - i)), instance.node});
        }
    }
}

std::vector<Place> GeometryReader::placesOf() const
{
    std::vector<Place> places;
    const std::size_t step = std::max<std::size_t>(1, (triangles_ + points_) / kMaxPlaces);
    for (const MeshInstance& instance : scene_.instances) {
        addPlaces(instance, step, places);
    }
    for (const WorldSphere& sphere : spheres_) {
        places.push_back({sphere.center, 2.0 * static_cast<double>(sphere.sphere.radius), 1.0, sphere.sphere.node});
    }
    return places;
}

void GeometryReader::placeOrigin(const Box& box)
{
    const std::vector<Place> places = placesOf();
    scene_.origin = places.empty() ? roundedCenter(box) : chooseOrigin(places, roundedCenter(box));
    for (const CoarsePart& part : findCoarseParts(places, scene_.origin)) {
        warnings_.add(MessageId::FarPart, "far from most of the scene, float32 rounds positions by more than small parts allow",
                      nodeLabel(file_, part.part) + " (steps of " + toText(part.spacing) + " m, parts of " + toText(part.size) + " m)");
    }
}

void GeometryReader::finish()
{
    readUses();
    placeUses();
    countShapes();
    if (triangles_ + points_ + spheres_.size() > 0) {
        Box box = computeBox();
        chooseLonePointRadius(box);
        growByPoints(box);
        checkExtent(box);
        placeOrigin(box);
    }
    for (WorldSphere& sphere : spheres_) {
        sphere.sphere.center = sphere.center - scene_.origin;
        scene_.spheres.push_back(sphere.sphere);
    }
    if (emptySpheres_ > 0) {
        warnings_.add({MessageId::EmptySphere, {"left out ", part::value(counted(emptySpheres_, "sphere")), " of zero radius"}});
    }
}

bool isFlat(const PlacedMesh& mesh)
{
    for (std::size_t i = 0; i < mesh.triangleCount(); ++i) {
        if (faceNormal(mesh.triangle(i)) != glm::dvec3(0.0)) {
            return false;
        }
    }
    return true;
}

}  // namespace

void readGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, ReadMeshes& read, Warnings& warnings)
{
    checkSize(file, nodes);
    GeometryReader reader(file, scene, read, warnings);
    for (const PlacedNode& node : nodes) {
        if (node.visible) {
            reader.addNode(node);
        }
    }
    reader.finish();
}

void requireShapes(const GltfFile& file, const Scene& scene)
{
    if (!scene.spheres.empty() || scene.flattened > 0) {
        return;
    }
    std::size_t triangles = 0;
    std::vector<bool> flatMeshes(scene.meshes.size(), false);  // in themselves, not only where they stand far away
    for (const MeshInstance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        triangles += mesh.indices.size() / 3;
        if (mesh.isCloud) {
            return;
        }
        if (flatMeshes[instance.mesh]) {
            continue;
        }
        if (!isFlat(PlacedMesh(scene, instance))) {
            return;
        }
        flatMeshes[instance.mesh] = isFlat(PlacedMesh(mesh, Placing(glm::dmat3(1.0), glm::dvec3(0.0))));
    }
    const std::string flat = counted(triangles, "triangle");
    const MessagePart found =
        triangles == 0 ? MessagePart("") : MessagePart(MessagePart::Kind::Value, " (" + flat + " of zero area)", flat);
    refuse(file, MessageId::Empty,
           {"the scene has no triangle, point, line or sphere to draw", found, "; expected ", part::expected("at least one")});
}

}  // namespace glim
