// How long the user waited for pictures.
#pragma once

#include <cstddef>
#include <vector>

namespace glim {

class Latency {
public:
    void add(double seconds) { seconds_.push_back(seconds); }
    std::size_t count() const { return seconds_.size(); }
    // The least time that a share `q` of the waits did not exceed; 0 if there were none.
    double quantile(double q) const;

private:
    std::vector<double> seconds_;
};

}  // namespace glim
