// The window. Only these files use GLFW. The main thread calls all functions that are not marked otherwise.
#pragma once

#include "host/gpu/instance.hpp"
#include "host/window/event_queue.hpp"
#include "host/window/pixels.hpp"
#include "host/window/script.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace glim {

class Window {
public:
    // Opens the window, of a size in pixels. User input goes to `events`. Throws InputError if there is no display.
    Window(const std::string& title, const glm::uvec2& size, EventQueue& events);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Handles the user's input and the script until finish() is called.
    void run(const std::vector<ScriptStep>& script);

    // Any thread may call the following functions.
    static std::vector<const char*> instanceExtensions();
    // What a window may cover of the first screen. Only the main thread may call it, before there is a window, too. Throws InputError if
    // there is no display.
    static glm::uvec2 screenSize();
    // The caller owns the result. Throws InputError if Vulkan cannot present in this window.
    VkSurfaceKHR createSurface(const VulkanInstance& instance) const;
    glm::uvec2 pictureSize() const { return {pictureWidth_.load(), pictureHeight_.load()}; }  // pixels
    float contentScale() const { return contentScale_; }                                      // of text; 2 where pixels are half as wide
    void setTitle(const std::string& title);
    void setSize(const glm::uvec2& size);  // pixels
    // Tells scripts what the window shows: the samples of every pixel, whether sampling has ended, and how many events have been
    // handled since the start.
    void reportShown(std::uint64_t samples, bool ended, std::uint64_t events);
    void finish();

private:
    struct Orders {  // from other threads to the main thread
        std::optional<std::string> title;
        std::optional<glm::uvec2> size;
    };

    void onKey(char key, int action);
    void toggleFullScreen();
    void onButton(int button, int action, bool shift);
    void onCursor(const glm::dvec2& position);
    void onScroll(double notches);
    void onResize();
    void onScale(float scale);
    void onDrop(const std::filesystem::path& file);
    void onClose();
    PixelScale pixelScale() const;
    void resize(const glm::uvec2& size);
    void push(Event event);
    void carryOut(const Orders& orders);
    bool isDue(const ScriptStep& step, double since) const;
    void perform(const ScriptStep& step);
    void drag(const ScriptStep& step);

    EventQueue& events_;
    GLFWwindow* window_ = nullptr;
    std::atomic<std::uint32_t> pictureWidth_ = 0, pictureHeight_ = 0;
    std::atomic<float> contentScale_ = 1.0F;
    std::atomic<std::uint64_t> samples_ = 0, handledEvents_ = 0;
    std::uint64_t pushedEvents_ = 0;
    std::atomic<bool> ended_ = false, finished_ = false;

    std::mutex mutex_;
    Orders orders_;

    glm::dvec2 cursor_{0.0};
    std::optional<glm::ivec4> windowed_;  // position and size to return to from the full screen
};

}  // namespace glim
