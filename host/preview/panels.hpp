// The panels over the preview's picture.
#pragma once

#include "host/preview/error_target.hpp"
#include "host/preview/lens_control.hpp"
#include "host/preview/picture_size.hpp"
#include "host/preview/scene_panel.hpp"
#include "host/preview/surface_panel.hpp"
#include "host/preview/timeline.hpp"
#include "host/render/aov.hpp"
#include "host/render/guide_map.hpp"
#include "host/window/notice.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glim {

// What the window shows of the picture: a channel of the film, or the error of its light.
struct WindowLayer {
    Aov aov = Aov::Radiance;
    bool isError = false;
    bool operator==(const WindowLayer&) const = default;
};

// What the panels show, and the user does not change there.
struct PanelFigures {
    std::uint32_t samples = 0;
    double seconds = 0.0, samplesPerSecond = 0.0;
    std::string state;  // such as "paused"; empty while sampling
    std::vector<ErrorPoint> errors;
    std::string toTarget;  // how far the error is from the target; there if errors are
    bool canDenoise = false;
    std::vector<std::string> denoising;  // lines
    glm::uvec2 size{0};                  // of the picture
    std::uint32_t scale = 1;             // the side of a film's pixel in pixels of the picture
    std::vector<PictureSize> sizes;
    std::string device;
    std::vector<WindowLayer> layers;
    std::vector<std::string> cameras;
    std::optional<float> widestAperture;  // its radius, metres; absent: the camera has no lens
    std::vector<Animation> animations;    // none: there is no time to choose
    SurfaceFigures surface;
    SceneFigures scene;
    std::size_t changes = 0;
    bool canGuide = false;
};

// What the user changes in the panels.
struct PanelChoices {
    double exposure = 0.0;
    Tone tone = Tone::None;
    WindowLayer layer;
    std::size_t camera = 0;
    std::optional<double> fieldOfView;  // vertical, degrees; absent: there is none to choose
    LensChoices lens;
    TimeChoices time;
    bool denoises = true;
    bool showsGuide = false;
    PictureSize picture;
    SurfaceChoices surface;
    SceneChoices scene;
    double target = 0.0;  // relMSE
    bool undo = false;
    bool operator==(const PanelChoices&) const = default;
};

// The sentences that the window shows.
struct PanelMessages {
    std::string stage;    // of the scene that is being loaded; empty if none is
    std::string trouble;  // why the present file is not shown; empty if it is
    std::string shaders;  // the same of the present shaders
    Notice notice;

    // Those that there are, each once.
    std::vector<std::string> lines() const;
};

// Call these inside a frame (host/window/gui.hpp).
// Returns `choices` with what the user changes in this frame.
PanelChoices showControls(const PanelFigures& figures, PanelChoices choices);
// In the upper right corner: what the guide knows at the point under the mouse, or why there is nothing to show.
void showGuide(const std::optional<GuideMap>& map, const std::string& why);
// Above the messages, whose height is `below`.
void showHelp(float below);

}  // namespace glim
