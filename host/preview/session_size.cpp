// The session's picture: of which size it is, and where it lies in the window.
#include "host/error.hpp"
#include "host/preview/session.hpp"
#include "host/render/check_memory.hpp"
#include "host/render/parameters.hpp"

namespace glim {

// The first size, and those that the user chooses. A picture that follows the window is not refused.
void Session::checkPicture(const PreparedScene& prepared, const glm::uvec2& size) const
{
    RenderSettings settings = catchingSettings(prepared.flat, options_.settings);
    settings.width = size.x;
    settings.height = size.y;
    checkMemory(prepared, settings, screen_.device().description());
}

void Session::lay(const glm::uvec2& window)
{
    drawer_.resize(sizeIn(pictureSize_, window), window);
    pictures_.setWindowScale(drawer_.windowScale());
}

void Session::chooseSize(const PictureSize& wanted)
{
    try {
        checkPicture(pictures_.scene(), sizeIn(wanted, drawer_.windowSize()));
    } catch (const InputError& error) {
        tell(error.what());
        return;
    }
    pictureSize_ = wanted;
    lay(drawer_.windowSize());
    show();
}

// A picture of its own size goes on if the window's new size has something to show of it everywhere.
void Session::resize()
{
    const glm::uvec2 window = window_.pictureSize(), before = size();
    if (window.x == 0 || window.y == 0 || window == drawer_.windowSize()) {
        return;
    }
    lay(window);
    if (!pictures_.isEmpty() && (size() != before || !isWhole())) {
        show();
    }
}

}  // namespace glim
