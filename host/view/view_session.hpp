// The viewer's thread. It owns the device, handles the user's input and shows the films.
#pragma once

#include "host/clock.hpp"
#include "host/render/painter.hpp"
#include "host/view/view.hpp"
#include "host/view/view_panel.hpp"
#include "host/view/viewed_films.hpp"
#include "host/window/gestures.hpp"
#include "host/window/latency.hpp"
#include "host/window/notice.hpp"
#include "host/window/screen.hpp"
#include "host/window/viewport.hpp"

namespace glim {

class ViewSession {
public:
    ViewSession(Window& window, EventQueue& events, const ViewOptions& options, ViewedFilms films);

    // Runs until the window is closed.
    void run();
    // Prints how long the user waited for pictures.
    void printSummary() const;

private:
    // What the window shows of the chosen layer.
    struct Shown {
        Layer layer;  // A's, or B's if only that has it
        DisplayRange range;
        // How A - B is drawn (host/measure/error_picture.hpp), and how large it is, as a line of text.
        struct Difference {
            double relative, epsilon, scale;
            std::string error;
        };
        std::optional<Difference> difference;  // once it is needed
    };

    // The user's input.
    void handle(const Event& event);
    void handleMouse(const Event& event);
    void follow(const Gesture& gesture);
    void press(char key);
    void resize();
    void place(const Viewport& viewport);
    void chooseLayer(std::size_t index);
    void chooseSide(Side side);
    void change(const ViewChoices& wanted);
    void print(const glm::uvec2& pixel) const;
    void printLights() const;
    void setLights(const std::vector<double>& lights);
    void tell(const std::string& text);
    void readChangedFilms();

    // The picture and its panel.
    std::vector<Side> sides() const;
    ViewChoices shownChoices() { return {layer_, side_, exposure(), tone_, lights_}; }
    double& exposure() { return side_ == Side::Difference ? gain_ : exposure_; }
    bool isExposed() const { return side_ == Side::Difference || shown_.layer.isExposed; }
    bool isToned() const { return side_ != Side::Difference && shown_.layer.isToned; }
    Shown::Difference measureDifference() const;
    void draw();
    void present();
    void buildPanels();
    ViewFigures figures() const;
    std::vector<std::string> describePixel() const;

    Window& window_;
    EventQueue& events_;
    ViewedFilms films_;
    Screen screen_;
    Gui& gui_;
    Painter painter_;

    std::size_t layer_ = 0;
    Side wantedSide_ = Side::A, side_ = Side::A;  // the user's, and what is shown: another one if the layer lacks it
    Tone tone_ = Tone::None;
    double exposure_ = 0.0, gain_ = 0.0;  // stops, of colours and of differences
    bool exposureIsAuto_ = false;
    std::vector<double> lights_;     // factors of A's light groups
    std::string lightsError_;        // of A with them
    std::array<Picture, 2> values_;  // of the layer, A's and B's; empty where a film has none
    std::array<Picture, 2> alphas_;  // that they are multiplied by; empty where they are not
    Shown shown_;
    Viewport viewport_;
    bool isFitted_ = true;
    std::array<std::vector<glm::vec3>, 2> under_;  // the values under the window's pixels
    bool laid_ = false;                            // whether they are those of the present layer and viewport
    bool drawn_ = false;                           // whether the picture is

    Gestures gestures_;
    std::optional<glm::dvec2> pointer_;  // absent: over a panel
    bool closing_ = false;
    int panelLevel_ = 1;  // 0: nothing, 1: controls, 2: keys
    Notice notice_;
    bool changed_ = true;  // there is something new to present
    std::uint64_t handledEvents_ = 0;
    std::vector<Clock::time_point> waiting_;  // arrival times of the inputs that no picture answers yet
    Latency latency_;
};

}  // namespace glim
