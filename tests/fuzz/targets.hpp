// What is done with an input: fuzz_one_input.cpp calls it under libFuzzer, corpus_test.cpp for each file of the corpus.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace glim::fuzz {

using Bytes = std::span<const unsigned char>;

// load   a glTF scene
// build  the same and, of at most 100,000 triangles, the BVH and the flat scene
// film   a film: read, written again, merged with itself and with another
// image  PNG, JPEG, WebP, Radiance and OpenEXR
// ktx2   KTX2
// Returns how the input breaks the contract (contract.hpp) or an invariant.
std::optional<std::string> runTarget(const std::string& target, Bytes bytes);

}  // namespace glim::fuzz
