// The part of the controls that changes the surface which was clicked.
#pragma once

#include "host/preview/surface_edits.hpp"

#include <cstddef>
#include <string>

namespace glim {

// What it shows, and the user does not change there.
struct SurfaceFigures {
    std::string name;                           // with its material; empty: nothing was clicked
    bool hasMaterial = false, hasNode = false;  // that the user may change
    std::size_t hidden = 0;                     // nodes that the user hides
};

// Call it inside a panel. Returns `choices` with what the user changes in this frame.
SurfaceChoices changeSurface(const SurfaceFigures& figures, SurfaceChoices choices);

}  // namespace glim
