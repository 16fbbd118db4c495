#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace glim {
namespace {

TEST(StatusTest, CountsAllAndLocatesTheFirst)
{
    Buffer buffer(testDevice(), "status words", BufferKind::Storage, sizeof(Status));
    upload(buffer, std::span<const Status>(std::vector<Status>(1)));
    KernelTest(test_kernels::status_test).buffers({{kBindStatus, &buffer}}).threads(640).run();
    const Status status = download<Status>(buffer, 1)[0];
    EXPECT_EQ(status.flags, 0U) << "no loop was cut short";
    EXPECT_EQ(status.nonFinite, 64U);
    std::set<uint> pixels;
    for (const Located& place : status.located) {
        EXPECT_EQ(place.pixel % 10, 0U);
        EXPECT_EQ(place.sampleIndex, place.pixel + 7);
        pixels.insert(place.pixel);
    }
    EXPECT_EQ(pixels.size(), kMaxLocated) << "each place is another sample";
}

}  // namespace
}  // namespace glim
