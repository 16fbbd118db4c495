// The bias of an adaptive render, which chooses where to sample.
#pragma once

#include "host/measure/confidence.hpp"
#include "host/render/film.hpp"

#include <cstddef>
#include <optional>

namespace glim {

struct ControlBias {
    std::size_t pixels = 0;  // of the control
    Interval bias;           // mean radiance of the film's pixels over that of the control's, less 1
};

// Compares the pixels that `control` has samples of, on which no allocation depended. The interval is the jackknife's (Tukey 1958) for a
// ratio of sums over pixels. Returns nothing if there are fewer than 32 of them, or if one pixel has all the light.
std::optional<ControlBias> estimateControlBias(const Film& film, const Film& control);

}  // namespace glim
