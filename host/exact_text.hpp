#pragma once

#include <charconv>
#include <string>

namespace glim {

// The shortest text that reads back as the same number.
template <class T>
std::string exactText(T value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace glim
