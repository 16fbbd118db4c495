// Each option of `render` stores its value. Options that do not go together are refused with the option, its value and a reason.
#include "host/job/render_job.hpp"
#include "host/cli/command.hpp"
#include "host/job/parse.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace glim {
namespace {

using test::Parts;

// "render x.gltf -o x.exr" with `options`, words separated by spaces; they may name another output.
RenderJob parse(const std::string& options)
{
    CommandLine line("", "", "");
    RenderJob parsed;
    addJobOptions(line.addCommand("render", ""), parsed);
    std::vector<std::string> words{"render", "x.gltf"};
    if (options.find("--replay") == std::string::npos && options.find("-o ") == std::string::npos) {
        words.insert(words.end(), {"-o", "x.exr"});
    }
    std::istringstream stream(options);
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    line.run(words);
    return parsed;
}

RenderSettings settings(const std::string& options) { return parse(options).settings; }

void expectRefused(const std::string& options, MessageId id, const Parts& parts)
{
    SCOPED_TRACE(options);
    test::expectRefusal<UsageError>([&options] { parse(options); }, id, parts);
}

// What is refused of "--option value" is that option, for that value.
Parts partsOf(const std::string& option)
{
    const std::size_t space = option.find(' ');
    return {.place = option.substr(0, space), .value = option.substr(space + 1)};
}

TEST(RenderJob, DefaultsAreThoseOfTheSettings)
{
    const RenderJob options = parse("");
    EXPECT_EQ(describeSettings(options.settings), describeSettings(RenderSettings()));
    EXPECT_EQ(options.settings.sampleBegin, 0U);
    EXPECT_EQ(options.settings.sampleEnd, 64U);
    EXPECT_EQ(options.settings.course.accelerator, Accelerator::Bvh);
    EXPECT_EQ(options.split, SplitRule::Sah);
    EXPECT_EQ(options.lens.radius, 0.0F);
    EXPECT_FALSE(options.settings.seconds || !options.pictures.empty() || options.rates || options.stats);
}

TEST(RenderJob, LightIsFoundAsAsked)
{
    EXPECT_EQ(settings("--direct mis").course.direct, DirectLight::Mis);
    EXPECT_EQ(settings("--direct lights").course.direct, DirectLight::Lights);
    EXPECT_EQ(settings("--direct hemisphere").course.direct, DirectLight::Hemisphere);
    EXPECT_EQ(settings("--direct bsdf").course.direct, DirectLight::Bsdf);
    EXPECT_EQ(settings("--direct lights --light-samples 1").course.lightSamples, 1U);
    EXPECT_EQ(settings("--direct lights --light-samples 65536").course.lightSamples, 65536U);
    EXPECT_EQ(settings("--light-samples 7 --direct hemisphere").course.lightSamples, 7U);
    EXPECT_EQ(settings("--paths all").paths, PathParts::All);
    EXPECT_EQ(settings("--paths emission").paths, PathParts::Emission);
    EXPECT_EQ(settings("--paths direct").paths, PathParts::Direct);
    EXPECT_EQ(settings("--paths indirect").paths, PathParts::Indirect);
    EXPECT_EQ(settings("--sampler independent").sampler, Sampler::Independent);
    EXPECT_EQ(settings("--bounces 3").bounces, 3U);
}

TEST(RenderJob, RouletteHasItsProbability)
{
    EXPECT_EQ(settings("--roulette throughput").course.roulette, Roulette::Throughput);
    EXPECT_EQ(settings("--roulette none").course.roulette, Roulette::None);
    for (const auto& [text, survival] : {std::pair("0.7", 0.7F), {"1", 1.0F}, {"1e-3", 1e-3F}, {".5", 0.5F}}) {
        const RenderSettings found = settings(std::string("--roulette fixed:") + text);
        EXPECT_EQ(found.course.roulette, Roulette::Fixed);
        EXPECT_EQ(found.course.survival, survival);
    }
    for (const std::string text : {"fixed:1.2", "fixed:0", "fixed:-0.5", "fixed:nan", "fixed:inf", "fixed:1e-40"}) {
        expectRefused("--roulette " + text, MessageId::OutOfRange, {.place = "--roulette", .value = text, .expected = "0 < P <= 1"});
    }
    for (const std::string text : {"fixed:", "fixed:0.5x", "fixed", "fixd", "0.7", "Fixed:0.7", ":0.7"}) {
        expectRefused("--roulette " + text, MessageId::Malformed, {.place = "--roulette", .value = text, .expected = "fixed:P"});
    }
}

TEST(RenderJob, RaysAreTracedAsAsked)
{
    EXPECT_EQ(settings("--accelerator none").course.accelerator, Accelerator::None);
    EXPECT_EQ(settings("--accelerator bvh --split sah").course.accelerator, Accelerator::Bvh);
    EXPECT_EQ(parse("--split mean").split, SplitRule::Mean);
    EXPECT_EQ(parse("--split median").split, SplitRule::Median);
    EXPECT_EQ(settings("").schedule, Schedule::Auto);
    EXPECT_EQ(settings("--schedule wavefront").schedule, Schedule::Wavefront);
    EXPECT_EQ(settings("--schedule persistent").schedule, Schedule::Persistent);
    EXPECT_EQ(settings("--intersector moller-trumbore").course.intersector, Intersector::MollerTrumbore);
    const Lens lens = parse("--lens-radius 0.25 --focal-distance 7.5").lens;
    EXPECT_EQ(lens.radius, 0.25F);
    EXPECT_EQ(lens.focalDistance, 7.5F);
    EXPECT_EQ(parse("--lens-radius 0.25 --focus 12,7").focus, glm::uvec2(12, 7));
}

TEST(RenderJob, AdaptiveRendersTakeIndependentSamplesUpToALimit)
{
    const RenderSettings plain = settings("--adaptive course");
    EXPECT_EQ(plain.adaptive, Adaptive::Course);
    EXPECT_EQ(plain.sampler, Sampler::Independent);
    EXPECT_EQ(plain.course.tolerance, 0.05F);
    EXPECT_EQ(plain.course.batch, 32U);
    EXPECT_EQ(plain.sampleBegin, 0U);
    EXPECT_EQ(plain.sampleEnd, 2048U);
    const RenderSettings chosen = settings("--adaptive course:literal --tolerance 0.01 --batch 64 --max-spp 4096 --sampler independent");
    EXPECT_EQ(chosen.adaptive, Adaptive::CourseLiteral);
    EXPECT_EQ(chosen.course.tolerance, 0.01F);
    EXPECT_EQ(chosen.course.batch, 64U);
    EXPECT_EQ(chosen.sampleEnd, 4096U);
    const RenderSettings timed = settings("--adaptive course --time 5");
    EXPECT_EQ(timed.sampleEnd, 2048U);
    EXPECT_EQ(timed.seconds, 5.0);
    EXPECT_EQ(settings("--adaptive course --max-spp 32").sampleEnd, 32U);
    EXPECT_EQ(settings("--adaptive neighbours").sampleEnd, 256U);
    EXPECT_EQ(settings("--adaptive neighbours").sampler, Sampler::Sobol);
    EXPECT_EQ(settings("--adaptive neighbours:absolute --spp 65").adaptive, Adaptive::NeighboursAbsolute);
    EXPECT_EQ(settings("--adaptive neighbours:absolute --spp 65").sampleEnd, 65U);
    EXPECT_EQ(settings("--adaptive neighbours --sampler independent").sampler, Sampler::Independent);
    EXPECT_GT(settings("--adaptive neighbours --time 5").sampleEnd, 1000000U);
    EXPECT_GT(settings("--adaptive neighbours --target-rmse 1%").sampleEnd, 1000000U);
    EXPECT_EQ(settings("--adaptive neighbours --target-rmse 1% --spp 100").sampleEnd, 100U);
    EXPECT_EQ(settings("--adaptive off --spp 16").sampleEnd, 16U);
    EXPECT_EQ(settings("--adaptive off").sampler, Sampler::Sobol);
}

TEST(RenderJob, ViewsTakeFewSamplesAndNoBounce)
{
    for (const auto& [name, aov] :
         {std::pair("normal", Aov::Normal), {"depth", Aov::Depth}, {"albedo", Aov::Albedo}, {"bvh-steps", Aov::BvhSteps}}) {
        const std::string option = std::string("--view ") + name;
        EXPECT_EQ(settings(option).aov, aov);
        EXPECT_EQ(settings(option).bounces, 0U);
        EXPECT_EQ(settings(option).sampleEnd, 4U);
        EXPECT_EQ(settings(option + " --spp 9").sampleEnd, 9U);
        EXPECT_EQ(settings(option + " --samples 8:24").sampleEnd, 24U);
        EXPECT_EQ(settings(option + " --time 2").sampleEnd, kMaxSample);
        EXPECT_EQ(settings(option + " --sampler independent --split mean --image p.png").aov, aov);
    }
    EXPECT_EQ(settings("--view shaded").sampleEnd, 64U);
    EXPECT_EQ(settings("--view shaded --bounces 2").bounces, 2U);
    EXPECT_EQ(parse("--view albedo --png p.png --exposure 1").look.exposure, 1.0);
}

TEST(RenderJob, SampleCountersFitThirtyTwoBits)
{
    EXPECT_EQ(settings("--time 1").sampleEnd, kMaxSample);
    EXPECT_EQ(settings("--time 1 --direct lights --light-samples 2").sampleEnd, kMaxSample);
    EXPECT_EQ(settings("--time 1 --direct lights --light-samples 3").sampleEnd, 1431655765U);
    EXPECT_EQ(settings("--time 1 --direct hemisphere --light-samples 65536").sampleEnd, 65536U);
    EXPECT_EQ(settings("--spp 65536 --direct hemisphere --light-samples 65536").sampleEnd, 65536U);
    expectRefused("--spp 65537 --direct hemisphere --light-samples 65536", MessageId::OutOfRange,
                  {.place = "--light-samples", .value = "65536", .expected = "65535"});
    expectRefused("--time 1 --samples 0:65537 --direct lights --light-samples 65536", MessageId::OutOfRange,
                  {.place = "--light-samples", .value = "65536", .expected = "65535"});
    expectRefused("--adaptive course --max-spp 131072 --direct lights --light-samples 40000", MessageId::OutOfRange,
                  {.place = "--light-samples", .value = "40000", .expected = "32768"});
}

TEST(RenderJob, TheViewOfTheGuideTakesWhatItIsLearnedWith)
{
    const RenderJob job = parse("--view guide --guiding on --bounces 3 --caustics off");
    EXPECT_EQ(job.settings.aov, Aov::Guide);
    EXPECT_EQ(job.settings.bounces, 3U);
    EXPECT_EQ(job.settings.sampleEnd, 4U);
    EXPECT_EQ(settings("--view guide --guiding on").bounces, settings("").bounces);
    expectRefused("--view guide", MessageId::Requires, {{}, "--view", "guide", "--guiding on"});
    expectRefused("--view guide --guiding off", MessageId::Requires, {{}, "--view", "guide", "--guiding on"});
    expectRefused("--view guide --guiding on --adaptive off", MessageId::Conflict, {.place = "--adaptive", .value = "off"});
    expectRefused("--view guide --guiding on --image p.png --exposure 1", MessageId::Conflict, {.place = "--exposure", .value = "1"});
    expectRefused("--view normal --guiding on", MessageId::Conflict, {.place = "--guiding", .value = "on"});
}

TEST(RenderJob, WhatDoesNotGoTogetherIsRefused)
{
    using Id = MessageId;
    struct Case {
        std::string options;
        MessageId id;
        Parts parts;  // the option that is refused, its value, and the other that it does not go with
    };
    const std::vector<Case> cases{
        {"--light-samples 1", Id::Requires, {{}, "--light-samples", "1", "--direct lights or --direct hemisphere"}},
        {"--light-samples 4 --direct mis", Id::Requires, {{}, "--light-samples", "4", "--direct lights"}},
        {"--light-samples 4 --direct bsdf", Id::Requires, {{}, "--light-samples", "4", "--direct lights"}},
        {"--split sah --accelerator none", Id::Conflict, {{}, "--split", "sah"}},
        {"--view bvh-steps --accelerator none", Id::Conflict, {{}, "--view", "bvh-steps", "--accelerator bvh"}},
        {"--tolerance 0.1", Id::Requires, {{}, "--tolerance", "0.1", "--adaptive course"}},
        {"--batch 64", Id::Requires, {{}, "--batch", "64", "--adaptive course"}},
        {"--max-spp 64 --adaptive neighbours", Id::Requires, {{}, "--max-spp", "64", "--adaptive course"}},
        {"--max-spp 64 --adaptive off", Id::Requires, {{}, "--max-spp", "64", "--adaptive course"}},
        {"--adaptive neighbours --spp 64", Id::OutOfRange, {{}, "--spp", "64"}},
        {"--adaptive neighbours --samples 0:128", Id::Conflict, {{}, "--samples", "0:128", "--spp"}},
        {"--adaptive course --spp 64", Id::Conflict, {{}, "--spp", "64", "--max-spp"}},
        {"--adaptive course --samples 0:64", Id::Conflict, {{}, "--samples", "0:64", "--max-spp"}},
        {"--adaptive course --sampler sobol", Id::Conflict, {{}, "--sampler", "sobol", "--sampler independent"}},
        {"--adaptive course --batch 4096", Id::OutOfRange, {{}, "--batch", "4096", "--max-spp, which is 2048"}},
        {"--adaptive course --batch 64 --max-spp 32", Id::OutOfRange, {{}, "--batch", "64", "--max-spp, which is 32"}},
        {"--adaptive course --max-spp 31", Id::OutOfRange, {{}, "--max-spp", "31", "--batch, which is 32"}},
        {"--image a.png --rates a.png", Id::Duplicate, {{}, "--image", "a.png", "--rates"}},
        {"--image a.png --rates ./a.png", Id::Duplicate, {{}, "--image", "a.png", "--rates"}},
        {"--ids x.exr", Id::Duplicate, {{}, "--ids", "x.exr", "--output"}},
        {"--ids ./x.exr", Id::Duplicate, {{}, "--ids", "./x.exr", "--output"}},
        {"--lens-radius 0.1", Id::Requires, {{}, "--lens-radius", {}, "--focal-distance"}},
        {"--lens-radius 0.1", Id::Requires, {{}, "--lens-radius", {}, "--focus"}},
        {"--focal-distance 3", Id::Requires, {{}, "--focal-distance", {}, "--lens-radius"}},
        {"-o x.png --movie x.mp4", Id::Requires, {{}, "--movie", "x.mp4", "--turntable, --frames or --cameras"}},
        {"-o x.#.exr --turntable 3 --movie x.mp4", Id::Requires, {{}, "--movie", "x.mp4", "--image"}},
        {"-o x.#.png --turntable 3 --movie x.avi", Id::UnknownFormat, {{}, "--movie", "x.avi", ".mp4 or .webm"}},
        {"-o x.mp4 --turntable 3", Id::UnknownFormat, {{}, "--output", "x.mp4", "--movie"}},
        {"--fps 3", Id::Requires, {{}, "--fps", {}, "--frames or --movie"}},
        {"--focus 3,4", Id::Requires, {{}, "--focus", {}, "--lens-radius"}},
        {"--focus 3,4 --lens-radius 1 --focal-distance 2", Id::Conflict, {{}, "--focal-distance", "--focus"}},
        {"--focus 3,4 --lens-radius 1 --projection equirectangular", Id::Conflict, {{}, "--lens-radius", "--projection"}},
        {"--focus 3,4 --lens-radius 1 --replay 0,0,1", Id::Conflict, {{}, "--focus", "3,4", "--focal-distance"}},
        {"--focus 65535,4 --lens-radius 1", Id::OutOfRange, {{}, "--focus", "65535,4", "0 to 65534"}},
        {"--focus 3.5,4 --lens-radius 1", Id::Malformed, {{}, "--focus", "3.5,4", "whole numbers"}},
        {"--focus 3 --lens-radius 1", Id::Malformed, {{}, "--focus", "3", "X,Y"}}};
    for (const Case& refused : cases) {
        expectRefused(refused.options, refused.id, refused.parts);
    }
}

TEST(RenderJob, ViewsRefuseWhatHasNoMeaningThere)
{
    const std::vector<std::string> meaningless{"--bounces 3",        "--direct lights", "--light-samples 2",
                                               "--paths direct",     "--roulette none", "--adaptive course",
                                               "--clamp-indirect 1", "--rates r.png",   "--adaptive off"};
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        for (const std::string& option : meaningless) {
            expectRefused("--view " + view + " " + option, MessageId::Conflict, partsOf(option));
        }
    }
    for (const std::string view : {"normal", "depth", "bvh-steps"}) {
        expectRefused("--image p.png --exposure 1 --view " + view, MessageId::Conflict, {.place = "--exposure", .value = "1"});
    }
}

TEST(RenderJob, PicturesHaveALook)
{
    EXPECT_EQ(parse("").look.exposure, 0.0);
    EXPECT_EQ(parse("").look.tone, std::nullopt);
    EXPECT_EQ(parse("--image p.png --exposure auto").look.exposure, std::nullopt);
    EXPECT_EQ(parse("--image p.jpg --exposure +1.5").look.exposure, 1.5);
    EXPECT_EQ(parse("--image p.png --tone none").look.tone, Tone::None);
    EXPECT_EQ(parse("--image p.png --tone neutral").look.tone, Tone::Neutral);
    EXPECT_EQ(parse("--image p.webp --tone agx").look.tone, Tone::Agx);
    EXPECT_EQ(parse("--image p.JPEG --png p.png").pictures, (PictureFiles{"p.JPEG", "p.png"})) << "--png is a former name";
    expectRefused("--exposure 1", MessageId::Requires, {.place = "--exposure", .value = "1", .expected = "--image"});
    expectRefused("--tone agx --rates r.png", MessageId::Requires, {.place = "--tone", .value = "agx", .expected = "--image"});
    expectRefused("--image p.png --tone aces", MessageId::UnknownName,
                  {.place = "--tone", .value = "aces", .expected = "none or neutral or agx"});
    expectRefused("--image p.png --exposure full", MessageId::Malformed,
                  {.place = "--exposure", .value = "full", .expected = "-100 to 100, or auto"});
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        expectRefused("--image p.png --tone agx --view " + view, MessageId::Conflict, {.place = "--tone", .value = "agx"});
    }
    for (const std::string name : {"p.gif", "p", "p.exr"}) {
        expectRefused("--image " + name, MessageId::UnknownFormat,
                      {.place = "--image", .value = name, .expected = ".png, .jpg, .jpeg or .webp"});
    }
    expectRefused("--image p#.png --png p##.png", MessageId::Duplicate, {.place = "--image", .value = "p##.png"});
    expectRefused("--image p.png --rates p.png", MessageId::Duplicate, {.place = "--image", .value = "p.png"});
    expectRefused("--image p.webp --size 16384x4", MessageId::TooLarge, {.place = "--image", .value = "p.webp", .expected = "--size"});
    EXPECT_EQ(parse("--image p.webp --size 16383x4").size->x, 16383U);
    expectRefused("--image p.jpg --replay 0,0,1", MessageId::Conflict, {.place = "--image", .value = "p.jpg"});
}

TEST(RenderJob, APictureOfFewSamplesAloneIsDenoised)
{
    for (const char* options :
         {"-o x.png", "-o x.jpg --image y.webp", "-o x.png --spp 1024", "-o #.png --turntable 3", "-o x.png --size 3840x2160"}) {
        EXPECT_TRUE(parse(options).denoise && parse(options).settings.halves) << options;
    }
    for (const char* options : {"-o x.exr", "-o x.exr --image x.png", "-o x.png --no-denoise", "-o x.png --spp 63", "-o x.png --spp 1025",
                                "-o x.png --time 9", "-o x.png --target-rmse 1%", "-o x.png --view normal", "-o x.png --rows 0:9",
                                "-o x.png --adaptive neighbours --spp 128", "-o x.png --size 8192x2048"}) {
        EXPECT_FALSE(parse(options).denoise || parse(options).settings.halves) << options;
    }
    EXPECT_TRUE(parse("-o x.png --spp 2048 --denoise").denoise);
    expectRefused("-o x.png --denoise --no-denoise", MessageId::Conflict, {.place = "--denoise", .value = "--no-denoise"});
}

TEST(RenderJob, ReplaysTakeTheSamplesThatARenderWouldHave)
{
    const RenderJob any = parse("--replay 3,5,2147483647");
    EXPECT_EQ(any.replay->x, 3U);
    EXPECT_EQ(any.replay->y, 5U);
    EXPECT_EQ(any.replay->sample, 2147483647U);
    for (const std::string render : {"--spp 9", "--samples 8:9", "--adaptive course --max-spp 512 --batch 4", "--direct lights"}) {
        EXPECT_EQ(parse(render + " --stats s.json --replay 0,0,8").replay->sample, 8U);
    }
    const auto expectOutside = [](const std::string& place, const std::string& options, const std::string& samples) {
        expectRefused("--replay " + place + " " + options, MessageId::OutOfRange, {{}, "--replay", place, samples});
    };
    expectOutside("0,0,9", "--spp 9", ", 0 to 8");
    expectOutside("0,0,7", "--samples 8:10", ", 8 to 9");
    expectOutside("0,0,10", "--samples 8:10", ", 8 to 9");
    expectOutside("0,0,2048", "--adaptive course", ", 0 to 2047");
    expectRefused("--replay 0,0,131072 --direct lights --light-samples 32768", MessageId::OutOfRange,
                  {.place = "--light-samples", .value = "32768", .expected = "32767"});
}

TEST(RenderJob, ReplaysRefuseOptionsOfPictures)
{
    for (const std::string option :
         {"--output x.exr", "--image p.png", "--rates r.png", "--ids i.exr", "--progress json", "--time 1", "--suspects 3"}) {
        expectRefused("--replay 1,2,3 " + option, MessageId::Conflict, partsOf(option));
    }
    expectRefused("--replay 1,2,3 --view normal", MessageId::Conflict, {.place = "--view", .value = "normal", .expected = "--view shaded"});
    EXPECT_TRUE(parse("--replay 1,2,3 --view shaded").replay);
    for (const std::string place : {"1,2", "1,2,3,4", "1,,3", "a,2,3", "1,2,", "-1,2,3", "1.5,2,3", "+1,2,3"}) {
        expectRefused("--replay " + place, MessageId::Malformed, {.place = "--replay", .value = place, .expected = "X,Y,SAMPLE"});
    }
    for (const std::string place : {"65535,0,0", "0,65535,0", "0,0,2147483648"}) {
        expectRefused("--replay " + place, MessageId::OutOfRange, {.place = "--replay", .value = place, .expected = "0 to 65534"});
    }
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        expectRefused("--suspects 3 --view " + view, MessageId::Conflict, {.place = "--suspects", .value = "3"});
    }
    EXPECT_EQ(settings("--suspects 1000").suspects, 1000U);
    EXPECT_EQ(settings("").suspects, 0U);
}

TEST(RenderJob, NonsenseValuesAreRefused)
{
    for (const std::string option :
         {"--direct", "--paths", "--accelerator", "--split", "--adaptive", "--view", "--sampler", "--intersector"}) {
        expectRefused(option + " nonsense", MessageId::UnknownName, {.place = option, .value = "nonsense"});
    }
    for (const std::string option :
         {"--light-samples 0", "--light-samples 65537", "--tolerance 0", "--tolerance -1", "--tolerance nan", "--tolerance 2e6",
          "--batch 1", "--batch 1048577", "--max-spp 1", "--max-spp 2147483649", "--suspects 0", "--suspects 1001", "--lens-radius -1",
          "--lens-radius nan", "--lens-radius inf", "--focal-distance 0", "--focal-distance nan", "--focal-distance inf"}) {
        expectRefused(option, MessageId::OutOfRange, partsOf(option));
    }
    for (const std::string option : {"--light-samples 1.5", "--suspects all", "--tolerance 1x", "--batch 0x10"}) {
        expectRefused(option, MessageId::Malformed, partsOf(option));
    }
}

TEST(RenderJob, IntrinsicsSayWhereTheirOriginIs)
{
    const Projection corner = parse("--size 640x480 --intrinsics 600,610,320,240.5").projection;
    const Projection center = parse("--size 640x480 --intrinsics-opencv 600,610,319.5,240").projection;
    ASSERT_TRUE(corner.intrinsics && center.intrinsics);
    EXPECT_EQ(corner.intrinsics->focal, glm::dvec2(600.0, 610.0));
    EXPECT_EQ(corner.intrinsics->center, glm::dvec2(320.0, 240.5));
    EXPECT_EQ(*corner.intrinsics, *center.intrinsics);
    EXPECT_EQ(corner.model, Projection::Model::Straight);
}

TEST(RenderJob, LensesHaveOpenCvsNumbers)
{
    const Projection lens = parse("--distortion 1,2,3,4,5").projection, all = parse("--distortion=-1,2,3,4,5,6,7,8").projection;
    EXPECT_EQ(lens.model, Projection::Model::RadialTangential);
    EXPECT_EQ(lens.distortion, (std::array<double, 8>{1, 2, 3, 4, 5}));
    EXPECT_EQ(all.distortion, (std::array<double, 8>{-1, 2, 3, 4, 5, 6, 7, 8}));
    const Projection fisheye = parse("--fisheye 0.1,0,0,0.2").projection;
    EXPECT_EQ(fisheye.model, Projection::Model::Fisheye);
    EXPECT_EQ(fisheye.distortion, (std::array<double, 8>{0.1, 0, 0, 0.2}));
    EXPECT_EQ(parse("--projection equirectangular").projection.model, Projection::Model::Equirectangular);
    EXPECT_EQ(parse("--shift 0.1,-0.2").projection.shift, glm::dvec2(0.1, -0.2));
}

// The same camera: at (1, 2, 3), looking along +x with +z up.
TEST(RenderJob, PosesNameTheirAxes)
{
    const Pose expected{{1, 2, 3}, {2, 2, 3}, {0, 0, 1}};
    for (const char* options : {"--pose-gltf 0,0,-1,1,-1,0,0,2,0,1,0,3,0,0,0,1", "--pose-gltf 0,0,-1,1,-1,0,0,2,0,1,0,3",
                                "--pose-opencv 0,0,1,1,-1,0,0,2,0,-1,0,3"}) {
        const std::optional<Pose> pose = parse(options).pose;
        ASSERT_TRUE(pose) << options;
        EXPECT_LT(glm::distance(pose->from, expected.from) + glm::distance(pose->at, expected.at) + glm::distance(pose->up, expected.up),
                  1e-12)
            << options;
    }
}

TEST(RenderJob, CamerasThatCannotBeAreRefused)
{
    for (const char* option : {"--intrinsics 1,2,3", "--intrinsics 600,a,320,240", "--distortion 1,2,3", "--distortion 1,2,3,4,5,6",
                               "--fisheye 1,2,3,4,5", "--shift 1", "--pose-gltf 1,2,3", "--intrinsics 600,inf,320,240"}) {
        expectRefused(option, MessageId::Malformed, partsOf(option));
    }
    expectRefused("--intrinsics 0,600,320,240 --size 8x8", MessageId::OutOfRange, {.place = "--intrinsics"});
    // A mirror, a scale and a last row of another kind.
    for (const char* matrix : {"-1,0,0,1,0,1,0,2,0,0,1,3", "2,0,0,1,0,2,0,2,0,0,2,3", "1,0,0,1,0,1,0,2,0,0,1,3,0,0,1,1"}) {
        expectRefused(std::string("--pose-opencv ") + matrix, MessageId::Degenerate, {.place = "--pose-opencv"});
    }
    for (const char* pair : {"--fov 30", "--zoom 2", "--intrinsics-opencv 1,1,1,1", "--projection equirectangular"}) {
        EXPECT_THROW(parse(std::string("--size 8x8 --intrinsics 1,1,1,1 ") + pair), UsageError) << pair;
    }
    EXPECT_THROW(parse("--intrinsics 1,1,1,1"), UsageError);                             // of which picture?
    for (const char* several : {"--turntable 4", "--cameras a.json", "--camera all"}) {  // which would ignore the pose
        EXPECT_THROW(parse(std::string("-o x.##.exr --pose-gltf 1,0,0,1,0,1,0,2,0,0,1,3 ") + several), UsageError) << several;
        EXPECT_NO_THROW(parse(std::string("-o x.##.exr ") + several)) << several;
    }
    EXPECT_THROW(parse("--fisheye 0,0,0,0 --distortion 0,0,0,0"), UsageError);
    EXPECT_THROW(parse("--projection equirectangular --lens-radius 1 --focal-distance 1"), UsageError);
    EXPECT_THROW(parse("--pose-gltf 1,0,0,1,0,1,0,2,0,0,1,3 --look-from 1,1,1 --look-at 0,0,0"), UsageError);
}

}  // namespace
}  // namespace glim
