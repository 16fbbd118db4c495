// Nothing waits for a reader that does not read: a terminal that is stopped, a pipe that is full.
#pragma once

namespace glim {

// Whether a line can be written to `file` within so long.
bool takesMore(int file, int milliseconds = 0);

}  // namespace glim
