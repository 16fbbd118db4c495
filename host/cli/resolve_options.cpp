#include "host/cli/resolve_options.hpp"

#include "host/cli/parse.hpp"
#include "host/image/picture_file.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kAovSamples = 4, kMaxSpp = 2048;
constexpr std::uint64_t kMaxCounter = std::uint64_t{1} << 32;  // sample index * light samples + light sample

[[noreturn]] void refuse(const Command& command, const std::string& option, const std::string& why)
{
    throw UsageError(option, "\"" + command.textOf(option) + "\": " + why);
}

void refuseIfGiven(const Command& command, std::initializer_list<const char*> options, const std::string& why)
{
    for (const char* option : options) {
        if (command.isGiven(option)) {
            refuse(command, option, why);
        }
    }
}

void resolveAov(const Command& command, RenderSettings& settings)
{
    if (settings.aov == Aov::Radiance) {
        return;
    }
    const std::string nothing = "has no effect with --view " + command.textOf("--view");
    refuseIfGiven(command, {"--bounces", "--direct", "--light-samples", "--paths", "--roulette", "--clamp-indirect", "--caustics"},
                  nothing);
    refuseIfGiven(command, {"--adaptive", "--rates", "--suspects", "--target-rmse", "--target-relmse"}, nothing);
    refuseIfGiven(command, {"--tone"}, nothing);
    if (settings.aov != Aov::Albedo) {
        refuseIfGiven(command, {"--exposure"}, nothing);
    }
    if (settings.aov == Aov::BvhSteps && settings.course.accelerator == Accelerator::None) {
        refuse(command, "--view", "with --accelerator none there is no BVH; expected --accelerator bvh");
    }
    settings.bounces = 0;
    if (!command.isGiven("--spp") && !command.isGiven("--samples")) {
        settings.sampleEnd = kAovSamples;
    }
}

void resolveCourse(const Command& command, RenderSettings& settings)
{
    refuseIfGiven(command, {"--spp", "--samples"}, "--adaptive course itself chooses the samples; expected --max-spp as their limit");
    if (command.isGiven("--sampler") && settings.sampler == Sampler::Sobol) {
        refuse(command, "--sampler", "the statistics of --adaptive course assume independent samples; expected --sampler independent");
    }
    settings.sampler = Sampler::Independent;
    settings.sampleEnd = command.isGiven("--max-spp") ? settings.sampleEnd : kMaxSpp;
    if (settings.course.batch > settings.sampleEnd) {
        refuseIfGiven(command, {"--batch"}, "expected at most --max-spp, which is " + std::to_string(settings.sampleEnd));
        refuse(command, "--max-spp", "expected at least --batch, which is " + std::to_string(settings.course.batch));
    }
}

// The default is four times the samples that every pixel gets first.
void resolveNeighbours(const Command& command, RenderSettings& settings)
{
    refuseIfGiven(command, {"--samples"}, "--adaptive itself chooses the samples; expected --spp as their mean");
    if (command.isGiven("--spp") && settings.sampleEnd <= kPilotSamples) {
        refuse(command, "--spp",
               "--adaptive neighbours begins with " + std::to_string(kPilotSamples) + " samples of every pixel; expected more");
    }
    settings.sampleEnd = command.isGiven("--spp") ? settings.sampleEnd : 4 * kPilotSamples;
}

void resolveAdaptive(const Command& command, RenderSettings& settings)
{
    if (!isCourse(settings.adaptive)) {
        refuseIfGiven(command, {"--tolerance", "--batch", "--max-spp"}, "has an effect only with --adaptive course or course:literal");
    }
    if (isNeighbours(settings.adaptive)) {
        resolveNeighbours(command, settings);
    }
    if (isCourse(settings.adaptive)) {
        resolveCourse(command, settings);
    }
}

void resolveTime(const Command& command, RenderSettings& settings)
{
    if (settings.seconds && !isCourse(settings.adaptive) && !command.isGiven("--samples")) {
        settings.sampleEnd = mostSamples(settings);
    }
}

// Any sample may be replayed, unless other options limit the samples.
void resolveReplay(const Command& command, RenderOptions& options)
{
    if (!options.replay) {
        return;
    }
    refuseIfGiven(
        command,
        {"--output", "--png", "--image", "--rates", "--ids", "--progress", "--time", "--suspects", "--target-rmse", "--target-relmse"},
        "has no effect with --replay, which makes no picture");
    if (options.settings.aov != Aov::Radiance) {
        refuse(command, "--view", "has no light paths to replay; expected --view shaded");
    }
    const bool limited = command.isGiven("--spp") || command.isGiven("--samples");
    if (isNeighbours(options.settings.adaptive) || (!limited && options.settings.adaptive == Adaptive::Off)) {
        options.settings.sampleBegin = options.replay->sample;
        options.settings.sampleEnd = options.replay->sample + 1;
    }
}

void resolveCheckpoint(const Command& command, const RenderOptions& options)
{
    if (!options.checkpoint.isGiven()) {
        refuseIfGiven(command, {"--on-checkpoint"}, "without --checkpoint or --resume there are no checkpoints");
    }
    if (isCourse(options.settings.adaptive)) {
        refuseIfGiven(command, {"--checkpoint", "--resume"},
                      "a pixel of --adaptive course stops by its luminances, which no film holds; expected --adaptive off or neighbours");
    }
    if (options.replay) {
        refuseIfGiven(command, {"--checkpoint", "--resume"}, "has no effect with --replay, which makes no picture");
    }
    if (options.settings.suspects > 0) {
        refuseIfGiven(command, {"--resume"}, "the brightest samples of earlier runs are not kept; expected no --suspects");
    }
}

void checkRows(const Command& command, const RenderSettings& settings)
{
    if (settings.rows) {
        refuseIfGiven(command, {"--adaptive", "--target-rmse", "--target-relmse"}, "looks at the whole picture; expected no --rows");
        refuseIfGiven(command, {"--ids", "--suspects", "--replay"}, "is of the whole picture; expected no --rows");
    }
}

void checkReplay(const Command& command, const RenderOptions& options)
{
    const RenderSettings& settings = options.settings;
    if (options.replay && (options.replay->sample < settings.sampleBegin || options.replay->sample >= settings.sampleEnd)) {
        refuse(command, "--replay",
               "expected one of the samples that the other options ask for, " + std::to_string(settings.sampleBegin) + " to " +
                   std::to_string(settings.sampleEnd - 1));
    }
}

void checkLightSamples(const Command& command, const RenderSettings& settings)
{
    if (settings.course.direct == DirectLight::Mis || settings.course.direct == DirectLight::Bsdf) {
        refuseIfGiven(command, {"--light-samples"}, "has an effect only with --direct lights or --direct hemisphere");
    }
    if (std::uint64_t{settings.sampleEnd} * settings.course.lightSamples > kMaxCounter) {
        refuse(command, "--light-samples",
               "times " + std::to_string(settings.sampleEnd) + " samples per pixel is more than 2^32; expected at most " +
                   std::to_string(kMaxCounter / settings.sampleEnd));
    }
}

// Refuses what would be black in every scene.
void checkPaths(const Command& command, const RenderSettings& settings)
{
    const std::uint32_t least = settings.paths == PathParts::Direct ? 1 : settings.paths == PathParts::Indirect ? 2 : 0;
    if (settings.bounces < least) {
        refuseIfGiven(command, {"--bounces"},
                      "leaves nothing of --paths " + command.textOf("--paths") + "; expected at least " + std::to_string(least));
    }
}

// Without another limit only the target ends the render.
void resolveTarget(const Command& command, RenderOptions& options)
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
    const bool limited = command.isGiven("--spp") || command.isGiven("--samples");
    if (limited && settings.sampleEnd - settings.sampleBegin < least) {
        refuseIfGiven(command, {"--target-rmse", "--target-relmse"},
                      "the error is estimated from " + std::to_string(least) + " samples on; expected at least as many");
    }
    if (!limited) {
        options.settings.sampleEnd = mostSamples(options.settings);
    }
}

void resolveDenoise(const Command& command, RenderOptions& options)
{
    if (!options.target.isGiven()) {
        refuseIfGiven(command, {"--denoised"}, "says what --target-rmse or --target-relmse is of; expected one of them");
    }
    if (!options.denoise) {
        return;
    }
    const RenderSettings& settings = options.settings;
    if (settings.aov != Aov::Radiance) {
        refuse(command, "--view", "has next to no noise; expected no --denoise");
    }
    if (settings.adaptive != Adaptive::Off) {
        refuse(command, "--adaptive", "gives pixels samples that are no two independent halves, which --denoise needs");
    }
    refuseIfGiven(command, {"--rows"}, "has no rows around it, which --denoise needs; expected the whole picture");
    refuseIfGiven(command, {"--checkpoint", "--resume"}, "keeps no halves of the samples, which --denoise needs");
    refuseIfGiven(command, {"--replay"}, "makes no picture; expected no --denoise");
    const std::uint32_t least = leastSamplesForError(settings.sampleBegin), samples = settings.sampleEnd - settings.sampleBegin;
    if (samples < least) {
        refuse(command, command.isGiven("--samples") ? "--samples" : "--spp",
               "--denoise needs two blocks of samples; expected " + std::to_string(least) + " or more");
    }
    options.settings.halves = true;
}

// Whether two outputs are one file, at least with some number: a#.exr and a##.exr are with 10.
bool mayBeSame(const std::filesystem::path& a, const std::filesystem::path& b)
{
    const auto withoutRun = [](const std::filesystem::path& path) {
        std::string name = path.lexically_normal().string();
        name.erase(std::unique(name.begin(), name.end(), [](char x, char y) { return x == '#' && y == '#'; }), name.end());
        return name;
    };
    return withoutRun(a) == withoutRun(b);
}

// The options that name the files of a picture.
constexpr const char* kOutputs[] = {"--output", "--png", "--image", "--rates", "--ids", "--stats"};

void checkNames(const Command& command)
{
    for (const char* output : kOutputs) {
        if (!command.isGiven(output)) {
            continue;
        }
        const std::string name = std::filesystem::path(command.textOf(output)).filename().string();
        const std::size_t begin = name.find('#');
        if (begin == std::string::npos || name.find('#', name.find_first_not_of('#', begin)) != std::string::npos) {
            refuse(command, output, "names one file for several pictures; expected one run of # in its name, as in out.####.exr");
        }
    }
}

void checkImage(const Command& command, const RenderOptions& options)
{
    const std::optional<std::filesystem::path>& image = options.pictures.image;
    if (image &&
        ((options.pictures.png && mayBeSame(*image, *options.pictures.png)) || (options.rates && mayBeSame(*image, *options.rates)))) {
        refuse(command, "--image", "expected another file than those of --png and --rates");
    }
    const std::uint32_t longest = image ? longestSide(*pictureKindOf(*image)) : kMaxSide;
    if (options.size && std::max(options.size->x, options.size->y) > longest) {
        refuse(command, "--image",
               "files of this kind hold at most " + std::to_string(longest) + " pixels a side; expected a smaller --size");
    }
}

void resolveSequence(const Command& command, const RenderOptions& options)
{
    if (!isSequence(options.sequence, options)) {
        return;
    }
    if (options.camera == "all") {
        refuseIfGiven(command, {"--frames", "--look-from"}, "has one camera; expected its name or index as --camera");
    }
    if (options.replay) {
        refuse(command, "--replay", "expected the options of one picture");
    }
    checkNames(command);
}

}  // namespace

void resolveAnimation(const Command& command, bool hasTime)
{
    if (!hasTime) {
        refuseIfGiven(command, {"--animation"}, "without a time nothing is played; expected --at");
    }
}

std::uint32_t mostSamples(const RenderSettings& settings)
{
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(kMaxSample, kMaxCounter / settings.course.lightSamples));
}

void resolvePicture(const Command& command, PictureOptions& options)
{
    resolveAnimation(command, options.at.has_value());
    resolveAdaptive(command, options.settings);
    resolveTime(command, options.settings);
    resolveLight(command, options);
}

void resolveLight(const Command& command, PictureOptions& options)
{
    checkLightSamples(command, options.settings);
    checkPaths(command, options.settings);
    if (options.settings.course.accelerator == Accelerator::None) {
        refuseIfGiven(command, {"--split"}, "with --accelerator none there is no BVH to split");
    }
}

void resolveRender(const Command& command, RenderOptions& options)
{
    resolveAnimation(command, options.at || options.sequence.frames);
    resolveSequence(command, options);
    resolveAov(command, options.settings);
    resolveAdaptive(command, options.settings);
    resolveTime(command, options.settings);
    resolveReplay(command, options);
    resolveTarget(command, options);
    resolveLight(command, options);
    checkReplay(command, options);
    resolveCheckpoint(command, options);
    resolveDenoise(command, options);
    checkRows(command, options.settings);
    resolvePictureFiles(command, options.pictures);
    checkImage(command, options);
    if (options.pictures.png && options.rates && mayBeSame(*options.pictures.png, *options.rates)) {
        refuse(command, "--rates", "expected another file than that of --png");
    }
    if (options.ids && mayBeSame(*options.ids, options.output)) {
        refuse(command, "--ids", "expected another file than that of --output");
    }
}

}  // namespace glim
