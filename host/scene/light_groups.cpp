#include "host/scene/light_groups.hpp"

#include "host/error.hpp"
#include "host/text.hpp"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <set>

namespace glim {
namespace {

constexpr const char *kEnvironment = "environment", *kOption = "--light-group";

struct Emitter {
    std::string name;
    std::uint32_t* group;
    bool emits;
};

std::string nameOf(const std::string& name, const char* kind, std::size_t index)
{
    return name.empty() ? kind + std::to_string(index) : name;
}

std::vector<Emitter> findEmitters(Scene& scene)
{
    std::vector<Emitter> emitters;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        PunctualLight& light = scene.lights[i];
        emitters.push_back({nameOf(light.name, "light", i), &light.group, light.intensity != glm::vec3(0.0F)});
    }
    const std::vector<bool> used = findUsedMaterials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        if (used[i]) {
            emitters.push_back(
                {nameOf(material.name, "material", i), &material.lightGroup, material.emission != glm::vec3(0.0F) || material.unlit});
        }
    }
    if (scene.environment) {
        emitters.push_back({kEnvironment, &scene.environment->group, scene.environment->radiance != glm::vec3(0.0F)});
    }
    return emitters;
}

bool isNamed(const std::string& pattern, const std::string& name)
{
    return pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern;
}

bool holds(const LightGroup& group, const std::string& name)
{
    return std::ranges::any_of(group.lights, [&](const std::string& pattern) { return isNamed(pattern, name); });
}

// As a group can be called (parseLightGroup), and as no other is.
std::string groupNameOf(std::string name, const std::vector<LightGroup>& others)
{
    std::ranges::replace_if(
        name, [](unsigned char c) { return c <= ' ' || c == '.' || c == ',' || c == '=' || c == ':'; }, '_');
    std::string unique = name;
    for (int i = 2; unique == kOtherLights || std::ranges::any_of(others, [&](const LightGroup& g) { return g.name == unique; }); ++i) {
        unique = name + "_" + std::to_string(i);
    }
    return unique;
}

[[noreturn]] void refuseUnknown(const std::filesystem::path& path, const std::string& pattern, const std::vector<Emitter>& emitters)
{
    std::set<std::string> known;
    for (const Emitter& emitter : emitters) {
        if (emitter.emits) {
            known.insert(inQuotes(emitter.name));
        }
    }
    std::string list;
    std::size_t listed = 0;
    for (const std::string& name : known) {
        list += listed++ < kMaxListed ? (list.empty() ? "" : ", ") + name : "";
    }
    throw InputError(
        MessageId::UnknownName,
        {part::file(path), ": ", part::place(kOption), " ", part::quoted(pattern), ": no light and no material has this name; ",
         known.empty() ? part::expected("a scene with light") : part::expected("expected one of " + list + moreThanListed(known.size())),
         "."});
}

}  // namespace

std::vector<LightGroup> chooseLightGroups(const std::filesystem::path& path, const Scene& scene, const LightGroupChoice& choice)
{
    Scene copy;
    copy.lights = scene.lights;
    copy.materials = scene.materials;
    copy.meshes = scene.meshes;
    copy.spheres = scene.spheres;
    copy.environment = scene.environment;
    const std::vector<Emitter> emitters = findEmitters(copy);
    std::vector<LightGroup> groups = choice.groups;
    for (const LightGroup& group : groups) {
        for (const std::string& pattern : group.lights) {
            if (std::ranges::none_of(emitters, [&](const Emitter& emitter) { return isNamed(pattern, emitter.name); })) {
                refuseUnknown(path, pattern, emitters);
            }
        }
    }
    bool isLeft = !scene.animations.empty();  // what does not emit now may do so at another time
    for (const Emitter& emitter : emitters) {
        const auto holding = [&](const LightGroup& group) { return holds(group, emitter.name); };
        const auto first = std::ranges::find_if(groups, holding);
        if (first == groups.end() && emitter.emits && choice.each) {
            groups.push_back({groupNameOf(emitter.name, groups), {emitter.name}});
        } else if (first == groups.end()) {
            isLeft = isLeft || emitter.emits;
        } else if (const auto second = std::find_if(first + 1, groups.end(), holding); second != groups.end()) {
            throw InputError(MessageId::Duplicate,
                             {part::file(path), ": ", part::place(kOption), ": ", part::quoted(emitter.name), " is in the groups ",
                              first->name, " and ", second->name, ", expected ", part::expected("one group"), "."});
        }
    }
    if (isLeft) {
        groups.push_back({kOtherLights, {}});
    }
    if (groups.size() > kMaxLightGroups) {
        throw InputError(
            MessageId::OutOfRange,
            {part::file(path), ": ", part::place(kOption), ": the lights are in ", part::value(std::to_string(groups.size()) + " groups"),
             ", expected ", part::expected("at most " + std::to_string(kMaxLightGroups)), "; NAME=LIGHT,LIGHT puts several into one."});
    }
    return groups;
}

void assignLightGroups(Scene& scene, const std::vector<LightGroup>& groups)
{
    for (const LightGroup& group : groups) {
        scene.lightGroups.push_back(group.name);
    }
    for (const Emitter& emitter : findEmitters(scene)) {
        const auto found = std::ranges::find_if(groups, [&](const LightGroup& group) { return holds(group, emitter.name); });
        const auto number = static_cast<std::uint32_t>(found - groups.begin());
        *emitter.group = std::min(number, static_cast<std::uint32_t>(groups.size() - 1));
    }
}

}  // namespace glim
