// Measures what needs the whole film, which takes time to copy: now and then as its samples grow.
#pragma once

#include "host/preview/panels.hpp"
#include "host/preview/refiner.hpp"
#include "host/render/aov.hpp"

#include <optional>
#include <vector>

namespace glim {

class FilmMeter {
public:
    // Forgets the errors: a new picture begins.
    void restart();
    // Measures at the next call.
    void renew() { measuredAt_ = 0; }
    // Measures if the samples have grown by a quarter since the last time, but not while the user `isWaiting`. `choosesExposure`: also an
    // exposure for the film. At once if that or the range of another AOV is not known yet. Returns whether it has measured.
    bool measure(Refiner& refiner, Aov aov, bool choosesExposure, bool isWaiting);

    const std::vector<ErrorPoint>& errors() const { return errors_; }  // of the present picture
    const DisplayRange& range() const { return range_; }
    double exposure() const { return exposure_; }  // in stops

private:
    std::vector<ErrorPoint> errors_;
    DisplayRange range_;
    double exposure_ = 0.0;
    std::uint64_t measuredAt_ = 0;    // samples
    std::optional<Aov> measuredAov_;  // that range_ and exposure_ belong to
};

}  // namespace glim
