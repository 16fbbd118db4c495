#include "host/scene/choose_origin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace glim {
namespace {

// A median is rounded to 2^-8 of the median size, so that subtracting it is exact even where it would need all 53 bits.
constexpr int kOriginBits = 8;

constexpr std::size_t kTinyShare = 64, kTinyCount = 4;

constexpr double kMaxReach = 4.0;

// A part is coarse if so many of its primitives are smaller than 64 times the spacing of coordinates.
constexpr double kCoarseShare = 1.0 / 8.0, kMinSteps = 64.0;

double nthOf(std::vector<double> values, std::size_t n)
{
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(n);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

std::vector<double> sizesOf(std::span<const Place> places)
{
    std::vector<double> sizes;
    for (const Place& place : places) {
        sizes.push_back(place.size);
    }
    return sizes;
}

struct Weighted {
    double x, weight;
};

// The first x with at least half of the weight at or below it.
double computeMedian(std::vector<Weighted> values)
{
    std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) { return a.x < b.x; });
    double all = 0.0, below = 0.0;
    for (const Weighted& value : values) {
        all += value.weight;
    }
    for (const Weighted& value : values) {
        below += value.weight;
        if (2.0 * below >= all) {
            return value.x;
        }
    }
    return values.back().x;
}

double weightOf(const Place& place, double least) { return place.count * least / std::max(place.size, least); }

glm::dvec3 computeMedian(std::span<const Place> places, double least)
{
    const double grid = std::ldexp(1.0, std::ilogb(nthOf(sizesOf(places), places.size() / 2)) - kOriginBits);
    glm::dvec3 median;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Weighted> values;
        for (const Place& place : places) {
            values.push_back({place.center[axis], weightOf(place, least)});
        }
        median[axis] = std::round(computeMedian(std::move(values)) / grid) * grid + 0.0;  // no negative zero
    }
    return median;
}

// How far half of the weight lies away at most.
double reachOf(const glm::dvec3& origin, std::span<const Place> places, double least)
{
    std::vector<Weighted> values;
    for (const Place& place : places) {
        const glm::dvec3 from = glm::abs(place.center - origin);
        values.push_back({std::max({from.x, from.y, from.z}) + 0.5 * place.size, weightOf(place, least)});
    }
    return computeMedian(std::move(values));
}

double spacingAt(const Place& place, const glm::dvec3& origin)
{
    const glm::dvec3 from = glm::abs(place.center - origin);
    return std::ldexp(1.0, std::ilogb(std::max({from.x, from.y, from.z}) + 0.5 * place.size) - 23);
}

struct Tally {
    double count = 0.0, coarse = 0.0;
    CoarsePart worst{};
};

bool isCoarser(const CoarsePart& a, const CoarsePart& b) { return a.spacing * b.size > b.spacing * a.size; }

}  // namespace

double fineSize(std::vector<double> sizes)
{
    const std::size_t n = std::min(sizes.size() / 2, sizes.size() / kTinyShare + kTinyCount);
    return nthOf(std::move(sizes), n);
}

glm::dvec3 chooseOrigin(std::span<const Place> places, const glm::dvec3& center)
{
    const double least = fineSize(sizesOf(places));
    const glm::dvec3 median = computeMedian(places, least);
    return reachOf(center, places, least) > kMaxReach * reachOf(median, places, least) ? median : center;
}

std::vector<CoarsePart> findCoarseParts(std::span<const Place> places, const glm::dvec3& origin)
{
    std::map<std::uint32_t, Tally> parts;
    for (const Place& place : places) {
        Tally& tally = parts[place.part];
        const CoarsePart here{place.part, spacingAt(place, origin), place.size};
        tally.count += place.count;
        tally.coarse += here.spacing * kMinSteps > here.size ? place.count : 0.0;
        tally.worst = tally.worst.size == 0.0 || isCoarser(here, tally.worst) ? here : tally.worst;
    }
    std::vector<CoarsePart> coarse;
    for (const auto& [part, tally] : parts) {
        if (tally.coarse >= kCoarseShare * tally.count && tally.coarse > 0.0) {
            coarse.push_back(tally.worst);
        }
    }
    std::stable_sort(coarse.begin(), coarse.end(), isCoarser);
    return coarse;
}

}  // namespace glim
