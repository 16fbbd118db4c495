// Makes a guide of what paths have written down.
#pragma once

#include "host/render/guide.hpp"
#include "shaders/shared/guide_types.h"

#include <span>

namespace glim {

// One that knows nothing: it guides no path.
Guide emptyGuide();

// The order of the records is part of what it depends on. Records without throughput, and those that are not finite, are left out.
Guide buildGuide(std::span<const GuideRecord> records);

}  // namespace glim
