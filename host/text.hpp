// Numbers as text.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
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

// The shortest text that reads back as the same number.
template <class T>
std::string exactText(T value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// 16 digits.
inline std::string hexadecimal(std::uint64_t value)
{
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
    return digits;
}

// Of letters in ASCII.
inline std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// "1 sphere", "2 spheres".
inline std::string counted(std::size_t count, const std::string& noun)
{
    return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

// How many names a sentence lists, and what follows them: nothing or " and 4 more".
constexpr std::size_t kMaxListed = 20;
inline std::string moreThanListed(std::size_t count)
{
    return count > kMaxListed ? " and " + std::to_string(count - kMaxListed) + " more" : "";
}

}  // namespace glim
