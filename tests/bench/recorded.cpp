#include "tests/bench/recorded.hpp"

#include <cstdio>
#include <sstream>

namespace glim {
namespace {

bool startsWith(const std::string& line, const std::string& start) { return line.compare(0, start.size(), start) == 0; }

}  // namespace

std::optional<Spread> findRecorded(const std::string& text, const std::string& device, const std::string& scene, const std::string& rays)
{
    std::istringstream lines(text);
    bool isDevice = false, isScene = false;
    for (std::string line; std::getline(lines, line);) {
        if (startsWith(line, "## ")) {
            isDevice = line == "## " + device;
            isScene = false;
        } else if (startsWith(line, "### ")) {
            isScene = line == "### " + scene;
        }
        Spread ratio{};
        const std::string pattern = "| " + rays + " | %*f | %lf [%lf, %lf] |";
        if (isDevice && isScene && std::sscanf(line.c_str(), pattern.c_str(), &ratio.median, &ratio.low, &ratio.high) == 3) {
            return ratio;
        }
    }
    return std::nullopt;
}

std::string describeChange(const Spread& now, const Spread& recorded)
{
    return now.high < recorded.low ? "slower" : now.low > recorded.high ? "faster" : "the same";
}

}  // namespace glim
