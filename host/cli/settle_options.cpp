#include "host/cli/settle_options.hpp"

#include "host/cli/parse.hpp"
#include "shaders/shared/limits.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kViewSamples = 4, kMaxSpp = 2048;
constexpr std::uint64_t kMaxCounter = std::uint64_t{1} << 32;  // sample index * light samples + light sample

bool isGiven(const CLI::App& command, const std::string& option) { return command.count(option) > 0; }

[[noreturn]] void refuse(const CLI::App& command, const std::string& option, const std::string& why)
{
    throw CLI::ValidationError(option, "\"" + command.get_option(option)->results().front() + "\": " + why);
}

void refuseIfGiven(const CLI::App& command, std::initializer_list<const char*> options, const std::string& why)
{
    for (const char* option : options) {
        if (isGiven(command, option)) {
            refuse(command, option, why);
        }
    }
}

void settleView(const CLI::App& command, RenderSettings& settings)
{
    if (settings.view == View::Shaded) {
        return;
    }
    const std::string nothing = "means nothing with --view " + command.get_option("--view")->results().front();
    refuseIfGiven(command, {"--bounces", "--direct", "--light-samples", "--paths", "--roulette", "--clamp-indirect"}, nothing);
    refuseIfGiven(command, {"--adaptive", "--rates", "--suspects", "--target-rmse", "--target-relmse"}, nothing);
    if (settings.view != View::Albedo) {
        refuseIfGiven(command, {"--exposure"}, nothing);
    }
    if (settings.view == View::BvhSteps && settings.accelerator == Accelerator::None) {
        refuse(command, "--view", "with --accelerator none there is no BVH; expected --accelerator bvh");
    }
    settings.bounces = 0;
    if (!isGiven(command, "--spp") && !isGiven(command, "--samples")) {
        settings.sampleEnd = kViewSamples;
    }
}

void settleCourse(const CLI::App& command, RenderSettings& settings)
{
    refuseIfGiven(command, {"--spp", "--samples"},
                  "--adaptive course itself chooses the samples; expected --max-spp as their limit");
    if (isGiven(command, "--sampler") && settings.sampler == Sampler::Sobol) {
        refuse(command, "--sampler",
               "the statistics of --adaptive course assume independent samples; expected --sampler independent");
    }
    settings.sampler = Sampler::Independent;
    settings.sampleEnd = isGiven(command, "--max-spp") ? settings.sampleEnd : kMaxSpp;
    if (settings.batch > settings.sampleEnd) {
        refuseIfGiven(command, {"--batch"}, "expected at most --max-spp, which is " + std::to_string(settings.sampleEnd));
        refuse(command, "--max-spp", "expected at least --batch, which is " + std::to_string(settings.batch));
    }
}

// Without another limit, four times the samples that all pixels have alike.
void settleNeighbours(const CLI::App& command, RenderSettings& settings)
{
    refuseIfGiven(command, {"--samples"}, "--adaptive itself chooses the samples; expected --spp as their mean");
    if (isGiven(command, "--spp") && settings.sampleEnd <= kPilotSamples) {
        refuse(command, "--spp", "--adaptive neighbours begins with " + std::to_string(kPilotSamples) +
                                     " samples of every pixel; expected more");
    }
    settings.sampleEnd = isGiven(command, "--spp") ? settings.sampleEnd : 4 * kPilotSamples;
}

void settleAdaptive(const CLI::App& command, RenderSettings& settings)
{
    if (!isCourse(settings.adaptive)) {
        refuseIfGiven(command, {"--tolerance", "--batch", "--max-spp"}, "expected --adaptive course or course:literal with it");
    }
    if (isNeighbours(settings.adaptive)) {
        settleNeighbours(command, settings);
    }
    if (isCourse(settings.adaptive)) {
        settleCourse(command, settings);
    }
}

void settleTime(const CLI::App& command, RenderSettings& settings)
{
    if (settings.seconds && !isCourse(settings.adaptive) && !isGiven(command, "--samples")) {
        settings.sampleEnd = mostSamples(settings);
    }
}

// Any sample, unless the command says which ones there are.
void settleReplay(const CLI::App& command, RenderOptions& options)
{
    if (!options.replay) {
        return;
    }
    refuseIfGiven(command, {"--output", "--png", "--rates", "--progress", "--time", "--suspects", "--target-rmse", "--target-relmse"},
                  "means nothing with --replay, which makes no picture");
    if (options.settings.view != View::Shaded) {
        refuse(command, "--view", "has no paths; expected --view shaded with --replay");
    }
    const bool limited = isGiven(command, "--spp") || isGiven(command, "--samples");
    if (isNeighbours(options.settings.adaptive) || (!limited && options.settings.adaptive == Adaptive::Off)) {
        options.settings.sampleBegin = options.replay->sample;
        options.settings.sampleEnd = options.replay->sample + 1;
    }
}

void checkReplay(const CLI::App& command, const RenderOptions& options)
{
    const RenderSettings& settings = options.settings;
    if (options.replay && (options.replay->sample < settings.sampleBegin || options.replay->sample >= settings.sampleEnd)) {
        refuse(command, "--replay", "expected one of the samples that the other options ask for, " +
                                        std::to_string(settings.sampleBegin) + " to " + std::to_string(settings.sampleEnd - 1));
    }
}

void checkLightSamples(const CLI::App& command, const RenderSettings& settings)
{
    if (settings.direct == DirectLight::Mis || settings.direct == DirectLight::Bsdf) {
        refuseIfGiven(command, {"--light-samples"}, "expected --direct lights or --direct hemisphere with it");
    }
    if (std::uint64_t{settings.sampleEnd} * settings.lightSamples > kMaxCounter) {
        refuse(command, "--light-samples",
               "times " + std::to_string(settings.sampleEnd) + " samples per pixel is more than 2^32; expected at most " +
                   std::to_string(kMaxCounter / settings.sampleEnd));
    }
}

// What would be black whatever the scene.
void checkPaths(const CLI::App& command, const RenderSettings& settings)
{
    const std::uint32_t least = settings.paths == PathParts::Direct ? 1 : settings.paths == PathParts::Indirect ? 2 : 0;
    if (settings.bounces < least) {
        refuseIfGiven(command, {"--bounces"}, "leaves nothing of --paths " + command.get_option("--paths")->results().front() +
                                                  "; expected at least " + std::to_string(least));
    }
}

// Without another limit the target alone ends the render.
void settleTarget(const CLI::App& command, RenderOptions& options)
{
    if (!options.target.isGiven()) {
        return;
    }
    if (isCourse(options.settings.adaptive)) {
        refuseIfGiven(command, {"--target-rmse", "--target-relmse"},
                      "--adaptive course has a rule of its own; expected --adaptive neighbours or off");
    }
    const RenderSettings& settings = options.settings;
    const std::uint32_t least = leastSamplesForError(settings.sampleBegin);
    const bool limited = isGiven(command, "--spp") || isGiven(command, "--samples");
    if (limited && settings.sampleEnd - settings.sampleBegin < least) {
        refuseIfGiven(command, {"--target-rmse", "--target-relmse"},
                      "the error is known from " + std::to_string(least) + " samples on; expected at least as many");
    }
    if (!limited) {
        options.settings.sampleEnd = mostSamples(options.settings);
    }
}

}  // namespace

std::uint32_t mostSamples(const RenderSettings& settings)
{
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(kMaxSample, kMaxCounter / settings.lightSamples));
}

void settlePicture(const CLI::App& command, PictureOptions& options)
{
    settleAdaptive(command, options.settings);
    settleTime(command, options.settings);
    settleLight(command, options);
}

void settleLight(const CLI::App& command, PictureOptions& options)
{
    checkLightSamples(command, options.settings);
    checkPaths(command, options.settings);
    if (options.settings.accelerator == Accelerator::None) {
        refuseIfGiven(command, {"--split"}, "with --accelerator none there is no BVH to split");
    }
}

void settleRender(const CLI::App& command, RenderOptions& options)
{
    settleView(command, options.settings);
    settleAdaptive(command, options.settings);
    settleTime(command, options.settings);
    settleReplay(command, options);
    settleTarget(command, options);
    settleLight(command, options);
    checkReplay(command, options);
    if (options.png && options.rates && options.png->lexically_normal() == options.rates->lexically_normal()) {
        refuse(command, "--rates", "expected another file than that of --png");
    }
}

}  // namespace glim
