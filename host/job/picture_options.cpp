#include "host/job/picture_options.hpp"

#include "host/job/edits_file.hpp"
#include "host/job/parse.hpp"
#include "host/render/prepare_scene.hpp"

#include <cmath>
#include <limits>
#include <tuple>

namespace glim {
namespace {

void addRoulette(OptionTable& table, RenderSettings& settings)
{
    table.add("--roulette", "R", "Russian roulette: throughput, none, or fixed:P, a survival probability [throughput]",
              [&settings](const OptionValue& value) {
                  if (const std::string text = value.text(); text == "throughput" || text == "none") {
                      settings.course.roulette = text == "none" ? Roulette::None : Roulette::Throughput;
                  } else {
                      settings.course.survival = parseSurvival(value);
                      settings.course.roulette = Roulette::Fixed;
                  }
              });
}

void addFloor(OptionTable& table, PictureOptions& options)
{
    const auto floor = [&options]() -> SceneFloor& { return options.floor ? *options.floor : options.floor.emplace(); };
    table.add("--floor", "Y|lowest", "A floor at the height Y, in metres, or at the lowest point of the scene",
              [floor](const OptionValue& value) { floor().height = parseFloorHeight(value); });
    table.add("--floor-color", "R,G,B", "Its colour, linear Rec.709 [0.8,0.8,0.8]",
              [floor](const OptionValue& value) { floor().color = parseReflectance("--floor-color", value); });
    addNumber<float>(table, {"--floor-roughness", "R", "Its roughness; smooth below 0.03", 0.0F, 1.0F, "matte"},
                     [floor](float roughness) { floor().roughness = roughness; });
    addNumber<double>(table, {"--backdrop", "DEG", "A floor that curves up into a wall at DEG right of -z", -360.0, 360.0, "no wall"},
                      [floor](double degrees) { floor().backdrop = degrees; });
    addEnum(table, "--catcher-reflections", "B", "Whether catchers reflect objects and their light: on or off [on]", {"off", "on"},
            options.settings.catcherReflections);
    table.addEach("--catcher", "NAME", "Material that catches shadows on transparency, as floor; repeatable",
                  [&options](const OptionValue& value) { options.catchers.push_back(value.text()); });
}

}  // namespace

void addPicture(OptionTable& table, PictureOptions& options, const std::string& height)
{
    addEdits(table);
    addSceneIndex(table, options.sceneIndex);
    table.addText("--variant", "NAME", "Variant of the file's materials [the file's own materials]", options.variant);
    addAnimation(table, options.at, options.animation);
    table.add("--environment", "E", ".hdr or .exr map, radiance R,G,B, studio or none [the file's, else studio if unlit]",
              [&options](const OptionValue& value) { options.environment = parseEnvironment(value); });
    addNumber<float>(table, {"--environment-rotation", "DEG", "Rotation of the map about the vertical axis", -360.0F, 360.0F, "0"},
                     [&options](float degrees) { options.environmentRotation = degrees; });
    addNumber<float>(table, {"--environment-strength", "F", "Multiplies the radiance of the environment", 0.0F, 1e6F, "1"},
                     [&options](float strength) { options.environmentStrength = strength; });
    addEnum(table, "--environment-background", "B", "Whether the camera sees the environment: on or off [on]", {"off", "on"},
            options.environmentBackground);
    table.add("--sun", "AZIMUTH,ELEVATION,E", "A directional light: degrees right of -z, degrees up, W/m^2",
              [&options](const OptionValue& value) { options.sun = parseSun(value); });
    addEnum(table, "--back-faces", "B", "Back faces of single-sided opaque surfaces: culled or shown [culled]", {"culled", "shown"},
            options.showsBackFaces);
    const auto addRadius = [&table](const char* name, const char* what, std::optional<double>& radius) {
        addNumber<double>(table, {name, "R", what, 1e-9, 1e9, "by the file"}, [&radius](double metres) { radius = metres; });
    };
    addRadius("--point-radius", "Radius of points, in metres", options.pointRadius);
    addRadius("--line-radius", "Radius of lines, in metres", options.lineRadius);
    addFloor(table, options);
    table.addEach("--light-group", "NAME=LIGHT,...|each", "Lights kept apart in the film, by name of light or material; repeatable",
                  [&options](const OptionValue& value) { parseLightGroup(value, options.lightGroups); });
    table.addEach("--set", "POINTER=VALUE", "Set the value at a glTF pointer, as in /materials/paint/alphaCutoff=0.5; repeatable",
                  [&options](const OptionValue& value) { options.edits.push_back(parseEdit(value)); });
    table.addEach("--add", "FILE[@x,y,z]", "Another file's shapes and lights, moved by metres or a matrix; repeatable",
                  [&options](const OptionValue& value) { options.additions.push_back(parseAddition(value)); });
    addTextures(table, options.missingTextures, options.maxTexture);
    table.addFlag("--confine", "Refuse files that the scene names outside of its folder", options.confined);
    table.add("--size", "WxH", "Pixels, each side 1 to 65535 [" + height + " high, width by the camera's aspect ratio]",
              [&options](const OptionValue& value) { options.size = parseSize(value); });
}

void addAnimation(OptionTable& table, std::optional<double>& at, std::string& animation)
{
    addNumber<double>(table, {"--at", "SECONDS", "Time of the file's animation", 0.0, 1e9, "the file's rest pose"},
                      [&at](double seconds) { at = seconds; });
    table.addText("--animation", "NAME|INDEX", "Animation that is played [0]", animation);
}

void addTextures(OptionTable& table, MissingTextures& missing, std::uint32_t& largest)
{
    addEnum(table, "--missing-textures", "T", "Images that cannot be read: refuse the scene, or grey in their place [refuse]",
            {"refuse", "grey"}, missing);
    addNumber<std::uint32_t>(
        table,
        {"--max-texture", "N", "Scale larger images down to N pixels a side or less", 1, kMaxImageSide, std::to_string(kMaxImageSide)},
        [&largest](std::uint32_t pixels) { largest = pixels; });
}

void addSampleCount(OptionTable& table, RenderSettings& settings, const std::string& sppDefault, const std::string& rangeDefault)
{
    const Option spp = addNumber<std::uint32_t>(table, {"--spp", "N", "Samples per pixel", 1, kMaxSample, sppDefault},
                                                [&settings](std::uint32_t count) { settings.sampleEnd = count; });
    const Option samples =
        table.add("--samples", "BEGIN:END",
                  "Sample indices BEGIN to END - 1, for `glim merge`, 0 to " + std::to_string(kMaxSample) + " [" + rangeDefault + "]",
                  [&settings](const OptionValue& value) {
                      std::tie(settings.sampleBegin, settings.sampleEnd) = parseRange("--samples", value, kMaxSample);
                  });
    const Option time = table.add("--time", "TIME", "Stop after this time, at the end of a pass, as in 90s, 5m or 1h [off]",
                                  [&settings](const OptionValue& value) { settings.seconds = parseDuration("--time", value); });
    spp.excludes(time).excludes(samples);
}

void addAdaptive(OptionTable& table, RenderSettings& settings)
{
    addEnum(table, "--adaptive", "RULE", "Adaptive sampling: off, neighbours or neighbours:absolute [off]",
            {"off", "course", "course:literal", "neighbours", "neighbours:absolute"}, settings.adaptive);
}

void addSampler(OptionTable& table, RenderSettings& settings)
{
    addNumber<std::uint32_t>(table, {"--seed", "N", "Seed of the random numbers", 0, std::numeric_limits<std::uint32_t>::max(), "0"},
                             [&settings](std::uint32_t seed) { settings.seed = seed; });
    addEnum(table, "--sampler", "S", "sobol (Owen-scrambled) or independent [sobol; independent with --adaptive course]",
            {"sobol", "independent"}, settings.sampler);
}

void addLightTransport(OptionTable& table, RenderSettings& settings)
{
    table.beginGroup("Light transport");
    addNumber<std::uint32_t>(table, {"--bounces", "N", "Maximum surfaces between camera and light (0: emission alone)", 0, 1000000, "64"},
                             [&settings](std::uint32_t bounces) { settings.bounces = bounces; });
    addEnum(table, "--paths", "PART", "Part of the light: all, emission, direct or indirect [all]",
            {"all", "emission", "direct", "indirect"}, settings.paths);
    addNumber<float>(table, {"--clamp-indirect", "X", "Clamp indirect light to this radiance (biased)", 1e-30F, 1e30F, "off"},
                     [&settings](float limit) { settings.clampIndirect = limit; });
}

void addCaustics(OptionTable& table, CausticsChoice& caustics)
{
    addEnum(table, "--caustics", "C", "Caustics by light paths: on, off or auto, where they have less noise [auto]", {"off", "on", "auto"},
            caustics);
}

void addGuiding(OptionTable& table, GuidingChoice& guiding)
{
    addEnum(table, "--guiding", "G", "Path guiding, learned before the picture: on, off or auto, where it pays [off]",
            {"off", "on", "auto"}, guiding);
}

void addGuidingAtRest(OptionTable& table, GuidingChoice& guiding)
{
    addEnum(table, "--guiding", "G", "Path guiding, learned once the view rests: on or off [off]", {"off", "on"}, guiding);
}

void addCourseEstimators(OptionTable& table, RenderSettings& settings)
{
    table.beginGroup("Course estimators (Berkeley CS 184)");
    addEnum(table, "--direct", "D", "Direct light: mis, lights, hemisphere or bsdf [mis]", {"mis", "lights", "hemisphere", "bsdf"},
            settings.course.direct);
    addNumber<std::uint32_t>(table,
                             {"--light-samples", "N", "Samples per light (--direct lights) or per vertex (hemisphere)", 1, 65536, "1"},
                             [&settings](std::uint32_t count) { settings.course.lightSamples = count; });
    addRoulette(table, settings);
    table.hide({"--direct", "--light-samples", "--roulette"});
}

void addCourseRule(OptionTable& table, RenderSettings& settings)
{
    addNumber<float>(table, {"--tolerance", "T", "Relative error at which --adaptive course stops a pixel", 1e-30F, 1e6F, "0.05"},
                     [&settings](float tolerance) { settings.course.tolerance = tolerance; });
    addNumber<std::uint32_t>(table, {"--batch", "N", "Samples between convergence tests of --adaptive course", 2, 1048576, "32"},
                             [&settings](std::uint32_t count) { settings.course.batch = count; });
    addNumber<std::uint32_t>(table, {"--max-spp", "N", "Maximum samples per pixel of --adaptive course", 2, kMaxSample, "2048"},
                             [&settings](std::uint32_t count) { settings.sampleEnd = count; });
    table.hide({"--tolerance", "--batch", "--max-spp"});
}

void addDevice(OptionTable& table, PictureOptions& options)
{
    table.beginGroup("Device");
    table.addText("--device", "D", "Index or part of a name from `glim devices` [the first usable one]", options.device);
    addEnum(table, "--schedule", "S", "Kernel schedule: wavefront, persistent or auto, the faster one; same picture [auto]",
            {"auto", "wavefront", "persistent"}, options.settings.schedule);
    addNumber<std::uint32_t>(table,
                             {"--path-capacity", "N", "Paths in flight; same picture", kBlockSamples, 1U << 24U, "as suits the device"},
                             [&options](std::uint32_t paths) { options.settings.pathCapacity = paths; });
    addEnum(table, "--accelerator", "A", "Acceleration structure: bvh, or none (brute force) [bvh]", {"bvh", "none"},
            options.settings.course.accelerator);
    addEnum(table, "--split", "RULE", "Split of BVH nodes: sah, mean or median [sah]", {"sah", "mean", "median"}, options.split);
    addEnum(table, "--intersector", "I", "Triangle test: watertight or moller-trumbore [watertight]", {"watertight", "moller-trumbore"},
            options.settings.course.intersector);
    table.hide({"--schedule", "--path-capacity", "--accelerator", "--split", "--intersector"});
}

LoadOptions makeLoadOptions(const PictureOptions& options)
{
    LoadOptions load;
    load.scene = options.sceneIndex;
    load.variant = options.variant;
    load.at = options.at;
    load.shutter = options.shutter;
    load.animation = options.animation;
    load.environment = options.environment;
    load.environmentRotation = options.environmentRotation;
    load.environmentStrength = options.environmentStrength;
    load.environmentBackground = options.environmentBackground;
    load.sun = options.sun;
    load.showsBackFaces = options.showsBackFaces;
    load.pointRadius = options.pointRadius;
    load.lineRadius = options.lineRadius;
    load.floor = options.floor;
    load.catchers = options.catchers;
    load.lightGroups = options.lightGroups;
    load.edits = options.edits;
    load.additions = options.additions;
    load.missingTextures = options.missingTextures;
    load.confined = options.confined;
    load.maxTexture = options.maxTexture;
    load.framed = options.camera == "framed";
    if (options.field.degrees) {
        load.yfov = static_cast<float>(glm::radians(*options.field.degrees));
    }
    if (options.size) {
        load.aspectRatio = static_cast<float>(options.size->x) / static_cast<float>(options.size->y);
    }
    if (options.projection.intrinsics && options.size) {  // a framed camera sees the scene in what is symmetric about its axis
        const Intrinsics& k = *options.projection.intrinsics;
        const glm::dvec2 half = glm::min(k.center, glm::dvec2(*options.size) - k.center) / k.focal;
        if (half.x > 0.0 && half.y > 0.0) {
            load.yfov = static_cast<float>(2.0 * std::atan(half.y));
            load.aspectRatio = static_cast<float>(half.x / half.y);
        }
    }
    return load;
}

RenderSettings settingsFor(const PictureOptions& options, const Camera& camera)
{
    RenderSettings settings = options.settings;
    const std::optional<Crop>& crop = camera.projection.crop;
    const glm::uvec2 size = crop ? crop->size : options.size.value_or(defaultSize(camera));
    settings.width = size.x;
    settings.height = size.y;
    settings.caustics = settings.caustics && options.caustics != CausticsChoice::Off;
    if (settings.rows && settings.rows->second > size.y) {
        const std::string rows = std::to_string(settings.rows->first) + ":" + std::to_string(settings.rows->second);
        throw UsageError(MessageId::OutOfRange, {part::place("--rows"), ": ", part::value(rows), ": the picture has ",
                                                 part::expected(std::to_string(size.y) + " rows")});
    }
    return settings;
}

void refuseOutside(const std::string& option, const glm::uvec2& pixel, const RenderSettings& settings)
{
    if (pixel.x >= settings.width || pixel.y >= settings.height) {
        throw InputError(
            MessageId::OutOfRange,
            {part::place(option), ": pixel ", part::value(std::to_string(pixel.x) + "," + std::to_string(pixel.y)),
             " is outside the picture of ", std::to_string(settings.width), "x", std::to_string(settings.height), "; expected ",
             part::expected("X from 0 to " + std::to_string(settings.width - 1) + " and Y from 0 to " +
                            std::to_string(settings.height - 1)),
             "."});
    }
}

}  // namespace glim
