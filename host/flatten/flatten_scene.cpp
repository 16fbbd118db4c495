#include "host/flatten/flatten_scene.hpp"

#include "host/error.hpp"
#include "host/flatten/albedo_table.hpp"
#include "host/flatten/caustics.hpp"
#include "host/flatten/flatten_materials.hpp"
#include "host/flatten/large_triangles.hpp"
#include "host/flatten/light_table.hpp"
#include "host/flatten/pack_nodes.hpp"
#include "host/flatten/place_instances.hpp"
#include "host/flatten/start_media.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

namespace glim {
namespace {

uvec4 texel(const glm::vec3& v, std::uint32_t w)
{
    return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z), w};
}

bool hasCatcher(const Scene& scene)
{
    const std::vector<bool> used = findUsedMaterials(scene);
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] && scene.materials[i].isCatcher) {
            return true;
        }
    }
    return false;
}

bool isSliver(const Triangle& triangle)
{
    const glm::dvec3 v0 = triangle.vertices[0], v1 = triangle.vertices[1], v2 = triangle.vertices[2];
    const glm::dvec3 a = v1 - v0, b = v2 - v1, c = v0 - v2;
    const double square = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    return glm::length(glm::cross(a, c)) < static_cast<double>(kSliverHeight) * square;
}

// What primitive references say of each material.
std::vector<std::uint32_t> materialWordsOf(const Scene& scene)
{
    std::vector<std::uint32_t> words;
    const bool catches = hasCatcher(scene);
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const bool isObject = catches && !material.isCatcher && material.emission == glm::vec3(0.0F);
        words.push_back(i | (scene.showsBackFaces || meetsBackFaces(material) ? 0U : kSingleSidedBit) | (isObject ? kObjectBit : 0U));
    }
    return words;
}

// Of each primitive: the last one if it has several.
std::vector<std::uint32_t> findPrimitiveRefs(const Primitives& primitives, const WideBvh& bvh)
{
    std::vector<std::uint32_t> refOfPrimitive(primitives.count());
    for (std::uint32_t ref = 0; ref < bvh.order.size() && bvh.order[ref] < refOfPrimitive.size(); ++ref) {
        refOfPrimitive[bvh.order[ref]] = ref;
    }
    return refOfPrimitive;
}

// The references of primitives and shared meshes, and what features they need.
struct PrimitiveRefs {
    std::vector<uvec4> texels;
    FeatureMask features = 0;

    void push(const Triangle& triangle, std::uint32_t id, std::uint32_t material, bool alpha)
    {
        const bool sliver = isSliver(triangle);
        features |= sliver ? kFeatureSlivers : 0U;
        push(triangle.vertices[0], id, triangle.vertices[1], material | (sliver ? kSliverBit : 0U), alpha, triangle.vertices[2]);
    }
    void push(const PlacedSphere& sphere, std::uint32_t id, std::uint32_t material, bool alpha, const glm::vec4& color)
    {
        if (!sphere.isLine()) {
            push(sphere.center, id, {sphere.radius, color.a, 0.0F}, material | kSphereBit, alpha, glm::vec3(color));
            return;
        }
        features |= kFeatureLines;
        const auto pack = [](float low, float high) {
            const auto steps = [](float value) { return static_cast<std::uint32_t>(std::lround(0x1p15F * value)); };
            return steps(low) | steps(high) << 16U;
        };
        push(sphere.center, id, sphere.axis, material | kSphereBit | kSliverBit, alpha, glm::vec3(0.0F));
        texels.back() = {std::bit_cast<std::uint32_t>(sphere.radius), pack(color.r, color.g), pack(color.b, color.a), 0};
    }
    // Of the last reference: it emits, and lights are not sampled there.
    void markUnsampled() { texels.back().w = kUnsampledLight; }

private:
    void push(const glm::vec3& first, std::uint32_t id, const glm::vec3& second, std::uint32_t material, bool alpha, const glm::vec3& third)
    {
        features |= ((material & kSingleSidedBit) != 0 ? kFeatureSingleSided : 0U) | (alpha ? kFeatureAlpha : 0U);
        texels.push_back(texel(first, id));
        texels.push_back(texel(second, material | (alpha ? kAlphaBit : 0U)));
        texels.push_back(texel(third, 0));
    }
};

bool hasColors(const Mesh& cloud) { return cloud.isCloud && !cloud.colors.empty(); }

void pushPrimitiveRefs(PrimitiveRefs& refs, const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    const std::vector<std::uint32_t> words = materialWordsOf(scene);
    std::vector<std::uint32_t> materials;  // by triangle
    materials.reserve(primitives.triangles.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        materials.resize(primitives.firstTriangles[i + 1], words[scene.meshes[scene.instances[i].mesh].material]);
    }
    const bool colored =
        std::ranges::any_of(scene.instances, [&](const MeshInstance& instance) { return hasColors(scene.meshes[instance.mesh]); });
    refs.features |= colored ? kFeaturePointColors : 0U;
    refs.texels.reserve(bvh.order.size() * kPrimitiveRefTexels);
    for (const std::uint32_t id : bvh.order) {
        if (id >= primitives.count()) {
            break;  // shared meshes follow
        }
        const bool alpha = !primitives.hasAlpha.empty() && primitives.hasAlpha[id];
        if (id < materials.size()) {
            refs.push(primitives.triangles[id], id, materials[id], alpha);
        } else {
            const PlacedSphere sphere = primitives.spheres[id - materials.size()];
            refs.push(sphere, id, words[sphere.material], alpha, colored ? primitives.spheres.computeColor(sphere) : glm::vec4(0.0F));
            if (sphere.isLine() && scene.materials[sphere.material].emission != glm::vec3(0.0F)) {
                refs.markUnsampled();
            }
        }
    }
    for (std::size_t i = 0; i < bvh.meshTrees.size(); ++i) {
        const SharedMesh& mesh = primitives.sharedMeshes[i];
        const std::uint32_t material = words[scene.meshes[mesh.mesh].material];
        for (std::uint32_t k = 0; k < bvh.meshTrees[i].entryCount; ++k) {
            const std::uint32_t triangle = bvh.order[bvh.meshTrees[i].firstEntry + k] - mesh.firstId;
            refs.push(mesh.triangles[triangle], mesh.firstId + triangle, material, mesh.hasAlpha[triangle]);
        }
    }
}

// Returns its place, as in InstanceData.
std::uint32_t pushMotion(std::vector<uvec4>& texels, const Motion& keys, const glm::dvec3& pivot)
{
    constexpr double kLeastAngle = 1e-3;  // sines of less are the angles, to float32
    texels.push_back(texel(glm::vec3(pivot), static_cast<std::uint32_t>(keys.size())));
    const auto place = static_cast<std::uint32_t>(texels.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const MotionKey& key = keys[i];
        const double angle = i + 1 < keys.size() ? 0.5 * turnAfter(keys, i) : 0.0;
        FlatMotionKey flat{};
        flat.translation = vec3(key.translation);
        flat.time = static_cast<float>(key.time);
        flat.rotation = vec4(key.rotation.x, key.rotation.y, key.rotation.z, key.rotation.w);
        flat.stretch = vec3(key.stretch[0][0], key.stretch[1][1], key.stretch[2][2]);
        flat.shear = vec3(key.stretch[1][2], key.stretch[0][2], key.stretch[0][1]);
        flat.angle = static_cast<float>(angle);
        flat.inverseSine = angle > kLeastAngle ? static_cast<float>(1.0 / std::sin(angle)) : 0.0F;
        const auto words = std::bit_cast<std::array<uvec4, kMotionKeyTexels>>(flat);
        texels.insert(texels.end(), words.begin(), words.end());
    }
    return place;
}

// Close to each other.
std::vector<glm::dvec3> placesOnTheWay(const Motion& motion)
{
    constexpr int kPlaces = 256;
    std::vector<glm::dvec3> places;
    for (int i = 0; i <= kPlaces; ++i) {
        places.emplace_back(transformAt(motion, static_cast<double>(i) / kPlaces)[3]);
    }
    return places;
}

// Those of instances are where pushInstances says.
void pushMotions(FlatScene& flat, const Scene& scene, const Primitives& primitives)
{
    std::vector<uvec4> texels;
    for (const Placement& placement : primitives.placements) {
        if (placement.motion) {
            pushMotion(texels, placement.motion->keys, placement.motion->pivot);
        }
    }
    for (const Camera& camera : scene.cameras) {
        if (camera.motion) {
            const Motion motion = relativeTo(scene.origin, *camera.motion);
            flat.movingCameras.push_back({camera.motion, pushMotion(texels, motion, glm::dvec3(0.0)), placesOnTheWay(motion)});
        }
    }
    flat.motions = std::move(texels);
    flat.frameTime = scene.shutter ? static_cast<float>(-scene.shutter->open / (scene.shutter->close - scene.shutter->open)) : 0.0F;
}

void pushInstances(FlatScene& flat, const Primitives& primitives, const WideBvh& bvh)
{
    constexpr std::uint64_t kMax = kNoPrimitiveRef;
    std::vector<uvec4> instances;
    std::uint64_t ref = flat.firstInstanceRef, primitive = primitives.count();
    std::uint32_t motion = 1;
    for (const Placement& placement : primitives.placements) {
        const MeshTree& tree = bvh.meshTrees[placement.sharedMesh];
        const SharedMesh& mesh = primitives.sharedMeshes[placement.sharedMesh];
        InstanceData data = placeInstance(placement, tree.box);
        data.beginRef = static_cast<std::uint32_t>(ref);
        data.firstRef = data.beginRef - tree.firstEntry;
        data.firstPrimitive = static_cast<std::uint32_t>(primitive) - mesh.firstId;
        if (placement.motion) {
            data.motion = motion;
            motion += 1 + static_cast<std::uint32_t>(placement.motion->keys.size()) * kMotionKeyTexels;
        }
        ref += tree.entryCount;
        primitive += mesh.triangles.size();
        if (std::max(ref, primitive) >= kMax) {
            throw InputError(MessageId::TooLarge,
                             {"the scene's instances have ", part::value(std::to_string(primitives.computeTriangleCount())),
                              " triangles; expected ", part::expected("fewer than 4294967295"), "."});
        }
        const auto texels = std::bit_cast<std::array<uvec4, kInstanceTexels>>(data);
        instances.insert(instances.end(), texels.begin(), texels.end());
    }
    flat.instances = std::move(instances);
}

// The tree, with what its nodes say of instances.
void pushTree(FlatScene& flat, const Primitives& primitives, const WideBvh& bvh)
{
    std::vector<uvec4> nodes = packNodes(bvh);
    for (const InstanceNode& node : bvh.instances) {
        const auto rows = meshFromScene(primitives.placements[node.instance]);
        uvec4* texels = &nodes[std::size_t{node.node} * kNodeTexels];
        const uvec4* instance = &flat.instances[std::size_t{node.instance} * kInstanceTexels];
        texels[0] = std::bit_cast<uvec4>(rows[0]);
        texels[1] = {node.root, 0, 0, 0};
        texels[2] = std::bit_cast<uvec4>(rows[1]);
        texels[3] = std::bit_cast<uvec4>(rows[2]);
        texels[4] = {instance[1].w, instance[2].w, instance[4].w, 0};
    }
    flat.nodes = std::move(nodes);
}

void pushShading(FlatScene& flat, const Primitives& primitives)
{
    std::vector<uvec4> triangles, vertices;
    triangles.reserve(primitives.vertexIndices.size());
    for (const glm::uvec3& corners : primitives.vertexIndices) {
        triangles.emplace_back(corners, 0U);
    }
    for (const SharedMesh& mesh : primitives.sharedMeshes) {
        triangles.resize(mesh.vertexIndices.empty() ? triangles.size() : std::max(triangles.size(), primitives.count()));
        for (const glm::uvec3& corners : mesh.vertexIndices) {
            triangles.emplace_back(corners, 0U);
        }
    }
    for (const glm::vec3& normal : primitives.vertexNormals) {
        vertices.push_back(texel(normal, 0));
        flat.surfaceFeatures |= normal != glm::vec3(0.0F) ? kFeatureSmooth : 0U;
    }
    const auto pushSection = [&vertices](const std::vector<glm::vec4>& values, std::uint32_t& first) {
        first = values.empty() ? 0 : static_cast<std::uint32_t>(vertices.size());
        for (const glm::vec4& value : values) {
            vertices.push_back(texel(glm::vec3(value), std::bit_cast<std::uint32_t>(value.w)));
        }
    };
    pushSection(primitives.vertexUvs, flat.firstUv);
    pushSection(primitives.vertexTangents, flat.firstTangent);
    pushSection(primitives.vertexColors, flat.firstColor);
    flat.surfaceFeatures |= primitives.vertexColors.empty() ? 0U : kFeatureVertexColors;
    flat.triangles = std::move(triangles);
    flat.vertices = std::move(vertices);
}

// Which materials are drawn with vertex colours.
std::vector<bool> findColored(const Scene& scene)
{
    std::vector<bool> colored(scene.materials.size(), false);
    for (const MeshInstance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        colored[mesh.material] = colored[mesh.material] || !mesh.colors.empty();
    }
    return colored;
}

bool isSpherical(const Projection& projection) { return projection.model >= Projection::Model::Fisheye; }

// The half sides of the picture on the image plane; `own`: of the camera itself.
vec2 planeOf(const Projection& projection, const vec2& own)
{
    if (projection.model == Projection::Model::Equirectangular) {
        return {std::numbers::pi_v<float>, 0.5F * std::numbers::pi_v<float>};
    }
    return projection.intrinsics ? vec2(0.5 * projection.intrinsics->size / projection.intrinsics->focal) : own;
}

// Where the film lies on that of the whole picture: half of its sides, and its middle.
struct FilmPart {
    glm::dvec2 scale{1.0}, middle{0.0};
};

FilmPart placeFilm(const std::optional<Crop>& crop)
{
    if (!crop) {
        return {};
    }
    const glm::dvec2 whole(crop->whole), size(crop->size), middle = (2.0 * glm::dvec2(crop->corner) + size) / whole - 1.0;
    return {size / whole, {middle.x, -middle.y}};
}

// `aspectRatio`: of the whole picture.
FlatProjection flattenProjection(const Projection& projection, const FilmPart& part, const vec2& plane, float aspectRatio)
{
    constexpr std::array kModels{kShiftedFilm, kRadialTangential, kFisheye, kEquirectangular};
    if (projection == Projection()) {
        return {};
    }
    const double aspect = static_cast<double>(aspectRatio);
    const Intrinsics intrinsics = projection.intrinsics.value_or(Intrinsics{.center = glm::dvec2(0.5)});
    const glm::dvec2 center = intrinsics.center / intrinsics.size;
    const glm::dvec2 shift = 2.0 * projection.shift * (aspect > 1.0 ? glm::dvec2(1.0, aspect) : glm::dvec2(1.0 / aspect, 1.0));
    FlatProjection flat{};
    flat.model = kModels[static_cast<std::size_t>(projection.model)];
    flat.shift = vec2((shift - glm::dvec2(2.0 * center.x - 1.0, 1.0 - 2.0 * center.y) + part.middle) / part.scale);
    flat.scale = plane * vec2(part.scale);
    const auto& d = projection.distortion;
    const bool isFisheye = projection.model == Projection::Model::Fisheye;
    flat.radial = isFisheye ? vec4(d[0], d[1], d[2], d[3]) : vec4(d[0], d[1], d[4], d[5]);
    flat.radial2 = isFisheye ? vec2(0.0F) : vec2(d[6], d[7]);
    flat.tangential = isFisheye ? vec2(0.0F) : vec2(-d[2], d[3]);
    flat.end = static_cast<float>(findEnd(projection));
    return flat;
}

// The same primitives as before, if the references had marks: whether a material emits is part of what makes surfaces the same.
void markLights(FlatScene& flat, std::span<const std::uint32_t> order, std::span<const std::uint32_t> refOfPrimitive)
{
    std::vector<uvec4>& refs = flat.primitiveRefs.change();
    const auto markOf = [&refs](std::size_t ref) -> std::uint32_t& { return refs[ref * kPrimitiveRefTexels + 2].w; };
    for (const LightMark& mark : flat.lightMarks) {
        markOf(refOfPrimitive[mark.primitive]) = mark.light;
    }
    if (order.size() == refOfPrimitive.size()) {
        return;  // each primitive has one reference
    }
    for (std::size_t ref = 0; ref < order.size() && order[ref] < refOfPrimitive.size(); ++ref) {
        markOf(ref) = markOf(refOfPrimitive[order[ref]]);
    }
}

// A multiple of four, so that scenes of about the same size share compiled kernels.
std::uint32_t stackLevelsOf(const WideBvh& bvh) { return std::max((bvh.depth + 1) / 4 * 4, 4U); }

static_assert(kMaxStackLevels % 4 == 0);

// What depends on shapes alone.
void pushSurfaces(FlatScene& flat, const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    pushShading(flat, primitives);
    PrimitiveRefs refs;
    pushPrimitiveRefs(refs, scene, primitives, bvh);
    flat.primitiveRefs = std::move(refs.texels);
    flat.surfaceFeatures |=
        refs.features | (primitives.spheres.empty() ? 0U : kFeatureSpheres) | (primitives.placements.empty() ? 0U : kFeatureInstances) |
        (std::ranges::any_of(primitives.placements, [](const Placement& placement) { return placement.motion.has_value(); })
             ? kFeatureMotion
             : 0U);
}

void keepSurfaces(FlatScene& flat, const FlatScene& previous)
{
    flat.triangles = previous.triangles;
    flat.vertices = previous.vertices;
    flat.firstUv = previous.firstUv;
    flat.firstTangent = previous.firstTangent;
    flat.firstColor = previous.firstColor;
    flat.primitiveRefs = previous.primitiveRefs;
    flat.surfaceFeatures = previous.surfaceFeatures;
    flat.triangleCount = previous.triangleCount;
    flat.firstInstanceRef = previous.firstInstanceRef;
    flat.surfacesPrint = previous.surfacesPrint;
}

// Where they are: the tree, instances, and how large they are beside each other.
void placeSurfaces(FlatScene& flat, const Primitives& primitives, const WideBvh& bvh)
{
    pushInstances(flat, primitives, bvh);
    pushTree(flat, primitives, bvh);
    flat.surfaceFeatures &= ~kFeatureLargeTriangles;
    findLargeTriangles(flat, primitives);
}

void keepPlaces(FlatScene& flat, const FlatScene& previous)
{
    flat.instances = previous.instances;
    flat.nodes = previous.nodes;
    flat.largest = previous.largest;
}

void addTables(FlatScene& flat)
{
    if ((flat.features & kFeaturePrincipled) != 0) {
        static const std::vector<uvec4> albedos = makeAlbedoTable();  // .4 s of CPU time
        flat.albedos = albedos;
    }
    if ((flat.features & kFeatureSheen) != 0) {
        static const std::vector<uvec4> sheen = makeSheenTable();
        flat.albedos.insert(flat.albedos.end(), sheen.begin(), sheen.end());
    }
    if ((flat.features & kFeatureAnisotropy) != 0) {
        static const std::vector<uvec4> anisotropic = makeAnisotropicAlbedoTable();  // .1 s of CPU time
        flat.albedos.resize(kFirstAnisotropicAlbedo);
        flat.albedos.insert(flat.albedos.end(), anisotropic.begin(), anisotropic.end());
    }
    if ((flat.features & kFeatureRoughTransmission) != 0) {
        static const std::vector<uvec4> glass = makeGlassAlbedoTable();  // .3 s of CPU time
        flat.albedos.resize(kFirstGlassAlbedo);
        flat.albedos.insert(flat.albedos.end(), glass.begin(), glass.end());
    }
}

void placeLights(FlatScene& flat, const Scene& scene, const Primitives& primitives, const WideBvh& bvh, std::span<const LightMark> before)
{
    const bool mayEmit =
        std::ranges::any_of(scene.materials, [](const Material& material) { return material.emission != glm::vec3(0.0F); });
    const std::vector<std::uint32_t> refOfPrimitive = mayEmit ? findPrimitiveRefs(primitives, bvh) : std::vector<std::uint32_t>();
    addLights(flat, scene, primitives, refOfPrimitive);
    if (!std::ranges::equal(flat.lightMarks, before)) {
        markLights(flat, bvh.order, refOfPrimitive);
        flat.surfacesPrint = std::make_shared<std::optional<std::uint64_t>>();
    }
}

// Calls `nodesAreDone` when the tree's nodes are not needed any more.
template <class Done>
FlatScene flatten(const Scene& scene, const Primitives& primitives, const WideBvh& bvh, const FlatScene& previous, Same same,
                  Done nodesAreDone)
{
    FlatScene flat;
    flat.images = previous.images;
    flat.emissionMeans = previous.emissionMeans;
    if (scene.environment && scene.environment->radiance != glm::vec3(0.0F) && scene.environment->map == previous.environmentMap->source) {
        flat.environmentMap = previous.environmentMap;
    }
    flat.stackLevels = stackLevelsOf(bvh);
    flat.triangleCount = static_cast<std::uint32_t>(primitives.triangles.size());
    flat.firstInstanceRef = static_cast<std::uint32_t>(bvh.order.size());
    if (same != Same::Nothing) {
        keepSurfaces(flat, previous);
    }
    if (same == Same::Everything) {
        keepPlaces(flat, previous);
    } else {
        placeSurfaces(flat, primitives, bvh);
    }
    pushMotions(flat, scene, primitives);
    nodesAreDone();
    if (same == Same::Nothing) {
        pushSurfaces(flat, scene, primitives, bvh);
    }
    flat.features = flat.surfaceFeatures | (hasCatcher(scene) ? kFeatureCatcher : 0U) |
                    (scene.lightGroups.empty() ? 0U : kFeatureLightGroups) | (areLightsClose(flat, scene) ? kFeatureLargeTriangles : 0U);
    flattenMaterials(flat, scene, findColored(scene));
    for (const MeshInstance& instance : scene.instances) {
        flat.features |= flat.materialFeatures[scene.meshes[instance.mesh].material];
    }
    for (const Sphere& sphere : scene.spheres) {
        flat.features |= flat.materialFeatures[sphere.material];
    }
    addTables(flat);
    placeLights(flat, scene, primitives, bvh, same == Same::Nothing ? std::span<const LightMark>() : previous.lightMarks);
    addCaustics(flat, scene, primitives);
    flat.features |= mayLightsBeInMedia(flat) ? kFeatureLightsInMedia : 0U;
    return flat;
}

}  // namespace

FlatScene flattenScene(const Scene& scene, const Primitives& primitives, const WideBvh& bvh, const FlatScene& previous, Same same)
{
    return flatten(scene, primitives, bvh, previous, same, [] {});
}

FlatScene flattenScene(const Scene& scene, const Primitives& primitives, WideBvh&& bvh)
{
    return flatten(scene, primitives, bvh, {}, Same::Nothing, [&bvh] { bvh.nodes = std::vector<WideNode>(); });
}

FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens)
{
    const bool perspective = camera.kind == Camera::Kind::Perspective;
    const float halfHeight = perspective ? std::tan(0.5F * camera.yfov) : camera.halfHeight;
    const std::optional<Crop>& crop = camera.projection.crop;
    const float aspect = crop ? static_cast<float>(crop->whole.x) / static_cast<float>(crop->whole.y) : aspectRatio;
    const float halfWidth = perspective ? halfHeight * aspect : std::copysign(halfHeight * aspect, camera.halfWidth);
    const vec2 plane = planeOf(camera.projection, vec2(halfWidth, halfHeight));
    const FilmPart part = placeFilm(crop);
    const vec2 axes = isSpherical(camera.projection) ? vec2(1.0F) : plane * vec2(part.scale);
    return {camera.position,
            camera.right * axes.x,
            camera.up * axes.y,
            camera.forward,
            perspective || isSpherical(camera.projection) ? kPerspective : kOrthographic,
            camera.right * lens.radius,
            camera.up * lens.radius,
            1.0F / lens.focalDistance,
            0,
            flattenProjection(camera.projection, part, plane, aspect),
            0};
}

FlatCamera setInMotion(FlatCamera flat, const Camera& camera, const FlatScene& scene)
{
    const auto moving = std::ranges::find(scene.movingCameras, camera.motion, &MovingCamera::motion);
    flat.motion = moving != scene.movingCameras.end() ? moving->flat : 0;
    return flat;
}

}  // namespace glim
