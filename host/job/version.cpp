#include "host/job/version.hpp"

#include "commit.h"
#include "version.h"

namespace glim {

std::string versionText() { return "glim " GLIM_VERSION " (commit " GLIM_COMMIT ", " GLIM_BUILD_TYPE " build)"; }

}  // namespace glim
