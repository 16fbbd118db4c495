// Mutants of OpenEXR files whose header and table of rows still fit together.
#pragma once

#include "tests/fuzz/mutator.hpp"

#include <string>

namespace glim::fuzz {

// Changes attributes of the header, and sometimes what follows it. A file without such a header gets a blind mutant.
void mutateExr(std::string& bytes, Choice& choice);

}  // namespace glim::fuzz
