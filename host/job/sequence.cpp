#include "host/job/sequence.hpp"

#include "host/error.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/scene/frame_camera.hpp"
#include "host/scene/read_camera_file.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

double timeOf(const SequenceOptions& sequence, std::uint32_t frame) { return frame / sequence.fps; }

std::vector<Shot> listFrames(const SequenceOptions& sequence, const PictureOptions& picture)
{
    const auto [first, last, step] = *sequence.frames;
    std::vector<Shot> shots;
    for (std::uint64_t frame = first; frame <= last; frame += step) {
        const auto number = static_cast<std::uint32_t>(frame);
        shots.push_back({number, timeOf(sequence, number), picture.camera, picture.pose});
    }
    return shots;
}

std::vector<Shot> listTurntable(const SequenceOptions& sequence, const PictureOptions& picture, const Scene& scene)
{
    const Camera& framed = scene.cameras.back();
    const glm::vec2 size(picture.size.value_or(defaultSize(framed)));
    std::vector<Shot> shots;
    for (const Pose& pose : frameTurntable(scene, size.x / size.y, sequence.turntable, framed.yfov)) {
        shots.push_back({static_cast<std::uint32_t>(shots.size()), picture.at, "framed", pose});
    }
    return shots;
}

// The pose of an entry that has a field of view: that of its camera, magnified. `place` in the file is the entry's.
Pose zoomedPose(const CameraEntry& entry, const Camera& camera, const Scene& scene, const std::filesystem::path& file,
                const std::string& place)
{
    if (camera.kind != Camera::Kind::Perspective) {
        throw InputError(MessageId::Conflict, {part::file(file), ": ", part::place(place + ".yfov"), ": camera ", part::quoted(camera.name),
                                               " is orthographic; expected ", part::expected("zoom"), " instead."});
    }
    Pose pose = entry.pose.value_or(computePose(camera, 1.0, scene.origin));
    pose.zoom = std::tan(0.5 * static_cast<double>(camera.yfov)) / std::tan(0.5 * *entry.yfov);
    return pose;
}

std::vector<Shot> listCameras(const std::filesystem::path& file, const PictureOptions& picture, const Scene& scene)
{
    std::vector<Shot> shots;
    for (const CameraEntry& entry : readCameraFile(file)) {
        const auto number = static_cast<std::uint32_t>(shots.size());
        const std::string place = "[" + std::to_string(number) + "]";
        try {
            const Camera& camera = findCamera(scene, entry.camera);
            shots.push_back({number, picture.at, entry.camera, entry.yfov ? zoomedPose(entry, camera, scene, file, place) : entry.pose});
            if (shots.back().pose) {
                placeCamera(camera, *shots.back().pose, scene.origin);  // now, not after the pictures before it
            }
        } catch (const InputError& error) {
            if (error.message().place.starts_with(place)) {
                throw;
            }
            throw InputError(error, {part::file(file), ": ", part::place(place), ": ", error.what()});
        }
    }
    return shots;
}

}  // namespace

bool isSequence(const SequenceOptions& sequence, const PictureOptions& picture)
{
    return sequence.frames || sequence.turntable > 0 || sequence.cameras || picture.camera == "all";
}

std::optional<double> firstTime(const SequenceOptions& sequence, const PictureOptions& picture)
{
    return sequence.frames ? timeOf(sequence, sequence.frames->first) : picture.at;
}

std::vector<Shot> listShots(const SequenceOptions& sequence, const PictureOptions& picture, const Scene& scene)
{
    if (sequence.frames) {
        return listFrames(sequence, picture);
    }
    if (sequence.turntable > 0) {
        return listTurntable(sequence, picture, scene);
    }
    if (sequence.cameras) {
        return listCameras(*sequence.cameras, picture, scene);
    }
    if (picture.camera != "all") {
        return {{0, picture.at, picture.camera, picture.pose}};
    }
    std::vector<Shot> shots;
    for (std::uint32_t i = 0; i < scene.cameras.size(); ++i) {
        shots.push_back({i, picture.at, std::to_string(i), std::nullopt});
    }
    return shots;
}

std::filesystem::path numberedPath(const std::filesystem::path& path, std::uint32_t number)
{
    std::string name = path.filename().string();
    const std::size_t begin = name.find('#'), end = std::min(name.find_first_not_of('#', begin), name.size());
    std::string digits = std::to_string(number);
    digits.insert(0, end - begin > digits.size() ? end - begin - digits.size() : 0, '0');
    return path.parent_path() / name.replace(begin, end - begin, digits);
}

}  // namespace glim
