// A view that rests is guided, by a guide that is learned in short steps while the window answers.
#include "host/flatten/flatten_scene.hpp"
#include "host/preview/guide_learner.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/preview_fixture.hpp"

namespace glim::test {
namespace {

// The one that rests, the one that has just been moved, and that once it rests.
TEST_F(PreviewTest, AViewThatRestsHasThePictureOfAGuidedRender)
{
    width = 24;
    height = 18;
    const GlimRun session = run("0 samples 8\n0 key P\n0 drag left 5,5 9,6\n0 key C\n0 key P\n0 samples 8\n0 key P\n0 close\n",
                                {"--spp", "8", "--guiding", "on"});
    for (const auto& [number, options] : {std::pair(1, std::string()), {3, " " + firstLine(session.out)}}) {
        const Film expected = render("--spp 8 --guiding on" + options);
        EXPECT_TRUE(sameBits(film(number), expected)) << number;
        EXPECT_EQ(film(number).identity.settings, expected.identity.settings);
        EXPECT_NE(findSetting(expected.identity.settings, "guide"), "");
    }
    EXPECT_EQ(findSetting(film(2).identity.settings, "guide"), "");
}

// A scene and a renderer as the window has them.
struct Learning {
    Learning()
        : settings(squareSettings(32, 8)),
          flat(flattened(scene)),
          camera(flattenCamera(scene.cameras.front(), 1.0F, {})),
          renderer(testDevice(), flat, camera, settings)
    {}

    Scene scene = mixedScene();
    RenderSettings settings;
    FlatScene flat;
    FlatCamera camera;
    Renderer renderer;
};

// Passes of a picture that shares its buffers come in between.
TEST(GuideLearnerTest, LearnsTheSameBetweenPassesOfAPicture)
{
    Learning a;
    GuideLearner learner;
    learner.begin(a.renderer, a.flat, a.camera);
    std::shared_ptr<const Guide> guide;
    while (!guide) {
        EXPECT_TRUE(learner.advance());
        a.renderer.advance();
        guide = learner.take();
    }
    EXPECT_FALSE(learner.isWorking());
    EXPECT_EQ(guide->digest, learnGuide(testDevice(), a.flat, a.camera, a.settings).guide->digest);
    while (a.renderer.advance()) {
    }
    EXPECT_TRUE(sameBits(a.renderer.film(), renderScene(a.scene, a.settings)));
}

TEST(GuideLearnerTest, EndsWithoutAGuideIfItIsCancelled)
{
    Learning a;
    GuideLearner learner;
    learner.begin(a.renderer, a.flat, a.camera);
    for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(learner.advance());
    }
    learner.cancel();
    while (learner.isWorking()) {
        EXPECT_FALSE(learner.advance());
        EXPECT_EQ(learner.take(), nullptr);
    }
    learner.begin(a.renderer, a.flat, a.camera);
    learner.advance();
    learner.end();
    EXPECT_FALSE(learner.isWorking());
    learner.begin(a.renderer, a.flat, a.camera);  // the destructor ends it
}

TEST(GuideLearnerTest, AsksBetweenShortSteps)
{
    Learning a;
    int steps = 0, builds = 0;
    const auto learn = [&](int most) {
        steps = builds = 0;
        double done = 0.0;
        return learnGuide(a.renderer, a.flat, a.camera, a.settings, GuideUse::Always,
                          [&](const LearningPause& pause) {
                              ++(pause.needsDevice ? steps : builds);
                              EXPECT_GE(pause.done, done);
                              EXPECT_LE(pause.done, 1.0);
                              done = pause.done;
                              return steps + builds < most;
                          })
            .guide;
    };
    EXPECT_EQ(learn(4), nullptr);
    EXPECT_EQ(steps + builds, 4) << "asked no more";
    EXPECT_NE(learn(1000000), nullptr);
    EXPECT_GE(builds, 4);
    EXPECT_LE(builds, 7);
    EXPECT_GT(steps, 1024 * 60 / 8192 + builds) << "8192 paths at once, of 60 for each pixel or more";
}

}  // namespace
}  // namespace glim::test
