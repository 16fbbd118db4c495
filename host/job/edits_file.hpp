// Options that a file gives: of the scene, the camera, the lens, the time and the look, for whoever wants to show the scene so again.
#pragma once

#include "host/job/option_table.hpp"

namespace glim {

// --edits, to be added before the options that its file may give, as values of repeatable ones follow those of the file.
void addEdits(OptionTable& table);

}  // namespace glim
