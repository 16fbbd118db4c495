// The table of an earlier run, in tests/bench/README.md as glim_rates printed it.
#pragma once

#include "host/bench/kernel_rates.hpp"

#include <optional>
#include <string>

namespace glim {

// The ratio to Embree's rate that `text` has under "## <device>" and "### <scene>" in the row of `rays`.
std::optional<Spread> findRecorded(const std::string& text, const std::string& device, const std::string& scene, const std::string& rays);

// "slower" or "faster" where all rounds were so, compared with all of those recorded.
std::string describeChange(const Spread& now, const Spread& recorded);

}  // namespace glim
