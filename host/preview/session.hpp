// The preview's rendering thread. It owns the device, handles the user's input, renders and shows pictures.
#pragma once

#include "host/preview/film_meter.hpp"
#include "host/preview/panels.hpp"
#include "host/preview/picture_writer.hpp"
#include "host/preview/preview.hpp"
#include "host/preview/refiner.hpp"
#include "host/preview/scene_loader.hpp"
#include "host/preview/viewpoint.hpp"
#include "host/render/display.hpp"
#include "host/window/gestures.hpp"
#include "host/window/latency.hpp"
#include "host/window/notice.hpp"
#include "host/window/screen.hpp"
#include "host/window/widgets.hpp"

#include <deque>
#include <functional>
#include <set>

namespace glim {

class Session {
public:
    Session(Window& window, EventQueue& events, const PreviewOptions& options);

    // Runs until the window is closed or all frames are shown.
    void run();
    // Prints how many pictures were shown and how long the user waited for them.
    void printSummary() const;

private:
    using Clock = std::chrono::steady_clock;

    Refiner& refiner() const { return aov_ == Aov::BvhSteps ? *steps_ : *light_; }
    bool isWhole() const { return !moved_ && refiner().scale() == 1 && refiner().sampleCount() > 0; }
    bool isInputWaiting() const { return moved_ || !inbox_.empty() || !events_.isEmpty(); }

    // The loop.
    void takeEvents(double seconds);
    void takeScene();
    void enter(std::unique_ptr<PreparedScene> prepared);
    void resize();
    void fly();
    void followCamera();
    void show();
    bool work();
    bool isPresentDue();
    void present();
    void reportShown();
    void measure();

    // The user's actions.
    void handle(const Event& event);
    void handleMouse(const Event& event);
    void follow(const Gesture& gesture);
    void moveBy(const Gesture& gesture);
    void press(char key);
    void pressForScene(char key);
    std::vector<Aov> layers() const;
    void chooseLayer(Aov aov);
    void showAov(Aov aov);
    void chooseCamera(std::size_t index);
    void setExposure(double exposure);
    void setTone(Tone tone);
    void clickAt(const glm::dvec2& position);
    void printCamera();
    void writePictures();
    void say(const std::string& text);   // shows the text in the window
    void tell(const std::string& text);  // shows the text in the window and prints it to stderr

    // The panels over the picture.
    void buildPanels();
    PanelFigures figures() const;
    std::vector<std::string> messages() const;

    Window& window_;
    EventQueue& events_;
    PreviewOptions options_;
    Screen screen_;
    Gui& gui_;
    Display display_;
    SceneLoader loader_;
    PictureWriter writer_;

    std::unique_ptr<PreparedScene> prepared_;
    // light_ makes all pictures but that of BVH steps. steps_ is made when that is first shown, and shares light_'s buffers.
    std::unique_ptr<Refiner> light_, steps_;
    std::optional<Viewpoint> viewpoint_;
    Aov aov_ = Aov::Radiance;
    std::deque<Event> inbox_;      // events that are taken but not handled yet
    std::function<void()> later_;  // work that starts once the window shows the message about it
    bool writes_ = false;          // a picture is to be written once it is complete
    std::set<char> heldKeys_;      // pressed keys that move the camera
    Gestures gestures_;
    bool mouseIsPanels_ = false;  // since the last event of the mouse
    bool paused_ = false, closing_ = false;
    int panelLevel_ = 1;   // 0: nothing, 1: controls, 2: help too
    Notice notice_;        // the last text of say()
    std::string trouble_;  // why the present file is not shown; empty if it is
    Clock::time_point flown_, presented_;
    double presentSeconds_ = 0.0;              // the time that the last present() took
    std::vector<Clock::time_point> waiting_;   // arrival times of the inputs that no picture answers yet
    std::vector<Clock::time_point> underWay_;  // arrival times of the inputs that the next picture answers
    bool changed_ = true;                      // there is something new to show
    bool moved_ = false;                       // the camera has moved since show()
    bool shown_ = true;                        // the picture that show() began has been presented
    std::uint64_t handledEvents_ = 0;
    Latency latency_;
    std::uint64_t frames_ = 0;
    FilmMeter meter_;
    Look look_;
    std::string title_;
    bool lightIsStale_ = false;  // the camera has moved since light_ was last shown
};

}  // namespace glim
