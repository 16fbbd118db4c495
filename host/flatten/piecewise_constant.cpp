#include "host/flatten/piecewise_constant.hpp"

#include <algorithm>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint64_t kWords = std::uint64_t{1} << 32;

}  // namespace

std::vector<PiecewiseConstantEntry> buildPiecewiseConstant(std::span<const double> weights)
{
    const double scale = static_cast<double>(kWords) / std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::uint64_t count = weights.size();
    std::vector<PiecewiseConstantEntry> entries(count);
    double sum = 0.0;
    std::uint64_t begin = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        sum += weights[i];
        const std::uint64_t left = count - 1 - i;  // each of them needs a word too
        const std::uint64_t end =
            left == 0 ? kWords : std::clamp<std::uint64_t>(static_cast<std::uint64_t>(sum * scale), begin + 1, kWords - left);
        entries[i].first = static_cast<std::uint32_t>(begin);
        entries[i].last = static_cast<std::uint32_t>(end - 1);
        begin = end;
    }
    // Chen and Asau, "On Generating Random Variates from an Empirical Distribution" (1974).
    std::uint32_t entry = 0;
    const auto advanceTo = [&](std::uint64_t word) {
        while (entries[entry].last < word) {
            ++entry;
        }
        return entry;
    };
    for (std::uint64_t i = 0; i < count; ++i) {
        // The words that `chooseBin` of lib/hash.glsl maps to i.
        entries[i].searchBegin = advanceTo((i * kWords + count - 1) / count);
        entries[i].searchEnd = advanceTo(((i + 1) * kWords + count - 1) / count - 1);
    }
    return entries;
}

double computeProbability(const PiecewiseConstantEntry& entry)
{
    return (static_cast<double>(entry.last - entry.first) + 1.0) / static_cast<double>(kWords);
}

}  // namespace glim
