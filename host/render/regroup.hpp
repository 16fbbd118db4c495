// Films with light groups as if their lights had other strengths or colours.
#pragma once

#include "host/render/film.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

// What the light of a group is multiplied by.
struct LightWeight {
    std::string group;
    glm::vec3 factor{1.0F};  // finite, >= 0
};

// One for each group of the film, in their order; 1 for those that `weights` does not name. Refuses groups that it does not have
// (InputError, which uses `name`).
std::vector<glm::vec3> factorsOf(const std::filesystem::path& name, const Film& film, const std::vector<LightWeight>& weights);

// Means and, from the products of each pair of groups, the spread of block means, so that its errors are those of a render with these
// lights. Without groups and shadow catchers, whose alpha is of the lights as they were; `clamped` is the most that may have been taken
// away. Its settings name the factors.
Film regroup(const Film& film, const std::vector<glm::vec3>& factors);

}  // namespace glim
