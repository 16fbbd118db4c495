// The media that a path is in, against a list of them.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::media_test {

struct Case {
    uint media, medium, entered, left, innermost, full, inside;
};

constexpr std::size_t kMax = 4;

// The innermost first.
uint packed(const std::vector<uint>& list, uint wavelength)
{
    uint word = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        word |= list[i] << (7 * i);
    }
    return word | wavelength;
}

std::vector<uint> entered(std::vector<uint> list, uint medium)
{
    list.insert(list.begin(), medium);
    list.resize(std::min(list.size(), kMax));
    return list;
}

std::vector<uint> left(std::vector<uint> list, uint medium)
{
    const auto found = std::find(list.begin(), list.end(), medium);
    if (found != list.end()) {
        list.erase(found);
    }
    return list;
}

// Walks in and out of few media, so that they overlap and some are entered twice, and of many, so that the list is full.
TEST(MediaTest, FollowsAList)
{
    Random random(4);
    std::vector<Case> cases;
    std::size_t full = 0, twice = 0;
    for (int walk = 0; walk < 2000; ++walk) {
        const uint wavelength = random.below(2) << 31U, kinds = walk % 2 == 0 ? 3 : 127;
        std::vector<uint> list;
        for (int step = 0; step < 20; ++step) {
            const bool known = !list.empty() && random.below(2) == 0;
            const uint medium = known ? list[random.below(static_cast<uint>(list.size()))] : 1 + random.below(kinds);
            const std::ptrdiff_t times = std::count(list.begin(), list.end(), medium);
            cases.push_back({packed(list, wavelength), medium, packed(entered(list, medium), wavelength),
                             packed(left(list, medium), wavelength), list.empty() ? 0U : list[0], list.size() == kMax ? 1U : 0U,
                             times > 0 ? 1U : 0U});
            full += cases.back().full;
            twice += times > 1 ? 1 : 0;
            list = random.below(5) < 3 ? entered(list, medium) : left(list, medium);
        }
    }
    EXPECT_GT(full, 1000U);
    EXPECT_GT(twice, 1000U);
    KernelTest(test_kernels::media_test).cases(cases).run();
}

}  // namespace glim::media_test
