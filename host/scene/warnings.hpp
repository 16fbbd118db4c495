// Warnings, one line per kind, however many things it concerns.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace glim {

class Warnings {
public:
    void add(const std::string& sentence) { kinds_.push_back({sentence, {}}); }
    // One more thing that the sentence holds for.
    void add(const std::string& sentence, const std::string& name)
    {
        for (auto& [kind, names] : kinds_) {
            if (kind == sentence) {
                names.push_back(name);
                return;
            }
        }
        kinds_.push_back({sentence, {name}});
    }

    // "the sentence: first, second, third and 4 more", in the order in which each kind was met first.
    std::vector<std::string> lines() const
    {
        constexpr std::size_t kNamed = 3;
        std::vector<std::string> lines;
        for (const auto& [kind, names] : kinds_) {
            std::string line = kind;
            for (std::size_t i = 0; i < names.size() && i < kNamed; ++i) {
                line += (i == 0 ? ": " : ", ") + names[i];
            }
            lines.push_back(names.size() > kNamed ? line + " and " + std::to_string(names.size() - kNamed) + " more" : line);
        }
        return lines;
    }

private:
    std::vector<std::pair<std::string, std::vector<std::string>>> kinds_;
};

}  // namespace glim
