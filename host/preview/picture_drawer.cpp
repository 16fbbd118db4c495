#include "host/preview/picture_drawer.hpp"

#include <cmath>
#include <utility>

namespace glim {

void PictureDrawer::resize(const glm::uvec2& size)
{
    display_.resize(size.x, size.y);
    isDenoised_ = false;
}

void PictureDrawer::renew()
{
    display_.renew();
    painter_.reset();
    painted_ = 0;
    isDenoised_ = false;
}

void PictureDrawer::draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look)
{
    display_.draw(renderer, aov, range, look);
    isDenoised_ = false;
}

void PictureDrawer::draw(const IdleDenoiser::Result& denoised, const Look& look)
{
    if (!painter_) {
        painter_.emplace(device_);
    }
    if (std::exchange(painted_, denoised.version) != denoised.version) {
        painter_->resize(size());
        painter_->setValues(denoised.picture.radiance);
    }
    ViewPass pass{};
    pass.right = size().x;
    pass.bottom = size().y;
    pass.shownAs = kShownAsColor;
    pass.scale = static_cast<float>(std::exp2(look.exposure));
    pass.tone = static_cast<std::uint32_t>(look.tone);
    painter_->draw(pass);
    isDenoised_ = true;
}

}  // namespace glim
