// Scripts, text, waits and events of the window.
#include "host/error.hpp"
#include "host/image/text.hpp"
#include "host/preview/event_queue.hpp"
#include "host/preview/latency.hpp"
#include "host/preview/script.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace glim {
namespace {

using Kind = ScriptStep::Kind;

std::vector<ScriptStep> read(const std::string& text)
{
    const test::ScratchFolder folder;
    test::writeText(folder / "script", text);
    return readScript(folder / "script");
}

TEST(ScriptTest, ReadsEveryStep)
{
    const std::vector<ScriptStep> steps = read(
        "# a session\n\n0.5 key v\n0 press w\n0 release W  # up again\n1 drag left 1,2 3.5,4\n"
        "0 drag middle 1,2 3,4\n0 scroll -2\n0 click 7,8\n0 resize 30x20\n0 iconify\n0 restore\n"
        "0 samples 16\n0 key space\n0 key escape\n0 key +\n0 close\n");
    ASSERT_EQ(steps.size(), 15U);
    EXPECT_EQ(steps[0].delay, 0.5);
    EXPECT_EQ(steps[0].kind, Kind::Key);
    EXPECT_EQ(steps[0].key, 'V');
    EXPECT_EQ(steps[1].kind, Kind::Press);
    EXPECT_EQ(steps[2].kind, Kind::Release);
    EXPECT_EQ(steps[3].to, glm::dvec2(3.5, 4.0));
    EXPECT_FALSE(steps[3].pan);
    EXPECT_TRUE(steps[4].pan);
    EXPECT_EQ(steps[5].notches, -2.0);
    EXPECT_EQ(steps[6].from, glm::dvec2(7.0, 8.0));
    EXPECT_EQ(steps[7].size, glm::uvec2(30, 20));
    EXPECT_EQ(steps[10].samples, 16U);
    EXPECT_EQ(steps[11].key, ' ');
    EXPECT_EQ(steps[12].key, kEscape);
    EXPECT_EQ(steps[13].key, '+');
    EXPECT_EQ(steps[14].kind, Kind::Close);
}

TEST(ScriptTest, NamesTheLineThatIsBad)
{
    for (const char* line :
         {"key V", "-1 key V", "nan key V", "0", "0 jump", "0 key", "0 key VV", "0 key #", "0 drag right 1,2 3,4", "0 drag left 1,2",
          "0 drag left 1,2 3", "0 scroll up", "0 resize 0x5", "0 resize 1e9x5", "0 samples 0", "0 click 1,2 3", "0 close now"}) {
        test::expectRefusal<InputError>([&] { read(std::string("0 key A\n") + line + "\n"); }, "script, line 2: ");
    }
    test::expectRefusal<InputError>([] { readScript("missing"); }, "missing: the script cannot be read");
}

TEST(TextTest, IsInkOnShade)
{
    const TextBox box = drawText({"Hi", "glim \xc3\xa9"}, 2, 500);
    EXPECT_EQ(box.pixels.size(), std::size_t{box.width} * box.height);
    EXPECT_EQ(box.height, 2U * (2 * 12 + 8));
    const auto ink = std::count(box.pixels.begin(), box.pixels.end(), 255U | 255U << 8);
    EXPECT_GT(ink, 100);
    EXPECT_EQ(ink + std::count(box.pixels.begin(), box.pixels.end(), 150U << 8), std::ssize(box.pixels));
    EXPECT_EQ(std::count(box.pixels.begin(), box.pixels.begin() + 8 * box.width, 255U | 255U << 8), 0) << "a margin";
    EXPECT_TRUE(drawText({}, 1, 100).pixels.empty());
    EXPECT_EQ(drawText({"a\tb"}, 1, 500).width, drawText({"abc\tb"}, 1, 500).width) << "columns";
    EXPECT_EQ(drawText({"caf\xc3\xa9 a\tb\tc"}, 1, 500).pixels, drawText({"caf?? a\tb?c"}, 1, 500).pixels) << "not printable";
    EXPECT_EQ(drawText({"caf\xc3\xa9 a"}, 1, 30).pixels, drawText({"caf??", "a"}, 1, 500).pixels) << "nor where it is cut";
    const TextBox twice = drawText({"glim"}, 2, 500), once = drawText({"glim"}, 1, 500);
    EXPECT_EQ(twice.width, 2 * once.width);
    EXPECT_EQ(std::count(twice.pixels.begin(), twice.pixels.end(), 255U | 255U << 8),
              4 * std::count(once.pixels.begin(), once.pixels.end(), 255U | 255U << 8));
}

TEST(TextTest, GoesOnBelow)
{
    const std::uint32_t width = drawText({"aaa bbb"}, 1, 500).width;
    const TextBox broken = drawText({"aaa bbb ccc ddd"}, 1, width + 5), two = drawText({"aaa bbb", "ccc ddd"}, 1, 500);
    EXPECT_EQ(broken.pixels, two.pixels);
    EXPECT_EQ(drawText({"a longword b"}, 1, 30).height, drawText({"a", "longword", "b"}, 1, 500).height) << "cut where no blank is";
    EXPECT_EQ(drawText({"word"}, 1, 1).pixels, drawText({"word"}, 1, 500).pixels);
}

TEST(LatencyTest, QuantilesAreOfTheWaits)
{
    Latency latency;
    EXPECT_EQ(latency.quantile(0.5), 0.0);
    for (int i = 100; i >= 1; --i) {
        latency.add(i);
    }
    EXPECT_EQ(latency.count(), 100U);
    EXPECT_EQ(latency.quantile(0.5), 50.0);
    EXPECT_EQ(latency.quantile(0.99), 99.0);
    EXPECT_EQ(latency.quantile(1.0), 100.0);
}

TEST(EventQueueTest, KeepsTheOrderAndWaits)
{
    EventQueue queue;
    EXPECT_TRUE(queue.take(0.001).empty());
    std::thread user([&] {
        for (const char key : {'A', 'B', 'C'}) {
            queue.push({Event::Kind::KeyDown, {}, key, {}, {}});
        }
    });
    std::string keys;
    while (keys.size() < 3) {
        for (const Event& event : queue.take(10.0)) {
            keys += event.key;
        }
    }
    user.join();
    EXPECT_EQ(keys, "ABC");
    EXPECT_TRUE(queue.isEmpty());
}

}  // namespace
}  // namespace glim
