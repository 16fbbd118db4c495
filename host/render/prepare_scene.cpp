#include "host/render/prepare_scene.hpp"

#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_materials.hpp"
#include "host/flatten/start_media.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"
#include "host/scene/warnings.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <new>
#include <set>

namespace glim {
namespace {

void sayTextureMemory(const FlatScene& flat)
{
    constexpr std::uint64_t kWorthSaying = std::uint64_t{64} << 20U;
    const std::uint64_t all = textureBytes(flat), images = imageBytes(flat);
    if (all > kWorthSaying) {
        say(MessageId::TextureMemory,
            {"textures take ", part::value(std::to_string(images >> 20U) + " MiB"), " on the device and the environment ",
             std::to_string((all - images) >> 20U), " MiB", images > kWorthSaying ? "; --max-texture N scales textures down" : ""});
    }
}

void sayWarnings(const Scene& scene, const Scene& previous)
{
    constexpr std::size_t kMaxLines = 20;
    std::set<std::string> known;
    std::ranges::transform(previous.warnings, std::inserter(known, known.end()), &Message::sentence);
    std::size_t count = 0;
    for (const Message& warning : scene.warnings) {
        if (known.count(warning.sentence) == 0 && ++count <= kMaxLines) {
            say(Severity::Warning, warning);
        }
    }
    if (count > kMaxLines) {
        warn(MessageId::MoreWarnings, {"and ", counted(count - kMaxLines, "more warning")});
    }
}

void addVolumeWarnings(Scene& scene)
{
    Warnings warnings;
    const std::vector<bool> used = findUsedMaterials(scene);
    for (std::size_t i = 0; i < scene.materials.size() && !scene.lights.empty(); ++i) {
        if (used[i] && scattersBehindSmoothBoundary(scene.materials[i])) {
            warnings.add(
                MessageId::UnreachedVolume,
                "point, spot and directional lights do not reach what scatters behind a smooth boundary, which a roughness of 0.05 opens",
                "materials[" + std::to_string(i) + "] (" + inQuotes(scene.materials[i].name) + ")");
        }
    }
    std::ranges::move(warnings.messages(), std::back_inserter(scene.warnings));
}

using Stage = std::function<void(const std::string&)>;

// Loads and prepares the scene of `file`. A lack of memory becomes an InputError.
PreparedScene within(const std::filesystem::path& file, const std::function<PreparedScene()>& prepare)
{
    const MemoryGuard guard(file);
    try {
        return prepare();
    } catch (const std::bad_alloc&) {
        throw InputError(MessageId::OutOfMemory, {part::file(file), ": ", memorySentence()});
    }
}

// `start`: when loading began.
PreparedScene prepare(Scene scene, SplitRule split, Clock::time_point start, PreparedScene previous, const Stage& stage, SceneUse use)
{
    PreparedScene prepared;
    prepared.scene = std::move(scene);
    const bool first = previous.bvh.nodes.empty();
    const Same same = first ? Same::Nothing : compareSurfaces(previous.scene, previous.primitives, prepared.scene);
    if (same == Same::Nothing) {
        prepared.primitives = makePrimitives(prepared.scene);
    } else {
        prepared.primitives = std::move(previous.primitives);
        placeSharedMeshes(prepared.scene, prepared.primitives);
    }
    prepared.scene.warnings.insert(prepared.scene.warnings.end(), prepared.primitives.warnings.begin(), prepared.primitives.warnings.end());
    addVolumeWarnings(prepared.scene);
    sayWarnings(prepared.scene, previous.scene);
    const Clock::time_point loaded = Clock::now();
    if (first) {
        stage("building the BVH of " + std::to_string(prepared.primitives.count()) + " primitives");
    }
    prepared.bvh = first                      ? buildSceneBvh(prepared.primitives, split)
                   : same == Same::Everything ? std::move(previous.bvh)
                   : same == Same::AllButPlacements
                       ? moveInstances(std::move(previous.bvh), prepared.primitives, split)
                       : updateSceneBvh(std::move(previous.bvh), previous.primitives, prepared.primitives, split);
    prepared.split = split;
    prepared.flat = use == SceneUse::Once ? flattenScene(prepared.scene, prepared.primitives, std::move(prepared.bvh))
                                          : flattenScene(prepared.scene, prepared.primitives, prepared.bvh, previous.flat, same);
    if (first) {
        sayTextureMemory(prepared.flat);
    }
    for (TextureImage& image : prepared.scene.images) {
        image.pixels = nullptr;  // the flat scene has them
    }
    prepared.loadSeconds = secondsBetween(start, loaded);
    prepared.buildSeconds = secondsBetween(loaded, Clock::now());
    return prepared;
}

}  // namespace

PreparedScene prepareScene(const std::filesystem::path& file, const LoadOptions& options, SplitRule split, const Stage& stage)
{
    const Clock::time_point start = Clock::now();
    stage("loading " + file.filename().string());
    return within(file, [&] { return prepare(loadGltf(file, options), split, start, {}, stage, SceneUse::Again); });
}

void updateScene(PreparedScene& prepared, SceneFile& file, std::optional<double> seconds, SplitRule split, const Stage& stage, SceneUse use)
{
    const Clock::time_point start = Clock::now();
    stage("loading " + file.path().filename().string());
    prepared = within(file.path(), [&] {
        Scene scene = file.sceneAt(seconds);
        if (use == SceneUse::Once) {
            file.release();
        }
        return prepare(std::move(scene), split, start, std::move(prepared), stage, use);
    });
}

void changeScene(PreparedScene& prepared, SceneFile& file, const LoadOptions& options, SplitRule split)
{
    const LoadOptions before = file.options();
    file.choose(options);
    try {
        updateScene(prepared, file, options.at, split);
    } catch (const InputError&) {
        file.choose(before);
        if (prepared.bvh.nodes.empty()) {  // there was too little memory
            updateScene(prepared, file, before.at, split);
        }
        throw;
    }
}

void sayIfCameraIsNumber(const Scene& scene, const std::optional<std::string>& choice)
{
    if (!choice || choice->empty() || choice->find_first_not_of("0123456789") != std::string::npos) {
        return;
    }
    const Camera& camera = findCamera(scene, choice);
    const std::string index = std::to_string(&camera - scene.cameras.data());
    const bool named = std::ranges::any_of(scene.cameras, [&](const Camera& other) { return &other != &camera && other.name == *choice; });
    const std::string name = camera.name.empty() ? "" : ": the camera is " + inQuotes(camera.name);
    say(MessageId::CameraChosen, {part::place("--camera"), " ", part::value(*choice),
                                  index == *choice ? " is an index" + name + (named ? ", not the one named " + inQuotes(*choice) : "")
                                                   : " is a name: the camera has the index " + index});
}

void warnIfNoLights(const PreparedScene& prepared)
{
    if (prepared.flat.lights.empty()) {
        warn(MessageId::NoLight, {"the scene has no light, so every picture of it is black; --environment 1,1,1 lights it"});
    }
}

const Camera& findCamera(const Scene& scene, const std::optional<std::string>& choice)
{
    if (!choice) {
        return scene.cameras.front();
    }
    std::string list;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (std::to_string(i) == *choice) {
            return scene.cameras[i];
        }
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (scene.cameras[i].name == *choice) {
            return scene.cameras[i];
        }
        if (i < kMaxListed) {
            list += (i == 0 ? "" : ", ") + std::to_string(i) + " " + inQuotes(scene.cameras[i].name);
        }
    }
    list += moreThanListed(scene.cameras.size());
    throw InputError(MessageId::UnknownName, {part::file(scene.file), ": ", part::place("camera"), " ", part::quoted(*choice),
                                              ": expected one of ", part::expected(list), "."});
}

FlatCamera flattenCamera(const PreparedScene& prepared, const Camera& camera, float aspectRatio, const Lens& lens)
{
    return placeInMedia(setInMotion(flattenCamera(camera, aspectRatio, lens), camera, prepared.flat), prepared.flat);
}

glm::uvec2 defaultSize(const Camera& camera)
{
    constexpr std::uint32_t kHeight = 512;
    if (camera.projection.model == Projection::Model::Equirectangular) {
        return {2 * kHeight, kHeight};
    }
    const bool orthographic = camera.kind == Camera::Kind::Orthographic;
    const float aspectRatio =
        orthographic ? std::abs(camera.halfWidth / camera.halfHeight) : camera.aspectRatio.value_or(kUsualAspectRatio);
    const float bounded = std::clamp(aspectRatio, 1.0F / kMaxAspectRatio, kMaxAspectRatio);
    return {static_cast<std::uint32_t>(std::round(static_cast<float>(kHeight) * bounded)), kHeight};
}

}  // namespace glim
