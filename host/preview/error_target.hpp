// How far the picture's error is from a target.
#pragma once

#include <cstdint>
#include <string>

namespace glim {

// An estimate of the picture's error, at a time since its start.
struct ErrorPoint {
    double seconds, relMse;
    std::uint64_t samples;  // of all pixels together
    bool isWhole;           // it is known of every pixel, without which a render with a target goes on
};

// By what factor the samples grow from one estimate to the next, which takes a copy of the film.
constexpr double kUsualGrowth = 1.25;
// The same after `last`: no further than to where the target is expected, since the error falls as one over the samples.
double growthToNext(const ErrorPoint& last, double target);

// "target 0.001: reached", or the seconds to it at this speed. `samples`: now, of all pixels together.
std::string describeTarget(double target, const ErrorPoint& last, std::uint64_t samples, double samplesPerSecond, bool isDone);

// Call these inside a frame (host/window/gui.hpp).
// Returns the target that the user chooses.
double targetSlider(double target);
// The colours of the layer of errors, and what they mean.
void showErrorScale(double target);

}  // namespace glim
