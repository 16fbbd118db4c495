#include "host/window/screen.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace glim {

Screen::Screen(Window& window, const std::optional<std::string>& device)
    : window_(window),
      instance_(Window::instanceExtensions()),
      surface_(instance_, window.createSurface(instance_)),
      device_(instance_, device, surface_.handle()),
      gui_(std::max(1.0F, window.contentScale())),
      swapchain_(device_, surface_.handle())
{}

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
