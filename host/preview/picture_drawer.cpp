#include "host/preview/picture_drawer.hpp"

#include "host/render/film_pictures.hpp"

#include <cmath>

namespace glim {
namespace {

std::vector<glm::vec3> alphasOf(const Film& film)
{
    std::vector<glm::vec3> alphas;
    for (const PixelMoments& pixel : film.pixels) {
        alphas.emplace_back(pixel.alpha);
    }
    return alphas;
}

}  // namespace

void PictureDrawer::resize(const glm::uvec2& size)
{
    display_.resize(size.x, size.y);
    isPainted_ = false;
}

void PictureDrawer::renew()
{
    display_.renew();
    painter_.reset();
    painted_ = Painted::Nothing;
    isPainted_ = false;
}

void PictureDrawer::draw(Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look)
{
    display_.draw(renderer, aov, range, look, isTransparent_ && showsSurfaces(aov) ? kDrawnOverCheckers : kDrawnInColor);
    isPainted_ = false;
}

void PictureDrawer::draw(Renderer& renderer, const IdleDenoiser::Result& denoised, const Look& look)
{
    if (beginPainting(Painted::Denoised, denoised.version)) {
        painter_->setValues(denoised.picture.radiance);
        if (isTransparent_) {
            painter_->setReference(alphasOf(renderer.film()));
        }
    }
    ViewPass pass{};
    pass.shownAs = isTransparent_ ? kShownAsSurfaces : kShownAsColor;
    pass.scale = static_cast<float>(std::exp2(look.exposure));
    pass.tone = static_cast<std::uint32_t>(look.tone);
    paint(pass);
}

void PictureDrawer::draw(Renderer& renderer, const ErrorLayer& errors, const Look& look)
{
    if (!errors.isKnown()) {
        display_.draw(renderer, Aov::Radiance, {}, look, kDrawnInGrey);
        isPainted_ = false;
        return;
    }
    if (beginPainting(Painted::Errors, errors.version())) {
        painter_->setValues(std::vector<glm::vec3>(errors.values().begin(), errors.values().end()));
    }
    ViewPass pass{};
    pass.shownAs = kShownAsError;
    pass.high = static_cast<float>(errors.target());
    paint(pass);
}

// Returns whether the painter needs values.
bool PictureDrawer::beginPainting(Painted what, std::uint64_t version)
{
    if (!painter_) {
        painter_.emplace(device_);
    }
    if (painted_ == what && version_ == version) {
        return false;
    }
    painted_ = what;
    version_ = version;
    painter_->resize(size());
    return true;
}

// All of the picture.
void PictureDrawer::paint(ViewPass pass)
{
    pass.right = size().x;
    pass.bottom = size().y;
    painter_->draw(pass);
    isPainted_ = true;
}

}  // namespace glim
