#include "host/job/resolve_options.hpp"

#include "host/image/picture_file.hpp"
#include "host/job/movie_writer.hpp"
#include "host/job/parse.hpp"
#include "host/render/course.hpp"
#include "host/text.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <span>

namespace glim {
namespace {

constexpr std::uint32_t kAovSamples = 4, kMaxSpp = 2048;
constexpr std::uint64_t kMaxCounter = std::uint64_t{1} << 32;  // sample index * light samples + light sample

[[noreturn]] void refuse(const OptionTable& table, const std::string& option, MessageId id, std::initializer_list<MessagePart> why)
{
    const Message reason(id, why);
    throw UsageError(Message(reason, {part::place(option), ": ", part::quoted(table.toText(option)), ": ", reason.sentence}));
}

void refuseIfGiven(const OptionTable& table, const std::string& option, MessageId id, std::initializer_list<MessagePart> why)
{
    if (table.isGiven(option)) {
        refuse(table, option, id, why);
    }
}

// Options that mean nothing, or cannot be had, where something else is asked for.
template <class Asked>
struct Rule {
    std::vector<const char*> options;
    bool (*excludedBy)(const Asked&);
    MessageId id;
    const char *why, *expected = "";  // {--view} stands for that option's value
    bool isOfFiles = true;            // holds for what --edits says as well
};

bool isOfAov(const PictureOptions& picture) { return picture.settings.aov != Aov::Radiance; }
bool isOfAovWithoutExposure(const PictureOptions& picture) { return isOfAov(picture) && picture.settings.aov != Aov::Albedo; }
bool isOfAovWithoutGuide(const PictureOptions& picture) { return isOfAov(picture) && picture.settings.aov != Aov::Guide; }
bool hasCourseEstimators(const PictureOptions& picture) { return usesCourseEstimators(picture.settings); }
bool isByCourse(const PictureOptions& picture) { return isCourse(picture.settings.adaptive); }
bool isNotByCourse(const PictureOptions& picture) { return !isByCourse(picture); }
bool isByNeighbours(const PictureOptions& picture) { return isNeighbours(picture.settings.adaptive); }
bool isWithoutBvh(const PictureOptions& picture) { return picture.settings.course.accelerator == Accelerator::None; }
bool isOfRows(const PictureOptions& picture) { return picture.settings.rows.has_value(); }
bool hasOneLightSample(const PictureOptions& picture)
{
    return picture.settings.course.direct == DirectLight::Mis || picture.settings.course.direct == DirectLight::Bsdf;
}

const Rule<PictureOptions> kPictureRules[] = {
    {{"--direct", "--light-samples", "--paths", "--roulette", "--clamp-indirect", "--adaptive", "--rates", "--suspects", "--target-rmse",
      "--target-relmse"},
     isOfAov,
     MessageId::Conflict,
     "has no effect with --view {--view}"},
    {{"--tone"}, isOfAov, MessageId::Conflict, "has no effect with --view {--view}", "", false},
    {{"--bounces", "--caustics", "--guiding"}, isOfAovWithoutGuide, MessageId::Conflict, "has no effect with --view {--view}"},
    {{"--guiding"}, hasCourseEstimators, MessageId::Conflict, "the course's estimators have no guide; expected ", "none of them"},
    {{"--exposure"}, isOfAovWithoutExposure, MessageId::Conflict, "has no effect with --view {--view}", "", false},
    {{"--tolerance", "--batch", "--max-spp"},
     isNotByCourse,
     MessageId::Requires,
     "has an effect only with ",
     "--adaptive course or course:literal"},
    {{"--spp", "--samples"},
     isByCourse,
     MessageId::Conflict,
     "--adaptive course itself chooses the samples; expected ",
     "--max-spp as their limit"},
    {{"--samples"}, isByNeighbours, MessageId::Conflict, "--adaptive itself chooses the samples; expected ", "--spp as their mean"},
    {{"--light-samples"}, hasOneLightSample, MessageId::Requires, "has an effect only with ", "--direct lights or --direct hemisphere"},
    {{"--split"}, isWithoutBvh, MessageId::Conflict, "with --accelerator none there is no BVH to split"},
    {{"--checkpoint", "--resume"},
     isByCourse,
     MessageId::Conflict,
     "a film does not store the luminances by which --adaptive course stops pixels; expected ",
     "--adaptive off or neighbours"},
    {{"--target-rmse", "--target-relmse"},
     isByCourse,
     MessageId::Conflict,
     "--adaptive course has a rule of its own; expected ",
     "--adaptive neighbours or off"},
    {{"--adaptive", "--target-rmse", "--target-relmse"}, isOfRows, MessageId::Conflict, "needs the whole picture; expected ", "no --rows"},
    {{"--ids", "--surfaces", "--objects", "--suspects", "--replay"},
     isOfRows,
     MessageId::Conflict,
     "is of the whole picture; expected ",
     "no --rows"},
};

bool isOfCourse(const RenderJob& job) { return hasCourseEstimators(job); }
bool isReplay(const RenderJob& job) { return job.replay.has_value(); }
bool isWithoutCheckpoints(const RenderJob& job) { return !job.checkpoint.isGiven(); }
bool isWithoutTarget(const RenderJob& job) { return !job.target.isGiven(); }
bool isDenoised(const RenderJob& job) { return job.denoise; }
bool listsSuspects(const RenderJob& job) { return job.settings.suspects > 0; }
bool keepsNoFilm(const RenderJob& job) { return !job.output && !job.replay; }
bool isByAllCameras(const RenderJob& job) { return job.camera == "all"; }
bool isAtRest(const RenderJob& job) { return !firstTime(job.sequence, job); }
bool isOnePicture(const RenderJob& job) { return !isSequence(job.sequence, job); }
bool keepsNoPicture(const RenderJob& job) { return job.pictures.empty(); }
bool isReplayOfSequence(const RenderJob& job) { return isReplay(job) && isSequence(job.sequence, job); }

const Rule<RenderJob> kRenderRules[] = {
    {{"--output", "--image", "--movie", "--rates", "--layers", "--ids", "--surfaces", "--objects", "--progress", "--time", "--suspects",
      "--target-rmse", "--target-relmse", "--checkpoint", "--resume"},
     isReplay,
     MessageId::Conflict,
     "has no effect with --replay, which makes no picture"},
    {{"--focus"}, isReplay, MessageId::Conflict, "expected ", "--focal-distance with the number that the render has printed"},
    {{"--shutter"}, isAtRest, MessageId::Requires, "needs a time of an animation; expected ", "--at or --frames"},
    {{"--shutter"}, isOfCourse, MessageId::Conflict, "the course's estimators know no time; expected ", "none of them"},
    {{"--flow"}, isAtRest, MessageId::Requires, "needs a time of an animation; expected ", "--at or --frames"},
    {{"--movie"}, isOnePicture, MessageId::Requires, "is of several pictures; expected ", "--turntable, --frames or --cameras"},
    {{"--movie"}, keepsNoPicture, MessageId::Requires, "is made of pictures, which are kept; expected ", "--image picture.####.png"},
    {{"--replay"}, isReplayOfSequence, MessageId::Conflict, "expected ", "the options of one picture"},
    {{"--frames", "--look-from", "--pose-gltf", "--pose-opencv"},
     isByAllCameras,
     MessageId::Conflict,
     "needs a single camera; expected ",
     "its name or index as --camera"},
    {{"--checkpoint", "--resume"}, keepsNoFilm, MessageId::Requires, "keeps the film in a file; expected ", "--output FILE.exr"},
    {{"--on-checkpoint"}, isWithoutCheckpoints, MessageId::Requires, "without --checkpoint or --resume there are no checkpoints"},
    {{"--resume"}, listsSuspects, MessageId::Conflict, "the brightest samples of earlier runs are not kept; expected ", "no --suspects"},
    {{"--denoised"}, isWithoutTarget, MessageId::Requires, "has no effect without a target; expected ", "--target-rmse or --target-relmse"},
    {{"--rows"}, isDenoised, MessageId::Conflict, "lacks the rows around the band, which --denoise needs; expected ", "the whole picture"},
    {{"--replay"}, isDenoised, MessageId::Conflict, "makes no picture; expected ", "no --denoise"},
};

std::string withValues(const OptionTable& table, std::string why)
{
    for (std::size_t begin = why.find('{'); begin != std::string::npos; begin = why.find('{')) {
        const std::size_t end = why.find('}', begin);
        why.replace(begin, end + 1 - begin, table.toText(why.substr(begin + 1, end - begin - 1)));
    }
    return why;
}

template <class Asked>
void apply(std::span<const Rule<Asked>> rules, const OptionTable& table, const Asked& asked)
{
    for (const Rule<Asked>& rule : rules) {
        for (const char* option : rule.options) {
            if (table.isGiven(option) && (rule.isOfFiles || !table.isByFile(option)) && rule.excludedBy(asked)) {
                refuse(table, option, rule.id, {withValues(table, rule.why), part::expected(rule.expected)});
            }
        }
    }
}

void resolveAov(const OptionTable& table, RenderJob& job)
{
    RenderSettings& settings = job.settings;
    if (settings.aov == Aov::Radiance) {
        return;
    }
    if (settings.aov == Aov::BvhSteps && settings.course.accelerator == Accelerator::None) {
        refuse(table, "--view", MessageId::Conflict,
               {"with --accelerator none there is no BVH; expected ", part::expected("--accelerator bvh")});
    }
    if (settings.aov == Aov::Guide && job.guiding != GuidingChoice::On) {
        refuse(table, "--view", MessageId::Requires, {"shows what paths are guided by; expected ", part::expected("--guiding on")});
    }
    settings.bounces = settings.aov == Aov::Guide ? settings.bounces : 0;  // of the paths that learn
    if (!table.isGiven("--spp") && !table.isGiven("--samples")) {
        settings.sampleEnd = kAovSamples;
    }
}

void resolveCourse(const OptionTable& table, RenderSettings& settings)
{
    if (settings.sampler == Sampler::Sobol) {
        refuseIfGiven(
            table, "--sampler", MessageId::Conflict,
            {"the statistics of --adaptive course assume independent samples; expected ", part::expected("--sampler independent")});
    }
    settings.sampler = Sampler::Independent;
    settings.sampleEnd = table.isGiven("--max-spp") ? settings.sampleEnd : kMaxSpp;
    if (settings.course.batch > settings.sampleEnd) {
        refuseIfGiven(table, "--batch", MessageId::OutOfRange,
                      {"expected ", part::expected("at most --max-spp, which is " + std::to_string(settings.sampleEnd))});
        refuse(table, "--max-spp", MessageId::OutOfRange,
               {"expected ", part::expected("at least --batch, which is " + std::to_string(settings.course.batch))});
    }
}

// The default is four times the samples that every pixel gets first.
void resolveNeighbours(const OptionTable& table, RenderSettings& settings)
{
    if (settings.sampleEnd <= kPilotSamples) {
        refuseIfGiven(table, "--spp", MessageId::OutOfRange,
                      {"--adaptive neighbours begins with ", std::to_string(kPilotSamples), " samples of every pixel; expected ",
                       part::expected("more")});
    }
    settings.sampleEnd = table.isGiven("--spp") ? settings.sampleEnd : 4 * kPilotSamples;
}

void resolveAdaptive(const OptionTable& table, RenderSettings& settings)
{
    if (isNeighbours(settings.adaptive)) {
        resolveNeighbours(table, settings);
    }
    if (isCourse(settings.adaptive)) {
        resolveCourse(table, settings);
    }
}

void resolveTime(const OptionTable& table, RenderSettings& settings)
{
    if (settings.seconds && !isCourse(settings.adaptive) && !table.isGiven("--samples")) {
        settings.sampleEnd = maxSamples(settings);
    }
}

bool hasSampleCount(const OptionTable& table) { return table.isGiven("--spp") || table.isGiven("--samples"); }

// Any sample may be replayed, unless other options limit the samples.
void resolveReplay(const OptionTable& table, RenderJob& job)
{
    if (!job.replay) {
        return;
    }
    if (job.settings.aov != Aov::Radiance) {
        refuse(table, "--view", MessageId::Conflict, {"has no light paths to replay; expected ", part::expected("--view shaded")});
    }
    RenderSettings& settings = job.settings;
    if (isNeighbours(settings.adaptive) || (!hasSampleCount(table) && settings.adaptive == Adaptive::Off)) {
        settings.sampleBegin = job.replay->sample;
        settings.sampleEnd = job.replay->sample + 1;
    }
    if (job.replay->sample < settings.sampleBegin || job.replay->sample >= settings.sampleEnd) {
        refuse(table, "--replay", MessageId::OutOfRange,
               {"expected ", part::expected("one of the samples that the other options ask for, " + std::to_string(settings.sampleBegin) +
                                            " to " + std::to_string(settings.sampleEnd - 1))});
    }
}

void checkLightSamples(const OptionTable& table, const RenderSettings& settings)
{
    if (std::uint64_t{settings.sampleEnd} * settings.course.lightSamples > kMaxCounter) {
        refuse(table, "--light-samples", MessageId::OutOfRange,
               {"times ", std::to_string(settings.sampleEnd), " samples per pixel is more than 2^32; expected ",
                part::expected("at most " + std::to_string(kMaxCounter / settings.sampleEnd))});
    }
}

// Refuses what would be black in every scene.
void checkPaths(const OptionTable& table, const RenderSettings& settings)
{
    const std::uint32_t least = settings.paths == PathParts::Direct ? 1 : settings.paths == PathParts::Indirect ? 2 : 0;
    if (settings.bounces < least) {
        refuseIfGiven(
            table, "--bounces", MessageId::OutOfRange,
            {"leaves nothing of --paths ", table.toText("--paths"), "; expected ", part::expected("at least " + std::to_string(least))});
    }
}

// Without another limit only the target ends the render.
void resolveTarget(const OptionTable& table, RenderJob& job)
{
    if (!job.target.isGiven()) {
        return;
    }
    if (!hasSampleCount(table)) {
        job.settings.sampleEnd = maxSamples(job.settings);
    }
    const std::uint32_t least = minSamplesForError(job.settings.sampleBegin);
    if (job.settings.sampleEnd - job.settings.sampleBegin < least) {
        for (const char* option : {"--target-rmse", "--target-relmse"}) {
            refuseIfGiven(
                table, option, MessageId::OutOfRange,
                {"the error is estimated from ", std::to_string(least), " samples on; expected ", part::expected("at least as many")});
        }
    }
}

// A picture alone is to be looked at, and looks better denoised: measured for 64 samples, the median of twenty scenes has a third of the
// noisy picture's mean squared error, after a third more time (tests/denoising.md). Films and targets are for more samples than
// kMaxSamples.
bool isDenoisedUnasked(const RenderJob& job)
{
    constexpr std::uint32_t kMaxSamples = 1024;
    constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 23U;  // the halves of more take over 2.8 GB
    const RenderSettings& settings = job.settings;
    const std::uint32_t samples = settings.sampleEnd - settings.sampleBegin;
    const std::uint64_t pixels = job.size ? std::uint64_t{job.size->x} * job.size->y : 0;
    return !job.noDenoise && !job.output && !job.pictures.empty() && !job.target.isGiven() && !settings.seconds && !settings.rows &&
           settings.aov == Aov::Radiance && settings.adaptive == Adaptive::Off && samples >= minSamplesForError(settings.sampleBegin) &&
           samples <= kMaxSamples && pixels <= kMaxPixels;
}

void resolveDenoise(const OptionTable& table, RenderJob& job)
{
    job.denoise = job.denoise || isDenoisedUnasked(job);
    if (!job.denoise) {
        return;
    }
    const RenderSettings& settings = job.settings;
    if (settings.aov != Aov::Radiance) {
        refuse(table, "--view", MessageId::Conflict, {"has next to no noise; expected ", part::expected("no --denoise")});
    }
    if (isCourse(settings.adaptive)) {
        refuse(table, "--adaptive", MessageId::Conflict,
               {"stops a pixel by its own samples, and --denoise needs independent halves of them; expected ",
                part::expected("--adaptive neighbours or off")});
    }
    const std::uint32_t least = minSamplesForError(settings.sampleBegin), samples = settings.sampleEnd - settings.sampleBegin;
    if (samples < least) {
        refuse(table, table.isGiven("--samples") ? "--samples" : "--spp", MessageId::OutOfRange,
               {"--denoise needs two blocks of samples; expected ", part::expected(std::to_string(least) + " or more")});
    }
    job.settings.halves = true;
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
constexpr const char* kOutputs[] = {"--output", "--image", "--rates", "--layers", "--ids", "--surfaces", "--objects", "--stats"};

void checkNames(const OptionTable& table, const RenderJob& job)
{
    if (!isSequence(job.sequence, job)) {
        return;
    }
    for (const char* output : kOutputs) {
        for (const OptionValue& value : table.valuesOf(output)) {
            const std::string name = std::filesystem::path(value.text()).filename().string();
            const std::size_t begin = name.find('#');
            if (begin == std::string::npos || name.find('#', name.find_first_not_of('#', begin)) != std::string::npos) {
                throw UsageError(MessageId::Conflict,
                                 {part::place(output), ": ", part::quoted(value.text()), ": names one file for several pictures; expected ",
                                  part::expected("one run of # in its name, as in out.####.exr")});
            }
        }
    }
}

void checkMovieNames(const OptionTable& table, const RenderJob& job)
{
    if (job.output && getMovieFormat(*job.output)) {
        refuse(table, "--output", MessageId::UnknownFormat,
               {"a movie is made of pictures, which are kept; expected ", part::expected("their names, as in turn.####.png, and --movie")});
    }
    if (job.movie && !getMovieFormat(*job.movie)) {
        refuse(table, "--movie", MessageId::UnknownFormat,
               {"expected ", part::expected(std::string("a name that ends in ") + kMovieEndings)});
    }
}

void checkFiles(const OptionTable& table, const RenderJob& job)
{
    resolvePictureFiles(table, job.pictures);
    for (auto file = job.pictures.begin(); file != job.pictures.end(); ++file) {
        const auto isFile = [&file](const std::filesystem::path& other) { return mayBeSame(*file, other); };
        if (std::any_of(job.pictures.begin(), file, isFile) || (job.rates && isFile(*job.rates))) {
            throw UsageError(MessageId::Duplicate, {part::place("--image"), ": ", part::quoted(*file), ": expected ",
                                                    part::expected("another file than those of --rates and of another --image")});
        }
        if (const std::uint32_t longest = longestSide(*getPictureKind(*file)); job.size && std::max(job.size->x, job.size->y) > longest) {
            throw UsageError(MessageId::TooLarge,
                             {part::place("--image"), ": ", part::quoted(*file), ": files of this kind hold at most ",
                              std::to_string(longest), " pixels a side; expected ", part::expected("a smaller --size")});
        }
    }
    const std::pair<const char*, const std::optional<std::filesystem::path>*> others[] = {
        {"--output", &job.output},     {"--layers", &job.layers},   {"--ids", &job.ids},
        {"--surfaces", &job.surfaces}, {"--objects", &job.objects}, {"--stats", &job.stats}};
    for (const auto& [name, file] : others) {
        for (const auto& [other, before] : others) {
            if (file == before) {
                break;
            }
            if (*file && *before && mayBeSame(**file, **before)) {
                refuse(table, name, MessageId::Duplicate, {"expected ", part::expected(std::string("another file than that of ") + other)});
            }
        }
    }
}

}  // namespace

void resolveAnimation(const OptionTable& table, bool hasTime)
{
    if (!hasTime) {
        refuseIfGiven(table, "--animation", MessageId::Requires, {"has no effect without a time; expected ", part::expected("--at")});
    }
}

std::uint32_t maxSamples(const RenderSettings& settings)
{
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(kMaxSample, kMaxCounter / settings.course.lightSamples));
}

void resolvePicture(const OptionTable& table, PictureOptions& picture)
{
    resolveAnimation(table, picture.at.has_value());
    apply<PictureOptions>(kPictureRules, table, picture);
    resolveAdaptive(table, picture.settings);
    resolveTime(table, picture.settings);
    checkLightSamples(table, picture.settings);
    checkPaths(table, picture.settings);
}

void resolveLight(const OptionTable& table, const PictureOptions& picture)
{
    apply<PictureOptions>(kPictureRules, table, picture);
    checkLightSamples(table, picture.settings);
    checkPaths(table, picture.settings);
}

void resolveRender(const OptionTable& table, RenderJob& job)
{
    resolveAnimation(table, job.at || job.sequence.frames);
    checkMovieNames(table, job);
    resolveOutput(job.output, job.pictures);
    apply<PictureOptions>(kPictureRules, table, job);
    apply<RenderJob>(kRenderRules, table, job);
    checkNames(table, job);
    resolveAov(table, job);
    resolveAdaptive(table, job.settings);
    resolveTime(table, job.settings);
    resolveReplay(table, job);
    resolveTarget(table, job);
    checkLightSamples(table, job.settings);
    checkPaths(table, job.settings);
    resolveDenoise(table, job);
    checkFiles(table, job);
}

}  // namespace glim
