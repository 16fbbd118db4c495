// What an adaptive render has lost or won by choosing where to sample.
#pragma once

#include "host/measure/interval.hpp"
#include "host/render/film.hpp"

#include <cstddef>
#include <optional>

namespace glim {

struct ControlBias {
    std::size_t pixels = 0;  // of the control
    Interval bias;           // mean radiance of the film's pixels over that of the control's, less 1
};

// Of the pixels of which `control` has samples, which no choice has depended on. The interval is the jackknife's (Tukey 1958), of a
// ratio of sums over pixels. Nothing if they are fewer than 32, or one pixel has all the light.
std::optional<ControlBias> estimateControlBias(const Film& film, const Film& control);

}  // namespace glim
