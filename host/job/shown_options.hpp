// What a window shows, as options of `glim render`. The command line and the file of --edits are made of one list.
#pragma once

#include "host/flatten/flatten_scene.hpp"
#include "host/json.hpp"
#include "host/render/film_pictures.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"

#include <optional>
#include <string>
#include <vector>

namespace glim {

struct ShownPicture {
    LoadOptions load;  // with all edits, and the time of now
    std::string camera;
    std::optional<Pose> pose;
    FieldOfView field;
    Lens lens;
    Projection projection;
    glm::uvec2 size{0};
    LookOptions look;
};

// Without the dashes. A value with a key is a member of an object (--set KEY=VALUE); one without a text is a flag's.
struct ShownOption {
    std::string name, key, value;

    bool operator==(const ShownOption&) const = default;
};

// Those that differ from the defaults, and camera and size. Names of files begin where those of the options do.
std::vector<ShownOption> listShownOptions(const ShownPicture& shown);

// "--camera 0 --size 640x480 --set /nodes/0/translation=0,2,0": words that a POSIX shell would change are in quotes.
std::string toCommandLine(const std::vector<ShownOption>& options);

// {"camera": 0, "size": "640x480", "set": {"/nodes/0/translation": [0, 2, 0]}}, for --edits.
Json toEdits(const std::vector<ShownOption>& options);

}  // namespace glim
