#pragma once

#include <string>

namespace glim {

std::string versionText();  // version, commit, build type

}  // namespace glim
