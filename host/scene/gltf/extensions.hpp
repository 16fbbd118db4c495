// What glim does about each extension of glTF.
#pragma once

#include <string>

namespace glim {

enum class ExtensionEffect {
    Drawn,
    None,     // not read, and a still picture lacks nothing for it
    Looks,    // not read, and materials or lights look otherwise
    Content,  // not read, and geometry or images may be missing; a file that requires it is refused
};
ExtensionEffect getEffect(const std::string& name);

// Whether a picture lacks what the extension asks for.
bool isMissing(const std::string& name);

}  // namespace glim
