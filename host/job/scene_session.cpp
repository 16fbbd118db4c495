#include "host/job/scene_session.hpp"

#include "host/memory.hpp"
#include "host/render/light_path_gain.hpp"

#include <algorithm>

namespace glim {
namespace {

LoadOptions loadOptionsFor(const RenderJob& options)
{
    LoadOptions load = makeLoadOptions(options);
    load.framed = load.framed || options.sequence.turntable > 0;
    load.at.reset();  // pose() says when
    return load;
}

// Without what may differ between two pictures of one session.
RenderSettings lastingSettings(RenderSettings settings)
{
    const RenderSettings other;
    settings.rows = other.rows;
    settings.sampleBegin = other.sampleBegin;
    settings.sampleEnd = other.sampleEnd;
    settings.seconds = other.seconds;
    settings.seed = other.seed;
    return settings;
}

}  // namespace

SceneSession::SceneSession(const RenderJob& options, SceneUse use)
    : options_(options),
      use_(use),
      device_(instance_, options.device),
      file_(options.scene, loadOptionsFor(options)),
      time_(firstTime(options.sequence, options))
{
    updateScene(
        prepared_, file_, time_, options.split, [](const std::string&) {}, use);
    stamps_ = readStamps(prepared_.scene.files);
}

std::vector<SceneSession::Stamp> SceneSession::readStamps(const std::vector<std::filesystem::path>& files)
{
    std::vector<Stamp> stamps;
    std::error_code gone;
    for (const std::filesystem::path& file : files) {
        stamps.emplace_back(std::filesystem::last_write_time(file, gone), std::filesystem::file_size(file, gone));
    }
    return stamps;
}

bool SceneSession::serves(const RenderJob& options) const
{
    LoadOptions load = loadOptionsFor(options);
    const LoadOptions mine = loadOptionsFor(options_);
    load.edits = mine.edits;
    if (std::ranges::none_of(prepared_.scene.cameras, [](const Camera& camera) { return camera.name == "framed"; })) {
        load.aspectRatio = mine.aspectRatio;
        load.yfov = mine.yfov;
    }
    const bool sameScene =
        options.scene == options_.scene && load == mine && options.split == options_.split && stamps_ == readStamps(prepared_.scene.files);
    const bool sameLens = (options.lens.radius > 0.0F) == (options_.lens.radius > 0.0F);
    return sameScene && sameLens && options.device == options_.device &&
           lastingSettings(options.settings) == lastingSettings(options_.settings);
}

void SceneSession::pose(const std::vector<Edit>& edits, std::optional<double> time)
{
    const bool isEdited = edits != options_.edits;
    const bool isLost = use_ == SceneUse::Again && prepared_.bvh.nodes.empty();  // to a lack of memory
    if (!isEdited && time == time_ && !isLost) {
        return;
    }
    if (isEdited) {
        LoadOptions load = file_.options();
        load.edits = edits;
        load.at = time;
        changeScene(prepared_, file_, load, options_.split);
    } else {
        updateScene(prepared_, file_, time, options_.split);
    }
    options_.edits = edits;
    time_ = time;
    lightPaths_.reset();
    guide_.reset();
    isSceneNew_ = true;
}

bool SceneSession::choosesLightPaths(const FlatCamera& camera, const RenderSettings& settings)
{
    const std::string name = fingerprint(0, camera);
    const glm::uvec2 size(settings.width, settings.height);
    if (!lightPaths_ || lightPaths_->camera != name || lightPaths_->size != size) {
        const auto renderer = [&]() -> const Renderer& { return beginAhead(camera, settings); };
        lightPaths_ = LightPathChoice{name, size, glim::choosesLightPaths(prepared_.flat, camera, settings, renderer)};
    }
    return lightPaths_->isLight;
}

LearnedGuide SceneSession::learnGuide(const FlatCamera& camera, const RenderSettings& settings, GuideUse use,
                                      const LearningObserver& observer)
{
    const std::string name = fingerprint(0, camera);
    const glm::uvec2 size(settings.width, settings.height);
    if (guide_ && guide_->camera == name && guide_->size == size && guide_->caustics == settings.caustics && guide_->use == use) {
        return guide_->learned;
    }
    bool isWhole = true;
    LearnedGuide learned = glim::learnGuide(beginAhead(camera, settings), prepared_.flat, camera, settings, use,
                                            [&](const LearningPause& pause) { return isWhole = observer(pause); });
    if (isWhole) {
        guide_ = KeptGuide{name, size, settings.caustics, use, learned};
    }
    return learned;
}

Renderer& SceneSession::begin(const FlatCamera& camera, RenderSettings settings)
{
    if (use_ == SceneUse::Once) {  // the device gets the flat scene
        prepared_.scene.meshes = {};
        prepared_.primitives = {};
        prepared_.bvh = {.depth = prepared_.bvh.depth, .cost = prepared_.bvh.cost};
        returnFreedMemory();
    }
    if (!renderer_ || renderer_->settings().rows != settings.rows || renderer_->settings().caustics != settings.caustics ||
        renderer_->settings().guide != settings.guide) {
        renderer_.reset();  // so that no two are on the device
        renderer_.emplace(device_, prepared_.flat, camera, settings);
    } else if (isSceneNew_) {
        renderer_->setSampling(settings);
        renderer_->restart(prepared_.flat, camera, settings.width, settings.height);
    } else {
        if (isAhead_) {
            renderer_->resources().clearStatistics();
        } else {
            renderer_->clearStatistics();
        }
        renderer_->setSampling(settings);
        renderer_->adapt(prepared_.flat, camera);
        renderer_->restart(camera, settings.width, settings.height);
    }
    isSceneNew_ = isAhead_ = false;
    return *renderer_;
}

Renderer& SceneSession::beginAhead(const FlatCamera& camera, const RenderSettings& settings)
{
    RenderSettings ahead = settings;
    ahead.caustics = renderer_ ? renderer_->settings().caustics : settings.caustics;  // no new renderer for this
    ahead.guide = renderer_ ? renderer_->settings().guide : settings.guide;
    begin(camera, ahead);
    isAhead_ = true;
    return *renderer_;
}

}  // namespace glim
