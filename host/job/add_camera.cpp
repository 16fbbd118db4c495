// The options of cameras.
#include "host/error.hpp"
#include "host/job/parse.hpp"
#include "host/job/picture_options.hpp"
#include "host/render/prepare_scene.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

Option addPoint(OptionTable& table, const std::string& name, const std::string& help, PictureOptions& options, glm::dvec3 Pose::*point)
{
    return table.add(name, "X,Y,Z", help, [&options, name, point](const OptionValue& value) {
        options.pose = options.pose.value_or(Pose{});
        (*options.pose).*point = parsePoint(name, value);
    });
}

void addPose(OptionTable& table, PictureOptions& options)
{
    const Option from = addPoint(table, "--look-from", "Place the camera here instead, in world coordinates", options, &Pose::from);
    const Option at = addPoint(table, "--look-at", "Point in the middle of the picture", options, &Pose::at);
    from.needs(at);
    at.needs(from);
    addPoint(table, "--look-up", "Direction that points upwards in the picture [0,1,0]", options, &Pose::up).needs(from);
}

void addField(OptionTable& table, FieldOfView& field)
{
    addNumber<double>(table, {"--fov", "DEG", "Vertical field of view in degrees", 0.01, 179.0, "the camera's"},
                      [&field](double degrees) { field.degrees = degrees; });
    addNumber<double>(table, {"--zoom", "Z", "Magnification", 1e-6, 1e6, "1"}, [&field](double zoom) { field.zoom = zoom; });
}

void addLens(OptionTable& table, PictureOptions& options)
{
    const Option radius = addNumber<float>(table, {"--lens-radius", "R", "Radius of a thin lens in metres", 0.0F, 1e6F, "0, a pinhole"},
                                           [&options](float metres) { options.lens.radius = metres; });
    const Option distance =
        addNumber<float>(table, {"--focal-distance", "D", "Distance of the plane in focus, in metres", 1e-6F, 1e9F, "none"},
                         [&options](float metres) { options.lens.focalDistance = metres; });
    radius.needs(distance);
    distance.needs(radius);
}

// `toGltf`: the signs that turn the axes of the option's cameras into those of glTF's.
Option addMatrix(OptionTable& table, const std::string& name, const std::string& help, const glm::dvec3& toGltf, PictureOptions& options)
{
    return table.add(name, "M", help, [&options, name, toGltf](const OptionValue& value) {
        const std::string expected = "the 12 or 16 numbers of a rotation and a translation, row by row, the last row 0,0,0,1";
        std::vector<double> numbers = parseNumbers(name, value, {12, 16}, expected);
        if (numbers.size() == 12) {
            numbers.insert(numbers.end(), {0.0, 0.0, 0.0, 1.0});
        }
        const std::optional<Pose> pose = computeRigidPose(glm::transpose(glm::make_mat4(numbers.data())), toGltf);
        if (!pose) {
            throw UsageError(MessageId::Degenerate,
                             {part::place(name), ": ", part::quoted(value.text()), ": expected ", part::expected(expected)});
        }
        options.pose = pose;
    });
}

void addMatrices(OptionTable& table, PictureOptions& options)
{
    const Option gltf = addMatrix(table, "--pose-gltf", "The camera's 3x4 or 4x4 matrix to world, row by row; it looks along -z, up is +y",
                                  glm::dvec3(1.0), options);
    const Option openCv = addMatrix(table, "--pose-opencv", "The same of a camera with OpenCV's axes: it looks along +z, down is +y",
                                    glm::dvec3(1.0, -1.0, -1.0), options);
    for (const Option& option : {gltf, openCv}) {
        option.excludes(table.option("--look-from"));
    }
    gltf.excludes(openCv);
}

// `corner`: where the upper left corner of the picture is for this option.
Option addIntrinsics(OptionTable& table, const std::string& name, const std::string& help, double corner, Projection& projection)
{
    return table.add(name, "FX,FY,CX,CY", help, [&projection, name, corner](const OptionValue& value) {
        const std::string expected = "focal lengths above 0 and a principal point, in pixels, as in 600,600,320,240";
        const std::vector<double> numbers = parseNumbers(name, value, {4}, expected);
        if (!(std::min(numbers[0], numbers[1]) > 0.0)) {
            throw UsageError(MessageId::OutOfRange,
                             {part::place(name), ": ", part::quoted(value.text()), ": expected ", part::expected(expected)});
        }
        projection.intrinsics = Intrinsics{{numbers[0], numbers[1]}, glm::dvec2(numbers[2], numbers[3]) - corner};
    });
}

// Of a picture whose size is not known yet.
Crop parseCrop(const OptionValue& value)
{
    const std::string expected = "whole numbers: column, row, and a width and a height of 1 or more";
    const std::vector<double> numbers = parseNumbers("--crop", value, {4}, expected);
    const auto isCount = [](double number) { return number >= 0.0 && number <= kMaxSide && number == std::floor(number); };
    if (!std::ranges::all_of(numbers, isCount) || numbers[2] < 1.0 || numbers[3] < 1.0) {
        throw UsageError(MessageId::OutOfRange,
                         {part::place("--crop"), ": ", part::quoted(value.text()), ": expected ", part::expected(expected)});
    }
    return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

Option addDistortion(OptionTable& table, const std::string& name, const std::string& unit, const std::string& help,
                     const std::vector<std::size_t>& counts, Projection::Model model, Projection& projection)
{
    return table.add(name, unit, help, [&projection, name, unit, counts, model](const OptionValue& value) {
        const std::vector<double> numbers = parseNumbers(name, value, counts, "the numbers " + unit);
        projection.model = model;
        projection.distortion = {};
        std::ranges::copy(numbers, projection.distortion.begin());
    });
}

}  // namespace

void addCamera(OptionTable& table, PictureOptions& options, const std::string& more)
{
    table.beginGroup("Camera");
    table.addText("--camera", "NAME|INDEX", "Camera of the file, or framed: one that sees the whole scene" + more + " [0]", options.camera);
    addPose(table, options);
    addField(table, options.field);
    addLens(table, options);
}

void addFocus(OptionTable& table, std::optional<glm::uvec2>& pixel)
{
    const Option radius = table.option("--lens-radius"), distance = table.option("--focal-distance");
    table
        .add("--focus", "X,Y", "Focus on what this pixel shows, 0,0 at the upper left, instead of --focal-distance",
             [&pixel](const OptionValue& value) { pixel = parsePixel("--focus", value); })
        .needs(radius)
        .excludes(distance)
        .servesAs(distance);
}

void addProjection(OptionTable& table, PictureOptions& options)
{
    Projection& projection = options.projection;
    addMatrices(table, options);
    const Option corner =
        addIntrinsics(table, "--intrinsics", "Focal lengths and principal point in pixels; the picture's corner is 0,0", 0.0, projection);
    const Option openCv =
        addIntrinsics(table, "--intrinsics-opencv", "The same as OpenCV has them: the middle of the first pixel is 0,0", -0.5, projection);
    const Option distortion =
        addDistortion(table, "--distortion", "K1,K2,P1,P2[,K3[,K4,K5,K6]]", "Distortion of the lens, as OpenCV's distCoeffs", {4, 5, 8},
                      Projection::Model::RadialTangential, projection);
    const Option fisheye = addDistortion(table, "--fisheye", "K1,K2,K3,K4", "A fisheye lens, as of OpenCV's cv::fisheye", {4},
                                         Projection::Model::Fisheye, projection);
    const Option shift = table.add("--shift", "X,Y", "Shift of the picture to the right and up, in units of its longer side [0,0]",
                                   [&projection](const OptionValue& value) {
                                       const std::vector<double> xy = parseNumbers("--shift", value, {2}, "two numbers, as in 0.1,0");
                                       projection.shift = {xy[0], xy[1]};
                                   });
    const Option kind = addChoice(
        table, "--projection", "P", "camera, as the file says, or equirectangular: 360 degrees [camera]", {"camera", "equirectangular"},
        [&projection](std::size_t choice) { projection.model = choice == 0 ? projection.model : Projection::Model::Equirectangular; });
    for (const Option& option : {corner, openCv}) {
        option.needs(table.option("--size")).excludes(table.option("--fov")).excludes(table.option("--zoom")).excludes(kind);
    }
    corner.excludes(openCv);
    distortion.excludes(fisheye).excludes(kind);
    fisheye.excludes(kind);
    shift.excludes(kind);
    kind.excludes(table.option("--fov")).excludes(table.option("--zoom")).excludes(table.option("--lens-radius"));
    fisheye.excludes(table.option("--lens-radius"));
}

void addCrop(OptionTable& table, PictureOptions& options)
{
    table.add("--crop", "X,Y,W,H", "Render only W x H pixels of the picture, from column X and row Y on [all]",
              [&options](const OptionValue& value) { options.projection.crop = parseCrop(value); });
}

Camera makeCamera(const Scene& scene, const PictureOptions& options)
{
    Camera camera = applyField(findCamera(scene, options.camera), options.field);
    camera = options.pose ? placeCamera(camera, *options.pose, scene.origin) : camera;
    return applyProjection(camera, options.projection, options.size.value_or(defaultSize(camera)));
}

}  // namespace glim
