// A change to a scene's file: a new value at a pointer of its object model.
#pragma once

#include <string>

namespace glim {

struct Edit {
    std::string pointer;  // as of KHR_animation_pointer: /materials/0/alphaCutoff; a name may stand for an index
    std::string value;    // JSON

    bool operator==(const Edit&) const = default;
};

}  // namespace glim
