// Checks whether a picture is far too dark or too bright at its exposure.
#pragma once

#include "host/message.hpp"
#include "host/render/aov.hpp"

#include <optional>

namespace glim {

// What is wrong with a PNG of the film in this look and at which exposure (EV) it would be right, as in "is burnt out: 80 % of what it
// shows is white; --exposure -9.4 shows it", which is what is expected. Nothing if it is right. Only pixels that show surfaces count, if
// there are any.
std::optional<Message> adviseExposure(const Film& film, const Look& look);

}  // namespace glim
