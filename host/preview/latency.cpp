#include "host/preview/latency.hpp"

#include <algorithm>
#include <cmath>

namespace glim {

double Latency::quantile(double q) const
{
    if (seconds_.empty()) {
        return 0.0;
    }
    std::vector<double> sorted = seconds_;
    std::sort(sorted.begin(), sorted.end());
    const double rank = std::ceil(q * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) - 1];
}

}  // namespace glim
