// Warnings, one line per kind, however many things it concerns.
#pragma once

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glim {

class Warnings {
public:
    void add(const std::string& sentence)
    {
        places_.try_emplace(sentence, kinds_.size());
        kinds_.push_back({sentence, {}});
    }
    // One more thing that the sentence holds for.
    void add(const std::string& sentence, const std::string& name)
    {
        if (places_.count(sentence) == 0) {
            add(sentence);
        }
        kinds_[places_.at(sentence)].second.push_back(name);
    }
    void add(const Warnings& others)
    {
        for (const auto& [sentence, names] : others.kinds_) {
            if (names.empty()) {
                add(sentence);
            }
            for (const std::string& name : names) {
                add(sentence, name);
            }
        }
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
    std::unordered_map<std::string, std::size_t> places_;  // of each sentence in kinds_
};

}  // namespace glim
