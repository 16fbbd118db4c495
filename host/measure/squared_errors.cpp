#include "host/measure/squared_errors.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace glim {

TrimmedErrors trimErrors(const std::vector<SquaredErrors>& pixels)
{
    TrimmedErrors result;
    result.dropped = pixels.size() / 1000;
    std::vector<double> terms(pixels.size());
    for (double SquaredErrors::*metric : {&SquaredErrors::mse, &SquaredErrors::relMse, &SquaredErrors::relMseAbsolute}) {
        std::transform(pixels.begin(), pixels.end(), terms.begin(), std::mem_fn(metric));
        const auto kept = terms.begin() + static_cast<std::ptrdiff_t>(result.dropped);
        std::nth_element(terms.begin(), kept, terms.end(), std::greater<>());
        const double droppedSum = std::accumulate(terms.begin(), kept, 0.0);
        const double keptSum = std::accumulate(kept, terms.end(), 0.0);
        result.kept.*metric = keptSum / static_cast<double>(terms.size() - result.dropped);
        result.share.*metric = droppedSum > 0 ? droppedSum / (droppedSum + keptSum) : 0.0;
    }
    return result;
}

}  // namespace glim
