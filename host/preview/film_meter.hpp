// How the picture looks, and what is measured of the whole film for that. Copying a film takes time, so this is done now and then as its
// samples grow, and not of a film that has more pixels than the window: it would take seconds.
#pragma once

#include "host/preview/error_layer.hpp"
#include "host/preview/error_target.hpp"
#include "host/preview/refiner.hpp"
#include "host/render/film_pictures.hpp"

#include <optional>
#include <vector>

namespace glim {

class FilmMeter {
public:
    explicit FilmMeter(const LookOptions& options)
        : options_(options)
    {
        look_.exposure = options.exposure.value_or(0.0);
    }

    // From now on the exposure is no longer chosen by the film, nor the tone by the scene.
    void setExposure(double stops) { options_.exposure = look_.exposure = stops; }
    void setTone(Tone tone) { options_.tone = look_.tone = tone; }
    void enter(const Scene& scene) { look_.tone = options_.tone ? *options_.tone : chooseTone(scene); }

    // Forgets the errors: a new picture begins.
    void restart();
    // Measures at the next call.
    void renew() { measuredAt_ = 0; }
    // Measures if the samples have grown by a quarter since the last time, are all there or may have reached the target, but not while the
    // user `isWaiting`. At once if an exposure for `aov` or its range is not known yet.
    void measure(Refiner& refiner, Aov aov, bool isWaiting);

    const std::vector<ErrorPoint>& errors() const { return errors_; }  // of the present picture
    ErrorLayer& errorLayer() { return errorLayer_; }
    const ErrorLayer& errorLayer() const { return errorLayer_; }
    const DisplayRange& range() const { return range_; }
    const Look& look() const { return look_; }
    // What of it was set.
    const LookOptions& options() const { return options_; }
    // Takes an exposure for this film, unless it was set.
    void expose(const Film& film, Aov aov);

private:
    LookOptions options_;
    Look look_;
    std::vector<ErrorPoint> errors_;
    ErrorLayer errorLayer_;
    DisplayRange range_;
    std::uint64_t measuredAt_ = 0;    // samples
    std::optional<Aov> measuredAov_;  // that range_ belongs to
};

}  // namespace glim
