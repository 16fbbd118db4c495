// What learn_guide.hpp finds out, and a checkpoint keeps.
#pragma once

#include "host/render/guide.hpp"

#include <memory>
#include <optional>

namespace glim {

struct LearnedGuide {
    std::shared_ptr<const Guide> guide;  // null: it would not pay, or the observer has ended it
    std::optional<double> gain;          // of IfItPays: work (noise.hpp) and time of lookups without a guide over those with it
};

}  // namespace glim
