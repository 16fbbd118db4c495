// Dear ImGui's context, the window's size and its mouse.
#pragma once

#include "host/window/event_queue.hpp"

#include <chrono>
#include <functional>

struct ImDrawData;

namespace glim {

class Gui {
public:
    // `scale` of texts and of all else; above 1 on high-DPI displays.
    explicit Gui(float scale);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    // Not within a frame. Whoever draws the frames takes the new fonts.
    void setScale(float scale);

    // Tells the mouse's state to the next frame. Between a press and a release there must be one.
    void point(const Event& event);
    // Builds a frame of a window of this size, with the panels that `build` makes by ImGui's functions.
    void frame(const glm::uvec2& size, const std::function<void()>& build);
    // Whether the mouse is the panels' since the last frame: it is over one, or holds a part of one.
    bool hasMouse() const;
    // The last frame.
    ImDrawData& drawn() const;

private:
    std::chrono::steady_clock::time_point last_;
};

}  // namespace glim
