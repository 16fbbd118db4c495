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

void PictureDrawer::resize(const glm::uvec2& picture, const glm::uvec2& window)
{
    size_ = picture;
    viewport_ = fit(picture, window);
    const Rectangle covered = coveredBy(viewport_, picture, window);
    display_.resize(window, covered.low, covered.high);
    painted_ = Painted::Nothing;
    isPainted_ = false;
}

void PictureDrawer::renew()
{
    display_.renew();
    painter_.reset();
    painted_ = Painted::Nothing;
    isPainted_ = false;
}

std::uint32_t PictureDrawer::windowScale() const
{
    const Rectangle covered = shown();
    const glm::uvec2 most = covered.high - covered.low;
    std::uint32_t scale = 1;
    while (size_.x > scale * most.x || size_.y > scale * most.y) {
        scale *= 2;
    }
    return scale;
}

bool PictureDrawer::draw(Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look,
                         const std::function<bool()>& shouldContinue)
{
    isPainted_ = false;
    return display_.draw(renderer, aov, range, look, isTransparent_ && showsSurfaces(aov) ? kDrawnOverCheckers : kDrawnInColor,
                         shouldContinue);
}

void PictureDrawer::draw(Renderer& renderer, const IdleDenoiser::Result& denoised, const Look& look)
{
    if (beginPainting(Painted::Denoised, denoised.version)) {
        painter_->setValues(layUnder(denoised.picture.radiance));
        if (isTransparent_) {
            painter_->setReference(layUnder(alphasOf(renderer.film())));
        }
    }
    ViewPass pass{};
    pass.shownAs = isTransparent_ ? kShownAsSurfaces : kShownAsColor;
    pass.scale = static_cast<float>(std::exp2(look.exposure));
    pass.tone = static_cast<std::uint32_t>(look.tone);
    paint(pass);
}

bool PictureDrawer::draw(Renderer& renderer, const ErrorLayer& errors, const Look& look, const std::function<bool()>& shouldContinue)
{
    if (!errors.isKnown()) {
        isPainted_ = false;
        return display_.draw(renderer, Aov::Radiance, {}, look, kDrawnInGrey, shouldContinue);
    }
    if (beginPainting(Painted::Errors, errors.version())) {
        painter_->setValues(layUnder(std::vector<glm::vec3>(errors.values().begin(), errors.values().end())));
    }
    ViewPass pass{};
    pass.shownAs = kShownAsError;
    pass.high = static_cast<float>(errors.target());
    paint(pass);
    return true;
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
    painter_->resize(windowSize());
    return true;
}

// The values of the picture's pixels under those of the window, until the next call.
const std::vector<glm::vec3>& PictureDrawer::layUnder(std::span<const glm::vec3> values)
{
    glim::layUnder({size_, values}, viewport_, windowSize(), true, values_);
    return values_;
}

// The part of the window that shows the picture.
void PictureDrawer::paint(ViewPass pass)
{
    const Rectangle covered = shown();
    pass.left = covered.low.x;
    pass.top = covered.low.y;
    pass.right = covered.high.x;
    pass.bottom = covered.high.y;
    painter_->draw(pass);
    isPainted_ = true;
}

}  // namespace glim
