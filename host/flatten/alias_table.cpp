#include "host/flatten/alias_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glim {
namespace {

constexpr double kTwo32 = 4294967296.0;

// The share of the 2^32 numbers that falls into bin `bin` of `count` (chooseBin in alias.glsl).
double binProbability(std::uint64_t bin, std::uint64_t count)
{
    const auto first = [count](std::uint64_t b) { return ((b << 32) + count - 1) / count; };
    return static_cast<double>(first(bin + 1) - first(bin)) / kTwo32;
}

std::uint32_t threshold(double share) { return static_cast<std::uint32_t>(std::clamp(std::round(share * kTwo32), 1.0, kTwo32 - 1.0)); }

std::vector<double> implementedProbabilities(const std::vector<AliasEntry>& entries)
{
    std::vector<double> probabilities(entries.size(), 0.0);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double bin = binProbability(i, entries.size());
        const double keep = entries[i].other == i ? 1.0 : entries[i].threshold / kTwo32;
        probabilities[i] += bin * keep;
        probabilities[entries[i].other] += bin * (1.0 - keep);
    }
    return probabilities;
}

}  // namespace

AliasTable buildAliasTable(std::span<const double> weights)
{
    const std::size_t count = weights.size();
    const double largest = *std::max_element(weights.begin(), weights.end());
    const double sum =
        std::accumulate(weights.begin(), weights.end(), 0.0, [largest](double total, double weight) { return total + weight / largest; });
    std::vector<double> share(count);
    std::vector<std::uint32_t> small, large;
    AliasTable table;
    for (std::uint32_t i = 0; i < count; ++i) {
        share[i] = weights[i] / largest / sum * static_cast<double>(count);
        (share[i] < 1.0 ? small : large).push_back(i);
        table.entries.push_back({0xffffffffU, i});
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        table.entries[poor] = {threshold(share[poor]), rich};
        share[rich] -= 1.0 - share[poor];
        if (share[rich] < 1.0) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    table.probabilities = implementedProbabilities(table.entries);
    return table;
}

}  // namespace glim
