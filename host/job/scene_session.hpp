// A scene on a device, for one picture after another.
#pragma once

#include "host/job/denoising.hpp"
#include "host/job/render_job.hpp"
#include "host/render/learn_guide.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/renderer.hpp"

#include <optional>
#include <string>
#include <utility>

namespace glim {

class SceneSession {
public:
    // Reads the scene at the time of the first picture that the options ask for. Throws InputError, or DeviceError without a usable device.
    // Used once, it renders one picture of that time with these edits, and its primitives and meshes are gone once that begins.
    explicit SceneSession(const RenderJob& options, SceneUse use = SceneUse::Again);

    // Whether it can render what these options ask for: they differ from its own in nothing but samples, seed, size, rows, camera, time,
    // edits and outputs, and no file of the scene has changed.
    bool serves(const RenderJob& options) const;

    // The scene with these edits of its files, at that time. If a file refuses, throws InputError and changes nothing.
    void pose(const std::vector<Edit>& edits, std::optional<double> time);
    // The scene with the present edits at another time, without motion blur, which changes nothing here.
    Scene sceneAt(double time) { return file_.sceneAt(time, false); }
    // The renderer, at the beginning of a picture. It is a new one if other rows are asked for. A new one for a long picture measures which
    // schedule is the faster one.
    Renderer& begin(const FlatCamera& camera, RenderSettings settings);
    // Whether light paths find the caustics of a picture by these settings (light_path_gain.hpp). It is measured anew for another camera,
    // size or scene.
    bool choosesLightPaths(const FlatCamera& camera, const RenderSettings& settings);
    // What the paths of a picture by these settings are guided by. It is learned anew for another camera, size or scene,
    // and if light paths find caustics now or no longer.
    LearnedGuide learnGuide(const FlatCamera& camera, const RenderSettings& settings, GuideUse use, const LearningObserver& observer);
    // As begin(), for rays that are traced before the picture, which begin() then begins. Its statistics have the upload, not these rays.
    Renderer& beginAhead(const FlatCamera& camera, const RenderSettings& settings);

    const PreparedScene& prepared() const { return prepared_; }
    const Device& device() const { return device_; }
    Renderer& renderer() { return *renderer_; }  // after the first begin()
    FilmDenoiser& denoiser() { return denoiser_; }

private:
    struct LightPathChoice {
        std::string camera;  // its fingerprint
        glm::uvec2 size;
        bool isLight;
    };
    struct KeptGuide {
        std::string camera;
        glm::uvec2 size;
        bool caustics;
        GuideUse use;
        LearnedGuide learned;
    };
    using Stamp = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // last write and length

    static std::vector<Stamp> readStamps(const std::vector<std::filesystem::path>& files);

    RenderJob options_;
    const SceneUse use_;
    VulkanInstance instance_;
    Device device_;
    SceneFile file_;
    std::optional<double> time_;
    PreparedScene prepared_;
    std::vector<Stamp> stamps_;
    std::optional<Renderer> renderer_;
    std::optional<LightPathChoice> lightPaths_;  // the last one, of the present scene
    std::optional<KeptGuide> guide_;             // the same
    FilmDenoiser denoiser_;
    bool isSceneNew_ = true;  // to the renderer
    bool isAhead_ = false;    // the renderer, of the picture's samples
};

}  // namespace glim
