// The thread that renders and owns the device: takes what the user did, works, shows.
#pragma once

#include "host/preview/latency.hpp"
#include "host/preview/picture_writer.hpp"
#include "host/preview/preview.hpp"
#include "host/preview/refiner.hpp"
#include "host/preview/scene_loader.hpp"
#include "host/preview/viewpoint.hpp"
#include "host/preview/window.hpp"
#include "host/gpu/swapchain.hpp"
#include "host/render/display.hpp"

#include <deque>
#include <functional>
#include <set>

namespace glim {

class Session {
public:
    Session(Window& window, EventQueue& events, const PreviewOptions& options);

    // Until the window is closed or the frames are shown.
    void run();
    // Prints what the session was like.
    void printSummary() const;

private:
    using Clock = std::chrono::steady_clock;

    Refiner& refiner() const { return look_ == Look::Steps ? *steps_ : *light_; }
    bool isWhole() const { return !moved_ && refiner().scale() == 1 && refiner().sampleCount() > 0; }
    bool isAsked() const { return moved_ || !inbox_.empty() || !events_.isEmpty(); }
    // session.cpp: the loop
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
    void measure();
    // actions.cpp: what the user does
    void handle(const Event& event);
    void moveBy(const Event& event);
    void press(char key);
    void pressForScene(char key);
    void cycleLook();
    void lookAt(Look look);
    void clickAt(const glm::dvec2& position);
    std::string describeSamples(const glm::uvec2& pixel);
    void printCamera();
    void writePictures();
    void say(const std::string& text);   // in the window
    void tell(const std::string& text);  // there and on stderr
    // overlay.cpp: what the window says
    std::vector<std::string> overlay();
    std::vector<std::string> figures();

    Window& window_;
    EventQueue& events_;
    PreviewOptions options_;
    Instance instance_;
    Surface surface_;
    Device device_;
    Swapchain swapchain_;
    Display display_;
    SceneLoader loader_;
    PictureWriter writer_;

    std::unique_ptr<PreparedScene> prepared_;
    std::unique_ptr<Refiner> light_, steps_;  // of --view shaded and bvh-steps; the latter once it is looked at, with light_'s buffers
    std::optional<Viewpoint> viewpoint_;
    Look look_ = Look::Radiance;
    std::deque<Event> inbox_;                 // of events_, those not handled yet
    std::function<void()> later_;             // to be done once the window has said so
    bool writes_ = false;                     // a picture, once there is a whole one
    std::set<char> held_;                     // keys that fly
    bool paused_ = false, closing_ = false;
    int overlayLevel_ = 1;                    // 0: nothing, 1: figures, 2: help too
    std::string notice_;                      // the last thing said
    std::string trouble_;                     // why the file as it is now is not shown
    Clock::time_point noticeTime_, flown_, presented_;
    double presentSeconds_ = 0.0;             // that the last one took
    std::vector<Clock::time_point> waiting_;  // when what no picture answers yet came in
    std::vector<Clock::time_point> underWay_; // and what the next one answers
    bool changed_ = true;                     // there is something new to show
    bool moved_ = false;                      // the camera, since show()
    bool shown_ = true;                       // what show() began
    std::uint64_t handled_ = 0;               // events
    Latency latency_;
    std::uint64_t frames_ = 0;
    std::optional<double> relMse_;            // estimated, when the picture had estimatedAt_ samples
    LookRange range_;
    Look measuredLook_ = Look::Radiance;      // that range_ is of
    std::string title_;
    std::uint64_t estimatedAt_ = 0;
    bool lightIsStale_ = false;               // light_ is of another camera, since steps_ was looked at
};

}  // namespace glim
