// The options that the scene is shown by, as the user changes them, and the way back.
#pragma once

#include "host/scene/load_gltf.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace glim {

class SceneChanges {
public:
    explicit SceneChanges(const LoadOptions& first)
        : options_(first)
    {}

    // Their time does not count: the timeline has it.
    const LoadOptions& options() const { return options_; }
    std::size_t count() const { return before_.size(); }

    // What changes within one action, as a drag, is undone at once.
    void change(const LoadOptions& options, std::uint64_t action)
    {
        if (before_.empty() || action != action_) {
            before_.push_back(options_);
        }
        action_ = action;
        options_ = options;
    }
    void undo()
    {
        options_ = std::move(before_.back());
        before_.pop_back();
        action_ = 0;
    }
    // After a refusal: the scene is as it is `shown`.
    void giveUp(LoadOptions shown)
    {
        shown.animation = options_.animation;
        shown.at = options_.at;
        std::erase(before_, shown);
        options_ = std::move(shown);
        action_ = 0;
    }

private:
    LoadOptions options_;
    std::vector<LoadOptions> before_;  // each of the user's actions
    std::uint64_t action_ = 0;         // of the last change; 0: none
};

}  // namespace glim
