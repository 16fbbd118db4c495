// Chooses how many paths a pass traces, from the times of earlier passes.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/settings.hpp"

namespace glim {

// Device seconds of a pass: of its longest dispatch, and of all.
struct PassSeconds {
    double longest, total;
};

class PassSize {
public:
    // `capacity`: the most paths in flight.
    PassSize(const FlatScene& scene, const RenderSettings& settings, std::uint32_t capacity);

    std::uint32_t paths() const { return paths_; }
    // Reports that a pass of this many paths took `seconds`.
    void learn(std::uint32_t paths, const PassSeconds& seconds);

private:
    std::uint32_t paths_, capacity_;
    double passSeconds_;
};

}  // namespace glim
