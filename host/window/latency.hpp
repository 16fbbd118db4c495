// How long the user waited for pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace glim {

class Latency {
public:
    void add(double seconds) { seconds_.push_back(seconds); }
    std::size_t count() const { return seconds_.size(); }

    // The shortest wait that is at least as long as a share `q` of all waits; 0 if there were none.
    double quantile(double q) const
    {
        if (seconds_.empty()) {
            return 0.0;
        }
        std::vector<double> sorted = seconds_;
        std::sort(sorted.begin(), sorted.end());
        const double rank = std::ceil(q * static_cast<double>(sorted.size()));
        return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1];
    }

    // As in "7 inputs, from input to picture 25 ms (median), 70 ms (99 %), 80 ms (longest)"; empty if there were none.
    std::string describe() const
    {
        if (seconds_.empty()) {
            return "";
        }
        char text[160];
        std::snprintf(text, sizeof text, "%zu inputs, from input to picture %.0f ms (median), %.0f ms (99 %%), %.0f ms (longest)", count(),
                      1e3 * quantile(0.5), 1e3 * quantile(0.99), 1e3 * quantile(1.0));
        return text;
    }

private:
    std::vector<double> seconds_;
};

}  // namespace glim
