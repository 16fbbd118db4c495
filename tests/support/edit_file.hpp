// Edits of a scene's file, with its other options as they are.
#pragma once

#include "host/scene/load_gltf.hpp"

#include <vector>

namespace glim::test {

inline void edit(SceneFile& file, const std::vector<Edit>& edits)
{
    LoadOptions options = file.options();
    options.edits = edits;
    file.choose(options);
}

}  // namespace glim::test
