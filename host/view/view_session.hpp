// The viewer's thread. It owns the device, handles the user's input and shows the films.
#pragma once

#include "host/gpu/swapchain.hpp"
#include "host/view/painter.hpp"
#include "host/view/placement.hpp"
#include "host/view/view.hpp"
#include "host/view/view_panel.hpp"
#include "host/view/viewed_films.hpp"
#include "host/window/gestures.hpp"
#include "host/window/gui.hpp"
#include "host/window/latency.hpp"
#include "host/window/window.hpp"

namespace glim {

class ViewSession {
public:
    ViewSession(Window& window, EventQueue& events, const ViewOptions& options, ViewedFilms films);

    // Runs until the window is closed. Prints at its end how long the user waited for pictures.
    void run();

private:
    using Clock = std::chrono::steady_clock;

    // What the window shows of the chosen layer.
    struct Shown {
        ShownAs as = ShownAs::Color;
        bool isLight = false;
        DisplayRange range;
        double relative = 0.0, epsilon = 1.0, errorScale = 0.0;  // of differences (host/measure/error_picture.hpp)
        std::string error;                                       // of A against B, as a line of text
    };

    // The user's input.
    void handle(const Event& event);
    void handleMouse(const Event& event);
    void follow(const Gesture& gesture);
    void press(char key);
    void resize();
    void place(const Placement& placement);
    void chooseLayer(std::size_t index);
    void chooseSide(Side side);
    void change(const ViewChoices& wanted);
    void print(const glm::uvec2& pixel) const;
    void tell(const std::string& text);
    void readChangedFilms();

    // The picture and its panel.
    std::vector<Side> sides() const;
    double& exposure() { return choices_.side == Side::Difference ? gain_ : exposure_; }
    void measureDifference();
    void draw();
    void present();
    void buildPanels();
    ViewFigures figures() const;
    std::vector<std::string> describePixel() const;

    Window& window_;
    EventQueue& events_;
    ViewedFilms films_;
    VulkanInstance instance_;
    Surface surface_;
    Device device_;
    Gui gui_;
    Swapchain swapchain_;
    Painter painter_;

    ViewChoices choices_;
    double exposure_ = 0.0, gain_ = 0.0;  // stops, of colours and of differences
    bool exposureIsAuto_ = false;
    std::array<Picture, 2> values_;  // of the layer, A's and B's; empty where a film has none
    Shown shown_;
    Placement placement_;
    bool isFitted_ = true;
    std::array<std::vector<glm::vec3>, 2> under_;  // the values under the window's pixels
    bool laid_ = false;                            // whether they are those of the present layer and placement
    bool drawn_ = false;                           // whether the picture is

    Gestures gestures_;
    glm::dvec2 pointer_{-1.0};
    bool closing_ = false;
    int panelLevel_ = 1;  // 0: nothing, 1: controls, 2: help too
    std::string notice_;
    Clock::time_point noticeTime_;
    bool changed_ = true;  // there is something new to present
    std::uint64_t handledEvents_ = 0;
    std::vector<Clock::time_point> waiting_;  // arrival times of the inputs that no picture answers yet
    Latency latency_;
};

}  // namespace glim
