// Numbers and words as text.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

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

// The fewest letters to insert, delete, replace or swap with their neighbour that make one word of the other (the optimal string alignment
// distance).
inline std::size_t editDistance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> before, last, row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
    }
    return row.back();
}

// What a word that is none of the known ones was probably meant to be: at most one letter or a third of them differ, or it is the beginning
// of one alone. Empty: nothing is near.
inline std::string nearestOf(const std::string& word, const std::vector<std::string>& known)
{
    const auto begins = [&word](const std::string& other) { return word.size() >= 3 && other.starts_with(word); };
    std::string nearest;
    std::size_t least = std::max<std::size_t>(word.size() / 3, 1) + 1;
    for (const std::string& other : known) {
        const bool isAlone = begins(other) && std::ranges::count_if(known, begins) == 1;
        if (const std::size_t distance = isAlone ? 0 : editDistance(word, other); distance < least) {
            least = distance;
            nearest = other;
        }
    }
    return nearest;
}

// How many names a sentence lists, and what follows them: nothing or " and 4 more".
constexpr std::size_t kMaxListed = 20;
inline std::string moreThanListed(std::size_t count)
{
    return count > kMaxListed ? " and " + std::to_string(count - kMaxListed) + " more" : "";
}

}  // namespace glim
