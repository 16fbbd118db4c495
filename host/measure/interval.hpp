// A figure and how far it may be from the truth.
#pragma once

namespace glim {

struct Interval {
    double value = 0.0;
    double low = 0.0, high = 0.0;  // 95 %; NaN where there is none
};

}  // namespace glim
