#include "host/cli/render_options.hpp"

#include "host/cli/resolve_options.hpp"

namespace glim {
namespace {

void addAov(const Command& command, RenderOptions& options)
{
    addEnum(command, "--view", "V", "Picture of: shaded, normal, depth, albedo or bvh-steps [shaded]",
            {"shaded", "normal", "depth", "albedo", "bvh-steps"}, options.settings.aov);
}

void addTargets(const Command& command, ErrorTarget& target)
{
    command.add("--target-rmse", "P%", "Stop when the estimated RMSE is this share of the picture's mean, as in 1% [off]",
                [&target](const std::string& text) { target.rmse = parsePercent("--target-rmse", text); });
    addNumber<double>(command, {"--target-relmse", "E", "Stop when the estimated relMSE is at most this", 1e-12, 1e6, "off"},
                      [&target](double value) { target.relMse = value; });
    command.addFlag("--denoised", "Targets are of the denoised picture, whose error is measured at every look", target.denoised);
}

void addSequence(const Command& command, RenderOptions& options)
{
    SequenceOptions& sequence = options.sequence;
    command.beginGroup("Several pictures");
    const Option frames =
        command.add("--frames", "A:B[:STEP]", "Frames A to B of the animation; each number replaces #### in names of files",
                    [&sequence](const std::string& text) { sequence.frames = parseFrames(text); });
    addNumber<double>(command, {"--fps", "N", "Frames per second of --frames", 1e-3, 1e6, "24"}, [&sequence](double fps) {
        sequence.fps = fps;
    }).needs(frames);
    const Option turntable =
        addNumber<std::uint32_t>(command, {"--turntable", "N", "Pictures from a circle around the scene", 1, 100000, "off"},
                                 [&sequence](std::uint32_t count) { sequence.turntable = count; });
    const Option cameras =
        command.addPath("--cameras", "FILE.json", "Pictures by an array of cameras: host/cli/README.md", sequence.cameras);
    frames.excludes(command.option("--at")).excludes(turntable).excludes(cameras);
    turntable.excludes(cameras);
    for (const Option* chooser : {&turntable, &cameras}) {
        chooser->excludes(command.option("--camera")).excludes(command.option("--look-from"));
    }
}

void addOutput(const Command& command, RenderOptions& options)
{
    command.beginGroup("Output");
    command.addPath("-o,--output", "OUT.exr", "Scene-linear EXR with layers; required without --replay", options.output).require();
    addPictureFiles(command, options.pictures);
    addLook(command, options.look, "the picture", "none; neutral in the built-in studio");
    const Option denoise =
        command.addFlag("--denoise", "Also write a denoised picture and its measured error; the PNG shows it", options.denoise);
    command.addPath("--oidn", "PATH", "Library of Open Image Denoise that denoises instead, or its folder [glim's own]", options.oidn)
        .needs(denoise);
    command.option("--denoised").needs(denoise);
    command.addPath("--rates", "R.png", "Also draw the samples per pixel, blue (fewest) to red (most)", options.rates);
    command.addPath("--ids", "I.exr", "Also write which nodes, meshes and materials each pixel shows, and Cryptomatte", options.ids);
    command.addPath("--stats", "S.json", "Also write times, counts and estimated errors, or the path of --replay", options.stats);
    addCheckpoint(command, options.checkpoint);
    addProgress(command, options.progress);
    addNumber<std::uint32_t>(command, {"--suspects", "N", "List the brightest samples, the firefly candidates", 1, 1000, "off"},
                             [&options](std::uint32_t count) { options.settings.suspects = count; });
    command.add("--replay", "X,Y,SAMPLE", "Print every vertex of one sample's path, and render no picture",
                [command, &options](const std::string& text) {
                    options.replay = parseSample(text);
                    command.option("--output").require(false);
                });
}

}  // namespace

void addRenderOptions(const Command& command, RenderOptions& options)
{
    command.beginGroup("Picture");
    command.addPath("SCENE", "FILE", "Scene, .gltf or .glb", options.scene).require();
    addPicture(command, options);
    addAov(command, options);
    command.add("--rows", "BEGIN:END", "Only rows BEGIN to END - 1 of the picture, for `glim merge`, 0 at the top [all]",
                [&options](const std::string& text) { options.settings.rows = parseRange("--rows", text, kMaxSide); });
    addCamera(command, options, ", or all");
    addSequence(command, options);
    command.beginGroup("Sampling and stopping");
    addSampleCount(command, options.settings, "64; 4 with a --view other than shaded", "0:64");
    addTargets(command, options.target);
    addAdaptive(command, options.settings);
    addSampler(command, options.settings);
    addLightTransport(command, options.settings);
    addCaustics(command, options.settings);
    addCourseEstimators(command, options.settings);
    addCourseRule(command, options.settings);
    addDevice(command, options);
    addOutput(command, options);
    command.onParsed([command, &options] { resolveRender(command, options); });
}

}  // namespace glim
