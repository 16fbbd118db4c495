// Each option of `render` stores its value. Options that do not go together are refused with the option, its value and a reason.
#include "host/job/render_job.hpp"
#include "host/cli/command.hpp"
#include "host/job/parse.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <sstream>

namespace glim {
namespace {

// "render x.gltf -o x.exr" with `options`, words separated by spaces.
RenderJob parse(const std::string& options)
{
    CommandLine line("", "", "");
    RenderJob parsed;
    addJobOptions(line.addCommand("render", ""), parsed);
    std::vector<std::string> words{"render", "x.gltf"};
    if (options.find("--replay") == std::string::npos) {
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

void expectRefused(const std::string& options, const std::string& part)
{
    try {
        parse(options);
        ADD_FAILURE() << options << ": was taken, expected a message with: " << part;
    } catch (const UsageError& error) {
        const std::string sentence = error.what();
        EXPECT_NE(sentence.find(part), std::string::npos) << options << ": " << sentence << "\nlacks: " << part;
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    }
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
    for (const std::string text : {"fixed:1.2", "fixed:0", "fixed:-0.5", "fixed:", "fixed:nan", "fixed:inf", "fixed:0.5x", "fixed:1e-40",
                                   "fixed", "fixd", "0.7", "Fixed:0.7", ":0.7"}) {
        expectRefused("--roulette " + text, "--roulette: \"" + text + "\": expected throughput, none or fixed:P with 0 < P <= 1");
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
    expectRefused("--spp 65537 --direct hemisphere --light-samples 65536",
                  "--light-samples: \"65536\": times 65537 samples per pixel is more than 2^32; expected at most 65535");
    expectRefused("--time 1 --samples 0:65537 --direct lights --light-samples 65536", "expected at most 65535");
    expectRefused("--adaptive course --max-spp 131072 --direct lights --light-samples 40000", "expected at most 32768");
}

TEST(RenderJob, WhatDoesNotGoTogetherIsRefused)
{
    // The option that is refused, its value, and what the sentence must name besides.
    const std::vector<std::array<std::string, 4>> cases{
        {"--light-samples 1", "--light-samples", "1", "--direct lights or --direct hemisphere"},
        {"--light-samples 4 --direct mis", "--light-samples", "4", "--direct lights"},
        {"--light-samples 4 --direct bsdf", "--light-samples", "4", "--direct lights"},
        {"--split sah --accelerator none", "--split", "sah", "--accelerator none"},
        {"--view bvh-steps --accelerator none", "--view", "bvh-steps", "--accelerator bvh"},
        {"--tolerance 0.1", "--tolerance", "0.1", "--adaptive course"},
        {"--batch 64", "--batch", "64", "--adaptive course"},
        {"--max-spp 64 --adaptive neighbours", "--max-spp", "64", "--adaptive course"},
        {"--max-spp 64 --adaptive off", "--max-spp", "64", "--adaptive course"},
        {"--adaptive neighbours --spp 64", "--spp", "64", "expected more"},
        {"--adaptive neighbours --samples 0:128", "--samples", "0:128", "expected --spp"},
        {"--adaptive course --spp 64", "--spp", "64", "expected --max-spp"},
        {"--adaptive course --samples 0:64", "--samples", "0:64", "expected --max-spp"},
        {"--adaptive course --sampler sobol", "--sampler", "sobol", "expected --sampler independent"},
        {"--adaptive course --batch 4096", "--batch", "4096", "--max-spp, which is 2048"},
        {"--adaptive course --batch 64 --max-spp 32", "--batch", "64", "--max-spp, which is 32"},
        {"--adaptive course --max-spp 31", "--max-spp", "31", "--batch, which is 32"},
        {"--image a.png --rates a.png", "--image", "a.png", "--rates"},
        {"--image a.png --rates ./a.png", "--image", "a.png", "--rates"},
        {"--ids x.exr", "--ids", "x.exr", "--output"},
        {"--ids ./x.exr", "--ids", "./x.exr", "--output"}};
    for (const auto& [options, option, value, other] : cases) {
        expectRefused(options, option + ": \"" + value + "\": ");
        expectRefused(options, other);
    }
    expectRefused("--lens-radius 0.1", "--lens-radius requires --focal-distance");
    expectRefused("--focal-distance 3", "--focal-distance requires --lens-radius");
}

TEST(RenderJob, ViewsRefuseWhatHasNoMeaningThere)
{
    const std::vector<std::string> meaningless{"--bounces 3",        "--direct lights", "--light-samples 2",
                                               "--paths direct",     "--roulette none", "--adaptive course",
                                               "--clamp-indirect 1", "--rates r.png",   "--adaptive off"};
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        for (const std::string& option : meaningless) {
            const std::string name = option.substr(0, option.find(' ')), value = option.substr(name.size() + 1);
            expectRefused("--view " + view + " " + option, name + ": \"" + value + "\": has no effect with --view " + view);
        }
    }
    for (const std::string view : {"normal", "depth", "bvh-steps"}) {
        expectRefused("--image p.png --exposure 1 --view " + view, "--exposure: \"1\": has no effect with --view " + view);
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
    expectRefused("--exposure 1", "--exposure: \"1\": is of a picture; expected --image with it");
    expectRefused("--tone agx --rates r.png", "--tone: \"agx\": is of a picture; expected --image with it");
    expectRefused("--image p.png --tone aces", "--tone: \"aces\": expected none or neutral or agx");
    expectRefused("--image p.png --exposure full", "--exposure: \"full\": expected a number from -100 to 100, or auto");
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        expectRefused("--image p.png --tone agx --view " + view, "--tone: \"agx\": has no effect with --view " + view);
    }
    for (const std::string name : {"p.gif", "p", "p.exr"}) {
        expectRefused("--image " + name, "--image: \"" + name + "\": expected a name that ends in .png, .jpg, .jpeg or .webp");
    }
    expectRefused("--image p#.png --png p##.png",
                  "--image: \"p##.png\": expected another file than those of --rates and of another --image");
    expectRefused("--image p.png --rates p.png", "--image: \"p.png\": expected another file");
    expectRefused("--image p.webp --size 16384x4",
                  "--image: \"p.webp\": files of this kind hold at most 16383 pixels a side; expected a smaller --size");
    EXPECT_EQ(parse("--image p.webp --size 16383x4").size->x, 16383U);
    expectRefused("--image p.jpg --replay 0,0,1", "--image: \"p.jpg\": has no effect with --replay");
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
    const std::string among = "expected one of the samples that the other options ask for, ";
    expectRefused("--replay 0,0,9 --spp 9", "--replay: \"0,0,9\": " + among + "0 to 8");
    expectRefused("--replay 0,0,7 --samples 8:10", among + "8 to 9");
    expectRefused("--replay 0,0,10 --samples 8:10", among + "8 to 9");
    expectRefused("--replay 0,0,2048 --adaptive course", among + "0 to 2047");
    expectRefused("--replay 0,0,131072 --direct lights --light-samples 32768", "is more than 2^32");
}

TEST(RenderJob, ReplaysRefuseOptionsOfPictures)
{
    for (const std::string option :
         {"--output x.exr", "--image p.png", "--rates r.png", "--ids i.exr", "--progress json", "--time 1", "--suspects 3"}) {
        const std::string name = option.substr(0, option.find(' ')), value = option.substr(name.size() + 1);
        expectRefused("--replay 1,2,3 " + option, name + ": \"" + value + "\": has no effect with --replay");
    }
    expectRefused("--replay 1,2,3 --view normal", "--view: \"normal\": has no light paths to replay; expected --view shaded");
    EXPECT_TRUE(parse("--replay 1,2,3 --view shaded").replay);
    for (const std::string place :
         {"1,2", "1,2,3,4", "1,,3", "a,2,3", "1,2,", "-1,2,3", "1.5,2,3", "65535,0,0", "0,65535,0", "0,0,2147483648", "+1,2,3"}) {
        expectRefused("--replay " + place, "--replay: \"" + place + "\": expected X,Y,SAMPLE with whole numbers");
    }
    for (const std::string view : {"normal", "depth", "albedo", "bvh-steps"}) {
        expectRefused("--suspects 3 --view " + view, "--suspects: \"3\": has no effect with --view " + view);
    }
    EXPECT_EQ(settings("--suspects 1000").suspects, 1000U);
    EXPECT_EQ(settings("").suspects, 0U);
}

TEST(RenderJob, NonsenseValuesAreRefused)
{
    for (const std::string option :
         {"--direct", "--paths", "--accelerator", "--split", "--adaptive", "--view", "--sampler", "--intersector"}) {
        expectRefused(option + " nonsense", option + ": \"nonsense\": expected ");
    }
    for (const std::string option :
         {"--light-samples 0",    "--light-samples 65537", "--light-samples 1.5", "--tolerance 0",        "--tolerance -1",
          "--tolerance nan",      "--tolerance 2e6",       "--batch 1",           "--batch 1048577",      "--max-spp 1",
          "--max-spp 2147483649", "--suspects 0",          "--suspects 1001",     "--suspects all",       "--lens-radius -1",
          "--lens-radius nan",    "--lens-radius inf",     "--focal-distance 0",  "--focal-distance nan", "--focal-distance inf"}) {
        const std::string name = option.substr(0, option.find(' ')), value = option.substr(name.size() + 1);
        expectRefused(option, name + ": \"" + value + "\": expected a ");
    }
}

}  // namespace
}  // namespace glim
