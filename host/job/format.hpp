// Numbers in sentences.
#pragma once

#include <cstdio>
#include <string>

namespace glim {

// As printf; at most 255 bytes.
std::string format(const char* pattern, auto... values)
{
    char text[256];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

}  // namespace glim
