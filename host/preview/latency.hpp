// How long the user waited for pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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

private:
    std::vector<double> seconds_;
};

}  // namespace glim
