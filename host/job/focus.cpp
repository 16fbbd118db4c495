#include "host/job/focus.hpp"

#include "host/job/render_picture.hpp"
#include "host/message.hpp"
#include "host/text.hpp"

#include <utility>

namespace glim {
namespace {

// What the options show without --crop and --rows.
struct WholePicture {
    RenderSettings settings;
    FlatCamera camera;
};

WholePicture makeWhole(RenderJob options, const PreparedScene& prepared)
{
    options.projection.crop.reset();
    options.settings.rows.reset();
    const Camera camera = makeCamera(prepared.scene, options);
    const RenderSettings settings = settingsFor(options, camera);
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    return {settings, flattenCamera(prepared, camera, aspect, options.lens)};
}

std::string pixelText(const glm::uvec2& pixel) { return std::to_string(pixel.x) + "," + std::to_string(pixel.y); }

}  // namespace

RenderJob FocusFinder::resolve(RenderJob options, SceneSession& session)
{
    if (!options.focus) {
        return options;
    }
    const glm::uvec2 pixel = *options.focus;
    const auto [settings, camera] = makeWhole(options, session.prepared());
    refuseOutside("--focus", pixel, settings);
    const PictureFrame frame = framePicture(session, options);
    const RenderResources& resources = session.beginAhead(frame.camera, frame.settings).resources();
    CameraRays rays(resources.device, *resources.shared, session.prepared().flat, camera, settings, std::move(kernels_), RayPlace::Centers);
    kernels_ = rays.kernels();
    const std::uint32_t chosen = pixel.y * settings.width + pixel.x;
    const PathHit hit = rays.trace(std::span(&chosen, 1), 0, 1).front();
    if (hit.primitiveRef == kNoPrimitiveRef) {
        throw InputError(MessageId::Empty, {part::place("--focus"), ": pixel ", part::value(pixelText(pixel)),
                                            " shows no surface; expected ", part::expected("a pixel that shows what is to be sharp"), "."});
    }
    const glm::dvec3 direction(rays.rays(1).front().direction);
    options.lens.focalDistance = static_cast<float>(static_cast<double>(hit.t) * glm::dot(direction, glm::dvec3(camera.forward)));
    say(MessageId::FocusFound, {part::place("--focus"), " ", pixelText(pixel), " is ", part::place("--focal-distance"), " ",
                                part::value(exactText(options.lens.focalDistance))});
    return options;
}

}  // namespace glim
