// Groups of lights, by which a film keeps what each of them gives. They are found by name: lights, materials that emit, the environment.
#pragma once

#include "host/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

struct LightGroup {
    std::string name;
    std::vector<std::string> lights;  // names, or their beginnings with a * behind; "environment" is the environment

    bool operator==(const LightGroup&) const = default;
};

struct LightGroupChoice {
    std::vector<LightGroup> groups;
    bool each = false;  // and each other light has a group of its own

    bool operator==(const LightGroupChoice&) const = default;
};

// In what is left of the lights, if something is, or may be at another time.
inline constexpr const char* kOtherLights = "others";

// Refuses names that the scene does not have, lights of two groups and more than kMaxLightGroups (InputError, which uses `path`).
std::vector<LightGroup> chooseLightGroups(const std::filesystem::path& path, const Scene& scene, const LightGroupChoice& choice);

// Tells lights, materials and environment of the scene, which may be at another time, their groups.
void assignLightGroups(Scene& scene, const std::vector<LightGroup>& groups);

}  // namespace glim
