// What a window shows: a picture with panels over it, by the device that was chosen for the window.
#pragma once

#include "host/gpu/swapchain.hpp"
#include "host/window/gui.hpp"
#include "host/window/window.hpp"

#include <optional>
#include <string>

namespace glim {

class Screen {
public:
    // Throws InputError or DeviceError if no device, or not the chosen one, can present in the window.
    Screen(Window& window, const std::optional<std::string>& device);

    Device& device() { return device_; }
    const Device& device() const { return device_; }
    Gui& gui() { return gui_; }

    // Text and panels get the size that the window's display asks for, if it is another than before.
    void takeScale();

    // Shows `picture` with the panels of the last frame. Returns false, after a pause, if the window is hidden or changing: the caller may
    // try again.
    bool present(const StorageImage& picture);

private:
    Window& window_;
    VulkanInstance instance_;
    Surface surface_;
    Device device_;
    float scale_;
    Gui gui_;
    Swapchain swapchain_;
};

}  // namespace glim
