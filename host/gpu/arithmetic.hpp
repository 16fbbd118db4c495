// How kernels compute on a device, so that results are the same on all.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct Arithmetic {
    // Quotients and roots by integers (shaders/lib/exact.glsl), since those of the device may be off by some ulp.
    bool exact = true;
    // The device lets kernels say that sums and products are rounded to nearest. Others are asked (film_identity.hpp).
    bool declaresRounding = false;
    // For tests: all that Vulkan leaves to the device is as bad as it allows, by this seed (host/spirv/adverse.hpp).
    std::optional<std::uint32_t> adverse;

    auto operator<=>(const Arithmetic&) const = default;
};

// What GLIM_ARITHMETIC asks for instead of a device's usual arithmetic: "exact", "native" (its own divisions and roots), "adverse:SEED"
// (which is exact too) or "native,adverse:SEED". Throws InputError.
Arithmetic parseArithmetic(Arithmetic usual, const std::string& asked);

// A kernel, its constants being set, as `arithmetic` says.
std::vector<std::uint32_t> computeBy(const Arithmetic& arithmetic, const std::vector<std::uint32_t>& kernel);

}  // namespace glim
