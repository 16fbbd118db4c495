// The only place that knows GLFW. Everything here is for the main thread, but for what says otherwise.
#pragma once

#include "host/gpu/surface.hpp"
#include "host/preview/event_queue.hpp"
#include "host/preview/script.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glim {

class Window {
public:
    // Opens it; what the user does goes to `events`. Throws InputError where there is no display.
    Window(const std::string& title, const glm::uvec2& size, EventQueue& events);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Lets the user, or the script, act until finish().
    void run(const std::vector<ScriptStep>& script);

    // From any thread:
    static std::vector<const char*> instanceExtensions();
    // Of this window, to be taken over by a Surface. Throws InputError if Vulkan cannot show pictures in it.
    VkSurfaceKHR createSurface(const Instance& instance) const;
    glm::uvec2 pictureSize() const { return {pictureWidth_.load(), pictureHeight_.load()}; }  // pixels
    float contentScale() const { return contentScale_; }                        // of text, on displays with small pixels
    void setTitle(const std::string& title);
    void setSize(const glm::uvec2& size);
    // What is on show, for scripts that wait for it: samples that every pixel has, whether there will not be more, and how many of
    // the events so far have been answered.
    void reportShown(std::uint64_t samples, bool ended, std::uint64_t events);
    void finish();

private:
    struct Orders {  // for the main thread
        std::optional<std::string> title;
        std::optional<glm::uvec2> size;
    };

    void onKey(char key, int action);
    void onButton(bool pans, int button, int action);
    void onCursor(const glm::dvec2& position);
    void onScroll(double notches);
    void onResize();
    void onFocus(bool has);
    void onClose();
    void push(Event event);
    void carryOut(const Orders& orders);
    bool isDue(const ScriptStep& step, double since) const;
    void perform(const ScriptStep& step);
    void drag(const ScriptStep& step);

    EventQueue& events_;
    GLFWwindow* window_ = nullptr;
    std::atomic<std::uint32_t> pictureWidth_ = 0, pictureHeight_ = 0;
    std::atomic<float> contentScale_ = 1.0F;
    std::atomic<std::uint64_t> samples_ = 0, answered_ = 0;
    std::uint64_t pushed_ = 0;        // events
    std::atomic<bool> ended_ = false, finished_ = false;

    std::mutex mutex_;
    Orders orders_;

    std::set<char> held_;             // keys
    int button_ = -1;                 // that is down
    glm::dvec2 cursor_{0.0}, pressedAt_{0.0};
    bool pans_ = false, dragged_ = false;
};

}  // namespace glim
