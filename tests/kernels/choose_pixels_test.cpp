// The kernel itself, over pixels whose luminances are known.
#include "host/gpu/commands.hpp"
#include "host/render/path_buffers.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/path_types.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/luminance_cases.hpp"
#include "tests/support/parameters_buffer.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim::choose_pixels_test {

constexpr std::uint32_t kWorkgroup = 64;
constexpr std::uint32_t kUntouched = 0xabcdef01;
constexpr float kTolerance = 0.05F;

struct Outcome {
    std::uint32_t count;
    std::vector<std::uint32_t> timesChosen;  // by pixel
    std::size_t strangers = 0;               // entries that are no pixel
    std::size_t beyond = 0;                  // entries written beyond the count
    Status status;
};

Outcome readList(const Buffer& list, std::size_t pixels, const Status& status)
{
    const std::vector<uint> words = download<uint>(list, list.size() / sizeof(uint));
    Outcome outcome{words[0], std::vector<std::uint32_t>(pixels, 0), 0, 0, status};
    for (std::size_t i = 0; 2 * i + 2 < words.size(); ++i) {
        const uint pixel = words[1 + 2 * i], samplesBefore = words[2 + 2 * i];
        if (i >= outcome.count) {
            outcome.beyond += pixel != kUntouched || samplesBefore != kUntouched ? 1 : 0;
        } else if (pixel < pixels && samplesBefore == 0) {
            ++outcome.timesChosen[pixel];
        } else {
            ++outcome.strangers;
        }
    }
    return outcome;
}

// The pixels [begin, begin + luminances - idle) of a picture.
struct Place {
    std::uint32_t width, height, begin;
};

// The last `idle` entries of the luminances are no pixels of the tile.
Outcome choosePixels(const std::vector<LuminanceMoments>& luminances, std::uint32_t constantSamples, std::size_t idle = 100,
                     const Place& place = {20000, 1, 0}, std::uint32_t samples = 0)
{
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    const Kernel kernel(layout, kernels::course_choose_pixels, {{kSpecWorkgroup, kWorkgroup}, {kSpecChosen, 1}});
    PathBuffers paths(testDevice(), 1);
    Buffer given(testDevice(), "test's luminances", BufferKind::Storage, luminances.size() * sizeof(LuminanceMoments));
    upload(given, std::span<const LuminanceMoments>(luminances));
    Buffer list(testDevice(), "test's choice", BufferKind::Storage, (1 + 2 * luminances.size()) * sizeof(uint));
    std::vector<uint> empty(1 + 2 * luminances.size(), kUntouched);
    empty[0] = 0;
    upload(list, std::span<const uint>(empty));
    std::map<std::uint32_t, const Buffer*> bound = paths.buffers(0);
    bound[kBindLuminance] = &given;
    bound[kBindChosenPixels] = &list;
    RenderParameters render = anyParameters();
    render.width = place.width;
    render.height = place.height;
    CourseParameters course{};
    course.tolerance = kTolerance;
    course.constantSamples = constantSamples;
    const Buffer parameters = parametersBuffer(render), courseParameters = parametersBuffer(course);
    bound[kBindParameters] = &parameters;
    bound[kBindCourseParameters] = &courseParameters;
    const Bindings bindings(layout, bound);
    CoursePass push{};
    Pass& pass = push.pass;
    pass.firstSample = samples;
    pass.tileBegin = place.begin;
    pass.pixelCount = static_cast<std::uint32_t>(luminances.size() - idle);
    Commands commands(testDevice());
    const auto groups = static_cast<std::uint32_t>((luminances.size() + kWorkgroup - 1) / kWorkgroup);
    commands.dispatch(kernel, bindings, std::as_bytes(std::span<const CoursePass, 1>(&push, 1)), groups);
    commands.submitAndWait();
    return readList(list, pass.pixelCount, download<Status>(paths.status(), 1)[0]);
}

void expectAList(const Outcome& outcome)
{
    EXPECT_EQ(outcome.strangers, 0U);
    EXPECT_EQ(outcome.beyond, 0U);
    EXPECT_EQ(outcome.status.loopCaps, 0U);
    std::uint32_t chosen = 0;
    for (std::size_t pixel = 0; pixel < outcome.timesChosen.size(); ++pixel) {
        EXPECT_LE(outcome.timesChosen[pixel], 1U) << "pixel " << pixel;
        chosen += outcome.timesChosen[pixel];
    }
    EXPECT_EQ(outcome.count, chosen);
}

TEST(ChoosePixelsTest, ListsThoseThatAreNotAccurate)
{
    for (const std::uint32_t constantSamples : {0U, kConstantSamples}) {
        Random random(70 + constantSamples);
        std::vector<LuminanceMoments> luminances(10103);
        for (LuminanceMoments& luminance : luminances) {
            luminance = anyLuminance(random, kTolerance);
        }
        const Outcome outcome = choosePixels(luminances, constantSamples);
        expectAList(outcome);
        std::size_t undecided = 0;
        for (std::size_t pixel = 0; pixel < outcome.timesChosen.size(); ++pixel) {
            const std::optional<bool> accurate = isAccurateInDouble(luminances[pixel], kTolerance, constantSamples);
            undecided += accurate ? 0 : 1;
            EXPECT_TRUE(!accurate || outcome.timesChosen[pixel] == (*accurate ? 0 : 1)) << "pixel " << pixel;
        }
        std::cout << "  " << outcome.count << " of " << outcome.timesChosen.size() << " pixels chosen, " << undecided
                  << " left to rounding\n";
        EXPECT_LT(undecided, outcome.timesChosen.size() / 5);
    }
}

TEST(ChoosePixelsTest, ListsNoneOrAll)
{
    const std::vector<LuminanceMoments> black(5000, {2, 0.0F, 0.0F, 2}), fresh(5000, {0, 0.0F, 0.0F});
    const Outcome none = choosePixels(black, 0), all = choosePixels(fresh, 0), cautious = choosePixels(black, kConstantSamples);
    for (const Outcome* outcome : {&none, &all, &cautious}) {
        expectAList(*outcome);
    }
    EXPECT_EQ(none.count, 0U);
    EXPECT_EQ(all.count, 4900U);
    EXPECT_EQ(cautious.count, 4900U);
    EXPECT_EQ(choosePixels(std::vector<LuminanceMoments>(1), 0, 0).count, 1U);
}

// Noisy pixels of 16, 32 and 48 samples, of which the last have all that there have been so far.
TEST(ChoosePixelsTest, PixelsThatWereLeftOutStayOut)
{
    std::vector<LuminanceMoments> luminances;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        luminances.push_back({16 + i % 3 * 16, 0.5F, 100.0F, 1});
    }
    const Outcome outcome = choosePixels(luminances, 0, 0, {20000, 1, 0}, 48);
    expectAList(outcome);
    for (std::size_t pixel = 0; pixel < luminances.size(); ++pixel) {
        EXPECT_EQ(outcome.timesChosen[pixel], luminances[pixel].count == 48 ? 1U : 0U) << pixel;
    }
}

// A tile that begins and ends within rows, with few chosen pixels.
TEST(ChoosePixelsTest, LeavesOutWhatIsEmptyWithItsNeighbours)
{
    constexpr std::uint32_t kWidth = 60, kHeight = 50, kBegin = 130, kEnd = 2930;
    Random random(71);
    std::vector<LuminanceMoments> luminances(kEnd - kBegin);
    for (LuminanceMoments& luminance : luminances) {
        luminance = {32, 0.0F, 0.0F, random.below(20) == 0 ? 1U + random.below(32) : 0U};
    }
    const auto metNothing = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= static_cast<int>(kWidth) || y >= static_cast<int>(kHeight)) {
            return true;
        }
        const std::uint32_t index = static_cast<std::uint32_t>(y) * kWidth + static_cast<std::uint32_t>(x);
        return index >= kBegin && index < kEnd && luminances[index - kBegin].met == 0;
    };
    const Outcome outcome = choosePixels(luminances, kConstantSamples, 0, {kWidth, kHeight, kBegin});
    expectAList(outcome);
    for (std::uint32_t pixel = 0; pixel < luminances.size(); ++pixel) {
        const auto x = static_cast<int>((kBegin + pixel) % kWidth), y = static_cast<int>((kBegin + pixel) / kWidth);
        bool empty = true;
        for (int i = 0; i < 9; ++i) {
            empty = empty && metNothing(x + i % 3 - 1, y + i / 3 - 1);
        }
        EXPECT_EQ(outcome.timesChosen[pixel], empty ? 0U : 1U) << x << ", " << y;
    }
    EXPECT_GT(outcome.count, 500U);
    EXPECT_LT(outcome.count, 2300U);
    std::cout << "  " << outcome.count << " of " << luminances.size() << " pixels chosen\n";
}

}  // namespace glim::choose_pixels_test
