#include "host/measure/z_test.hpp"

#include "host/error.hpp"
#include "host/measure/confidence.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// Two correct pictures may differ by the rounding of float32 sums, which is no noise and does not average out: this much,
// relative to the sum of the region's absolute values, is allowed on top. 2^-20 is 16 roundings.
constexpr double kRounding = 0x1p-20;

struct Region {
    glm::dvec3 difference{0.0}, variance{0.0}, magnitude{0.0};
};

void addRegion(Region& sum, const Region& term)
{
    sum.difference += term.difference;
    sum.variance += term.variance;
    sum.magnitude += term.magnitude;
}

double computeZ(const Region& region, int c)
{
    const double excess = std::max(0.0, std::abs(region.difference[c]) - kRounding * region.magnitude[c]);
    return excess == 0 ? 0.0 : std::copysign(excess / std::sqrt(region.variance[c]), region.difference[c]);
}

// A region without noise says nothing about the spread of z.
bool hasNoise(const Region& region, int c) { return std::sqrt(region.variance[c]) > kRounding * region.magnitude[c]; }

Region regionOfPixel(const Picture& picture, const Picture& reference, std::size_t i)
{
    const glm::dvec3 x(picture.radiance[i]), r(reference.radiance[i]);
    return {x - r, glm::dvec3(picture.variance[i]) + glm::dvec3(reference.variance[i]), glm::abs(r)};
}

bool isKnown(const Picture& picture, std::size_t i) { return isFinite(picture.radiance[i]) && isFinite(picture.variance[i]); }

void addBlock(ZTest& test, const Region& block, std::uint32_t x, std::uint32_t y)
{
    for (int c = 0; c < 3; ++c) {
        const std::size_t channel = static_cast<std::size_t>(c);
        const double z = computeZ(block, c);
        if (hasNoise(block, c)) {
            ++test.blocks[channel];
            test.meanSquare[channel] += z * z;
        }
        if (std::abs(z) > std::abs(test.worstZ)) {
            test.worstZ = z;
            test.worstX = x;
            test.worstY = y;
            test.worstChannel = c;
        }
    }
}

Region addBlocks(ZTest& test, const Picture& picture, const Picture& reference)
{
    Region whole;
    for (std::uint32_t top = 0; top < picture.height; top += kBlockSide) {
        for (std::uint32_t left = 0; left < picture.width; left += kBlockSide) {
            Region block;
            for (std::uint32_t y = top; y < std::min(top + kBlockSide, picture.height); ++y) {
                for (std::uint32_t x = left; x < std::min(left + kBlockSide, picture.width); ++x) {
                    const std::size_t i = std::size_t{y} * picture.width + x;
                    if (isKnown(picture, i) && isKnown(reference, i)) {
                        addRegion(block, regionOfPixel(picture, reference, i));
                        ++test.compared;
                    }
                }
            }
            addBlock(test, block, left, top);
            addRegion(whole, block);
        }
    }
    return whole;
}

}  // namespace

bool ZTest::meansAgree() const
{
    return std::all_of(meanZ.begin(), meanZ.end(), [&](double z) { return std::abs(z) <= meanLimit; });
}

bool ZTest::blocksAgree() const { return std::abs(worstZ) <= blockLimit; }

bool ZTest::spreadAgrees() const
{
    for (std::size_t c = 0; c < 3; ++c) {
        if (blocks[c] > 0 && !(std::abs(meanSquare[c] - 1.0) <= meanSquareMargin[c])) {
            return false;
        }
    }
    return true;
}

ZTest zTest(const Picture& picture, const Picture& reference, double alpha)
{
    const std::size_t pixels = reference.radiance.size();
    if (picture.radiance.size() != pixels || picture.variance.size() != pixels || reference.variance.size() != pixels) {
        throw InputError(MessageId::Mismatch, {"A z-test needs two pictures of one size with known variances."});
    }
    ZTest test;
    const Region whole = addBlocks(test, picture, reference);
    if (test.compared == 0) {
        throw InputError(MessageId::Empty, {"No pixel has a finite value and a known variance in both pictures, expected at least one."});
    }
    test.meanLimit = twoSidedLimit(sidakLevel(alpha, 3));
    test.blockLimit = twoSidedLimit(sidakLevel(alpha, test.blocks[0] + test.blocks[1] + test.blocks[2]));
    const double power = twoSidedLimit(2 * 0.05);
    for (int c = 0; c < 3; ++c) {
        const std::size_t channel = static_cast<std::size_t>(c);
        const double count = static_cast<double>(test.blocks[channel]);
        test.meanZ[channel] = computeZ(whole, c);
        if (count > 0) {
            test.meanSquare[channel] /= count;
            test.meanSquareMargin[channel] = 4.0 * std::sqrt(2.0 / count);
        }
        if (whole.magnitude[c] > 0) {
            const double bias = (test.meanLimit + power) * std::sqrt(whole.variance[c]) / whole.magnitude[c];
            test.detectableBias = std::max(test.detectableBias, bias);
        }
    }
    return test;
}

}  // namespace glim
