#include "host/job/render_job.hpp"

#include "host/job/resolve_options.hpp"

namespace glim {
namespace {

void addAov(OptionTable& table, RenderJob& options)
{
    addEnum(table, "--view", "V", "Picture of: shaded, normal, depth, albedo, bvh-steps or guide [shaded]",
            {"shaded", "normal", "depth", "albedo", "bvh-steps", "guide"}, options.settings.aov);
}

void addShutter(OptionTable& table, RenderJob& options)
{
    table.add("--shutter", "OPEN,CLOSE", "Motion blur: when the shutter opens and closes, in seconds from the frame [off]",
              [&options](const OptionValue& value) { options.shutter = parseShutter(value); });
}

void addTargets(OptionTable& table, ErrorTarget& target)
{
    table.add("--target-rmse", "P%", "Stop when the estimated RMSE is this share of the picture's mean, as in 1% [off]",
              [&target](const OptionValue& value) { target.rmse = parsePercent("--target-rmse", value); });
    addNumber<double>(table, {"--target-relmse", "E", "Stop when the estimated relMSE is at most this", 1e-12, 1e6, "off"},
                      [&target](double value) { target.relMse = value; });
    table.addFlag("--denoised", "Apply the targets to the denoised picture, made anew at each check of the error", target.denoised);
}

void addSequence(OptionTable& table, RenderJob& options)
{
    SequenceOptions& sequence = options.sequence;
    table.beginGroup("Several pictures");
    const Option frames = table.add("--frames", "A:B[:STEP]", "Frames A to B of the animation; each number replaces #### in names of files",
                                    [&sequence](const OptionValue& value) { sequence.frames = parseFrames(value); });
    addNumber<double>(table, {"--fps", "N", "Frames per second of --frames and of the movie", 1e-3, 1e6, "24"}, [&sequence](double fps) {
        sequence.fps = fps;
    }).needs(frames);
    const Option turntable =
        addNumber<std::uint32_t>(table, {"--turntable", "N", "Pictures from a circle around the scene", 1, 100000, "off"},
                                 [&sequence](std::uint32_t count) { sequence.turntable = count; });
    const Option cameras = table.addPath("--cameras", "FILE.json", "Pictures by an array of cameras: host/cli/README.md", sequence.cameras);
    frames.excludes(table.option("--at")).excludes(turntable).excludes(cameras);
    turntable.excludes(cameras);
    for (const Option* chooser : {&turntable, &cameras}) {
        chooser->excludes(table.option("--camera")).excludes(table.option("--look-from"));
        chooser->excludes(table.option("--pose-gltf")).excludes(table.option("--pose-opencv"));
    }
    table.addPath("--movie", "M.mp4", "Also make a movie of the first --image by ffmpeg: .mp4 (H.264) or .webm (VP9)", options.movie)
        .servesAs(frames);
    cameras.excludes(table.option("--fov")).excludes(table.option("--zoom"));  // each camera of the file has its own
}

void addOutput(OptionTable& table, RenderJob& options)
{
    table.beginGroup("Output");
    table.addPath("-o,--output", "OUT.exr", "Scene-linear EXR with layers, or only a picture: .png, .jpg, .webp", options.output).require();
    addPictureFiles(table, options.pictures);
    addLook(table, options.look, "the picture", "none; neutral in the built-in studio");
    const Option denoise =
        table.addFlag("--denoise", "Also write a denoised picture and its measured error; the PNG shows it", options.denoise);
    table.addFlag("--no-denoise", "Leave a picture noisy that is written without its film", options.noDenoise).excludes(denoise);
    table.addPath("--oidn", "PATH", "Library of Open Image Denoise that denoises instead, or its folder [glim's own]", options.oidn)
        .needs(denoise);
    table.option("--denoised").needs(denoise);
    table.addPath("--rates", "R.png", "Also draw the samples per pixel, blue (fewest) to red (most)", options.rates);
    const Option layers =
        table.addPath("--layers", "L.exr", "Also write RGBA, albedo, normal and depth for compositing, as half floats", options.layers);
    addEnum(table, "--compression", "C", "Of the layers, without loss: zip, zips, piz, rle or none [zip]",
            {"zip", "zips", "piz", "rle", "none"}, options.compression)
        .needs(layers);
    table.addPath("--ids", "I.exr", "Also write which nodes, meshes and materials each pixel shows, and Cryptomatte", options.ids);
    const Option surfaces =
        table.addPath("--surfaces", "S.exr", "Also write position, uv, distance and instance at each pixel's centre", options.surfaces);
    addNumber<double>(table, {"--flow", "SECONDS", "With --surfaces: optical flow to that much later and earlier", 1e-9, 1e6, "off"},
                      [&options](double seconds) { options.flow = seconds; })
        .needs(surfaces);
    table.addPath("--objects", "O.json", "Also write names, boxes, masks and visible shares of instances, with COCO's keys",
                  options.objects);
    table.addPath("--stats", "S.json", "Also write times, counts and estimated errors, or the path of --replay", options.stats);
    addCheckpoint(table, options.checkpoint);
    addProgress(table, options.progress);
    addNumber<std::uint32_t>(table, {"--suspects", "N", "List the brightest samples, the firefly candidates", 1, 1000, "off"},
                             [&options](std::uint32_t count) { options.settings.suspects = count; });
    table.add("--replay", "X,Y,SAMPLE", "Print every vertex of one sample's path, and render no picture",
              [&table, &options](const OptionValue& value) {
                  options.replay = parseSample(value);
                  table.option("--output").require(false);
              });
}

}  // namespace

void addJobOptions(OptionTable& table, RenderJob& options)
{
    table.beginGroup("Picture");
    table.addPath("file,SCENE", "FILE", "Scene, .gltf or .glb", options.scene).require();
    addPicture(table, options);
    addShutter(table, options);
    addAov(table, options);
    table.add("--rows", "BEGIN:END", "Only rows BEGIN to END - 1 of the picture, for `glim merge`, 0 at the top [all]",
              [&options](const OptionValue& value) { options.settings.rows = parseRange("--rows", value, kMaxSide); });
    addCamera(table, options, ", or all");
    addFocus(table, options.focus);
    addProjection(table, options);
    addCrop(table, options);
    addSequence(table, options);
    table.beginGroup("Sampling and stopping");
    addSampleCount(table, options.settings, "64; 4 with a --view other than shaded", "0:64");
    addTargets(table, options.target);
    addAdaptive(table, options.settings);
    addSampler(table, options.settings);
    addLightTransport(table, options.settings);
    addCaustics(table, options.caustics);
    addGuiding(table, options.guiding);
    addCourseEstimators(table, options.settings);
    addCourseRule(table, options.settings);
    addDevice(table, options);
    addOutput(table, options);
    table.onFinished([&table, &options] { resolveRender(table, options); });
}

}  // namespace glim
