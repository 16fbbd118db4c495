// How many paths a pass takes, from what the last ones took.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/settings.hpp"

namespace glim {

// Device seconds of a pass: its longest dispatch, and all.
struct PassSeconds {
    double longest, total;
};

class PassSize {
public:
    PassSize(const FlatScene& scene, const RenderSettings& settings);

    std::uint32_t paths() const { return paths_; }
    // A pass of so many paths has taken `seconds`.
    void learn(std::uint32_t paths, const PassSeconds& seconds);

private:
    std::uint32_t paths_, capacity_;
    double passSeconds_;
};

}  // namespace glim
