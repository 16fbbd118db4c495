#include "host/cli/picture_options.hpp"

#include "host/cli/parse.hpp"
#include "host/render/prepare_scene.hpp"

#include <CLI/CLI.hpp>

namespace glim {
namespace {

CLI::Option* addPoint(CLI::App& command, const std::string& name, const std::string& help, PictureOptions& options,
                      glm::dvec3 Pose::*point)
{
    return command
        .add_option_function<std::string>(
            name,
            [&options, name, point](const std::string& text) {
                options.pose = options.pose.value_or(Pose{});
                (*options.pose).*point = parsePoint(name, text);
            },
            help)
        ->type_name("X,Y,Z");
}

void addPose(CLI::App& command, PictureOptions& options)
{
    CLI::Option* from = addPoint(command, "--look-from", "Where the camera stands instead, world coordinates", options, &Pose::from);
    CLI::Option* at = addPoint(command, "--look-at", "What it has in the middle of the picture", options, &Pose::at);
    from->needs(at);
    at->needs(from);
    addPoint(command, "--look-up", "The direction that points upwards in the picture [0,1,0]", options, &Pose::up)->needs(from);
    addNumber<double>(command, {"--zoom", "Z", "Show things this much larger", 1e-6, 1e6, "1"}, [&options](double zoom) {
        options.pose = options.pose.value_or(Pose{});
        options.pose->zoom = zoom;
    })->needs(from);
}

void addLens(CLI::App& command, PictureOptions& options)
{
    CLI::Option* radius = addNumber<float>(
        command, {"--lens-radius", "R", "Radius of a thin lens, metres", 0.0F, 1e6F, "0, a pinhole"},
        [&options](float metres) { options.lens.radius = metres; });
    CLI::Option* distance = addNumber<float>(
        command,
        {"--focal-distance", "D", "From the lens to the plane of sharpness along the view axis, metres", 1e-6F, 1e9F, "none"},
        [&options](float metres) { options.lens.focalDistance = metres; });
    radius->needs(distance);
    distance->needs(radius);
}

}  // namespace

void addSceneOptions(CLI::App& command, PictureOptions& options)
{
    command.add_option("SCENE", options.scene, "The scene, .gltf or .glb")->required()->type_name("FILE");
    addSceneChoice(command, options);
}

void addSceneChoice(CLI::App& command, PictureOptions& options)
{
    addSceneIndex(command, options.sceneIndex);
    command
        .add_option_function<std::string>(
            "--environment", [&options](const std::string& text) { options.environment = parseRadiance(text); },
            "Constant radiance from everywhere, W/(sr m^2), each >= 0; replaces the file's own [none]")
        ->type_name("R,G,B");
}

void addCameraOptions(CLI::App& command, PictureOptions& options, const std::string& height)
{
    command
        .add_option_function<std::string>(
            "--size", [&options](const std::string& text) { options.size = parseSize(text); },
            "Pixels, each side 1 to 65535 [" + height + " high, width from the camera's aspect ratio]")
        ->type_name("WxH");
    command.add_option("--camera", options.camera, "Name or index of a camera of the file [0]")->type_name("NAME|INDEX");
    addPose(command, options);
    addLens(command, options);
}

void addDevice(CLI::App& command, PictureOptions& options)
{
    command.add_option("--device", options.device, "Index or part of a name from `glim devices` [the first usable one]")
        ->type_name("D");
}

LoadOptions loadOptionsOf(const PictureOptions& options)
{
    LoadOptions load{options.sceneIndex, options.environment};
    if (options.size) {
        load.aspectRatio = static_cast<float>(options.size->x) / static_cast<float>(options.size->y);
    }
    return load;
}

Camera cameraOf(const Scene& scene, const PictureOptions& options)
{
    const Camera& camera = findCamera(scene, options.camera);
    return options.pose ? placeCamera(camera, *options.pose, scene.origin) : camera;
}

RenderSettings settingsFor(const PictureOptions& options, const Camera& camera)
{
    RenderSettings settings = options.settings;
    const glm::uvec2 size = options.size.value_or(naturalSize(camera));
    settings.width = size.x;
    settings.height = size.y;
    return settings;
}

}  // namespace glim
