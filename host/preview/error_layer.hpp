// The window's layer of the error: what each pixel's estimated error is against a target.
#pragma once

#include "host/measure/error_map.hpp"

#include <cstdint>
#include <vector>

namespace glim {

// relMSE of the picture, as of --target-relmse.
constexpr double kFirstTarget = 0.001;

class ErrorLayer {
public:
    void show(bool shows)
    {
        isShown_ = shows;
        values_.clear();
    }
    bool isShown() const { return isShown_; }
    void setTarget(double relMse) { target_ = relMse; }
    double target() const { return target_; }

    // Forgets the errors: another picture begins.
    void restart() { values_.clear(); }
    // Takes those of a picture, if they are shown.
    void take(const Picture& picture, const std::vector<glm::dvec3>& likely)
    {
        if (isShown_) {
            values_ = mapErrors(picture, likely);
            ++version_;
        }
    }
    bool isKnown() const { return !values_.empty(); }
    const std::vector<float>& values() const { return values_; }  // as of mapErrors()
    std::uint64_t version() const { return version_; }            // unique

private:
    bool isShown_ = false;
    double target_ = kFirstTarget;
    std::vector<float> values_;
    std::uint64_t version_ = 0;
};

}  // namespace glim
