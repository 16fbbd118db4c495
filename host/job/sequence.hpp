// The pictures that one call of `glim render` makes: frames of an animation, a turntable or a list of cameras.
#pragma once

#include "host/job/parse.hpp"
#include "host/job/picture_options.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace glim {

struct SequenceOptions {
    std::optional<FrameRange> frames;
    double fps = 24.0;            // frame f shows the animation at f / fps seconds
    std::uint32_t turntable = 0;  // pictures from around the scene; 0: no turntable
    std::optional<std::filesystem::path> cameras;
};

bool isSequence(const SequenceOptions& sequence, const PictureOptions& picture);

// The number of a picture, which its files have in their names, and what differs from picture to picture.
struct Shot {
    std::uint32_t number = 0;
    std::optional<double> at;
    std::optional<std::string> camera;
    std::optional<Pose> pose;
};

// The time of the first picture.
std::optional<double> firstTime(const SequenceOptions& sequence, const PictureOptions& picture);

// All pictures, of a scene loaded at firstTime(). Throws InputError if the file of cameras cannot be read or does not fit the scene.
std::vector<Shot> listShots(const SequenceOptions& sequence, const PictureOptions& picture, const Scene& scene);

// The name of a file whose name has a run of #: the number in its place, with leading zeros.
std::filesystem::path numberedPath(const std::filesystem::path& path, std::uint32_t number);

}  // namespace glim
