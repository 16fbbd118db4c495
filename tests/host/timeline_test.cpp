// The time of an animation in the window.
#include "host/preview/timeline.hpp"
#include "host/preview/lens_control.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

using namespace std::chrono_literals;

const std::vector<Animation> kTwo{{"walk", 2.0}, {"run", 0.5}};

TEST(TimelineTest, PlaysRoundAndRound)
{
    Timeline timeline({"", std::nullopt});
    timeline.enter(kTwo);
    const Timeline::Time start = Timeline::Time::clock::now();
    timeline.advance(start);
    EXPECT_FALSE(timeline.moment().seconds) << "the rest pose stays";
    EXPECT_EQ(timeline.shown().seconds, std::nullopt);
    timeline.toggle(start);
    EXPECT_EQ(timeline.moment().seconds, 0.0);
    timeline.advance(start + 500ms);
    EXPECT_DOUBLE_EQ(*timeline.moment().seconds, 0.5);
    TimeChoices wanted = timeline.choices();
    wanted.speed = 0.5F;
    timeline.choose(wanted, start + 500ms);
    EXPECT_TRUE(timeline.isPlaying());
    timeline.advance(start + 1500ms);
    EXPECT_DOUBLE_EQ(*timeline.moment().seconds, 1.0);
    timeline.advance(start + 4500ms);
    EXPECT_DOUBLE_EQ(*timeline.moment().seconds, 0.5);
    EXPECT_TRUE(timeline.isPlaying());
    timeline.toggle(start + 5s);
    timeline.toggle(start + 10s);
    timeline.advance(start + 11s);
    EXPECT_DOUBLE_EQ(*timeline.moment().seconds, 1.0) << "without the pause";
}

TEST(TimelineTest, EndsWithTheAnimation)
{
    Timeline timeline({"run", 0.25});
    timeline.enter(kTwo);
    EXPECT_EQ(timeline.shown(), (Moment{"1", 0.25}));
    const Timeline::Time start = Timeline::Time::clock::now();
    TimeChoices wanted = timeline.choices();
    wanted.loops = false;
    wanted.plays = true;
    timeline.choose(wanted, start);
    timeline.advance(start + 1s);
    EXPECT_FALSE(timeline.isPlaying());
    EXPECT_EQ(timeline.moment().seconds, 0.5);
    timeline.toggle(start + 2s);
    EXPECT_EQ(timeline.moment().seconds, 0.0) << "from the start again";
}

TEST(TimelineTest, RestsAtATimeThatIsChosen)
{
    Timeline timeline({"", 1.0});
    timeline.enter(kTwo);
    const Timeline::Time start = Timeline::Time::clock::now();
    timeline.toggle(start);
    TimeChoices wanted = timeline.choices();
    wanted.seconds = 1.5;
    timeline.choose(wanted, start);
    EXPECT_FALSE(timeline.isPlaying());
    EXPECT_EQ(timeline.shown(), (Moment{"0", 1.5}));
    wanted = timeline.choices();
    wanted.animation = 1;
    timeline.choose(wanted, start);
    EXPECT_EQ(timeline.moment(), (Moment{"1", 0.0}));
    timeline.rest({"walk", 0.5});
    EXPECT_EQ(timeline.shown(), (Moment{"0", 0.5}));
    wanted = timeline.choices();
    wanted.seconds.reset();
    timeline.choose(wanted, start);
    EXPECT_FALSE(timeline.shown().seconds) << "the rest pose";
}

TEST(TimelineTest, HasOnlyWhatLasts)
{
    Timeline timeline({"", std::nullopt});
    timeline.enter({{"pose", 0.0}});
    EXPECT_TRUE(timeline.isEmpty());
    timeline.enter({kTwo[0]});
    EXPECT_FALSE(timeline.isEmpty());
    timeline.toggle(Timeline::Time::clock::now());
    EXPECT_EQ(timeline.shown(), (Moment{"", 0.0})) << "there is one animation";
    timeline.enter({});
    EXPECT_FALSE(timeline.isPlaying()) << "the file has changed";
}

TEST(LensControlTest, FocusesWhenItOpensUnlessItIsFocused)
{
    LensControl lens({});
    EXPECT_EQ(lens.lens().radius, 0.0F);
    lens.choose({0.1F, 1.0F, false}, 4.0);
    EXPECT_EQ(lens.lens().focalDistance, 4.0F);
    lens.focus(3.0);
    lens.choose({0.0F, 3.0F, false}, 4.0);
    EXPECT_EQ(lens.lens().focalDistance, Lens().focalDistance) << "a pinhole";
    lens.choose({0.2F, 3.0F, false}, 5.0);
    EXPECT_EQ(lens.lens().focalDistance, 3.0F);
    LensControl given({0.1F, 2.0F});
    given.choose({0.2F, 2.0F, false}, 5.0);
    EXPECT_EQ(given.lens().focalDistance, 2.0F);
}

}  // namespace
}  // namespace glim
