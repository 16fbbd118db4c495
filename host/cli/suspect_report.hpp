// The brightest samples of a render.
#pragma once

#include "host/cli/render_report.hpp"

#include <nlohmann/json_fwd.hpp>

namespace glim {

// A line each, if they were asked for.
void printSuspects(const RenderReport& report);
// Null if they were not.
nlohmann::ordered_json suspectsOf(const RenderReport& report);

}  // namespace glim
