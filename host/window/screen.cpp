#include "host/window/screen.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace glim {
namespace {

float textScale(const Window& window) { return std::max(1.0F, window.contentScale()); }

}  // namespace

Screen::Screen(Window& window, const std::optional<std::string>& device)
    : window_(window),
      instance_(Window::instanceExtensions()),
      surface_(instance_, window.createSurface(instance_)),
      device_(instance_, device, surface_.handle()),
      scale_(textScale(window)),
      gui_(scale_),
      swapchain_(device_, surface_.handle())
{}

void Screen::takeScale()
{
    if (std::exchange(scale_, textScale(window_)) != scale_) {
        gui_.setScale(scale_);
        swapchain_.renewFonts();
    }
}

bool Screen::present(const StorageImage& picture)
{
    const glm::uvec2 size = window_.pictureSize();
    const bool shown = swapchain_.present(picture, gui_.drawn(), size.x, size.y);
    if (!shown) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return shown;
}

}  // namespace glim
