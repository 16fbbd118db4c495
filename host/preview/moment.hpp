// A time of one of the file's animations.
#pragma once

#include <optional>
#include <string>

namespace glim {

struct Moment {
    std::string animation;          // name or index; empty: the first
    std::optional<double> seconds;  // absent: the file's rest pose

    bool operator==(const Moment&) const = default;
};

}  // namespace glim
