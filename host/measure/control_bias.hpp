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

// Of the pixels of which `control` has samples, which no choice has depended on. The interval is that of a ratio of sums over pixels
// (Cochran 1977, Sampling Techniques, 6.4), whose differences tell their own spread. Nothing if they are fewer than 16, or black.
std::optional<ControlBias> estimateControlBias(const Film& film, const Film& control);

}  // namespace glim
