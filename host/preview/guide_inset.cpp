#include "host/preview/guide_inset.hpp"

namespace glim {

void GuideInset::look(Refiner& picture, const PreparedScene& prepared, Picker& picker, const std::optional<glm::uvec2>& pixel,
                      const glm::uvec2& size)
{
    const std::shared_ptr<const Guide>& guide = picture.renderer().settings().guide;
    if (guide && guide == guide_ && pixel == pixel_) {
        return;
    }
    guide_.reset();
    map_.reset();
    why_ = guide ? "no surface under the mouse" : "no guide yet";
    const PixelMoments moments = guide && pixel ? picture.renderer().moments(pixel->y * size.x + pixel->x) : PixelMoments{};
    if (moments.count == 0) {
        return;  // its first sample will be there soon
    }
    if (!probe_) {
        probe_.emplace(device_);
    }
    guide_ = guide;
    pixel_ = pixel;
    const std::optional<Pick> found = picker.pick(picture, prepared, *pixel, size);
    if (!found || moments.normal == glm::vec3(0.0F)) {
        return;
    }
    map_ = probe_->map(picture.renderer().resources().guide->texels(), vec3(found->position - prepared.scene.origin),
                       glm::normalize(moments.normal), picture.camera());
    if (map_->share == 0.0F) {
        map_.reset();
        why_ = "no guide here: the BSDF alone chooses";
    }
}

}  // namespace glim
