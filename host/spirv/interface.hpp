// What a kernel and its host must agree on.
#pragma once

#include "host/spirv/module.hpp"

#include <set>
#include <string>

namespace glim::spirv {

// Types are described by a text that says all that the host must know of them: kinds, sizes, offsets, strides.
struct Interface {
    std::map<std::uint32_t, std::set<std::string>> bindings;  // the types at each; declarations may share one
    std::map<std::uint32_t, std::string> names;               // of the bindings, in GLSL
    std::set<std::string> pushConstants;                      // one or none
    std::set<std::uint32_t> capabilities;                     // that it asks of the device
    std::string workgroup;                                    // its size, and the constants that set it
};

Interface readInterface(const Module& module);

// The first thing in which a kernel does not fit what the host has, as in "binding 7 (Nodes) is unknown to the host". Empty if it fits: it
// need not use all.
std::string findMisfit(const Interface& kernel, const Interface& host);

}  // namespace glim::spirv
