// What the guide knows at the surface under the mouse.
#pragma once

#include "host/preview/pick.hpp"
#include "host/render/guide_map.hpp"

#include <memory>
#include <optional>
#include <string>

namespace glim {

class GuideInset {
public:
    explicit GuideInset(Device& device)
        : device_(device)
    {}

    // Looks again if the guide is another one than before, or the pixel, of a window of this size; absent: the mouse has not been there.
    void look(Refiner& picture, const PreparedScene& prepared, Picker& picker, const std::optional<glm::uvec2>& pixel,
              const glm::uvec2& size);
    // Kernels have changed.
    void renew()
    {
        probe_.reset();
        guide_.reset();
    }
    // Absent if there is nothing to show; why() says why.
    const std::optional<GuideMap>& map() const { return map_; }
    const std::string& why() const { return why_; }

private:
    Device& device_;
    std::optional<GuideProbe> probe_;  // made when it is first needed
    std::shared_ptr<const Guide> guide_;
    std::optional<glm::uvec2> pixel_;
    std::optional<GuideMap> map_;
    std::string why_;
};

}  // namespace glim
