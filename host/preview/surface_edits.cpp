#include "host/preview/surface_edits.hpp"

#include "host/text.hpp"

#include <algorithm>
#include <array>

namespace glim {
namespace {

// As JSON.
template <std::size_t N>
std::string listOf(const std::array<float, N>& numbers)
{
    std::string text;
    for (const float number : numbers) {
        text += (text.empty() ? "[" : ",") + exactText(number);
    }
    return text + "]";
}

}  // namespace

ChosenSurface chooseSurface(const PrimitiveDescription& primitive, const Scene& scene, const SceneFile& file)
{
    // The factors of specular and glossiness are others.
    const bool hasFactors = !scene.materials[primitive.materialIndex].glossy;
    return {primitive.object + ", material " + primitive.material, primitive.node, primitive.materialIndex,
            file.pointerToNode(primitive.node), hasFactors ? file.pointerToMaterial(primitive.materialIndex) : std::nullopt};
}

SurfaceChoices choicesOf(const ChosenSurface& surface, const Scene& scene, const SceneFile& file)
{
    const Material& material = scene.materials[surface.material];
    return {glm::vec4(material.baseColor, material.alpha), material.metallic, material.roughness,
            surface.nodePointer ? glm::vec3(file.translationOf(surface.node)) : glm::vec3(0.0F)};
}

std::vector<Edit> listEdits(const ChosenSurface& surface, const SurfaceChoices& before, const SurfaceChoices& after)
{
    std::vector<Edit> edits;
    if (surface.materialPointer) {
        const std::string factors = *surface.materialPointer + "/pbrMetallicRoughness/";
        if (after.baseColor != before.baseColor) {
            const glm::vec4& color = after.baseColor;
            edits.push_back({factors + "baseColorFactor", listOf(std::array{color.r, color.g, color.b, color.a})});
        }
        if (after.metallic != before.metallic) {
            edits.push_back({factors + "metallicFactor", exactText(after.metallic)});
        }
        if (after.roughness != before.roughness) {
            edits.push_back({factors + "roughnessFactor", exactText(after.roughness)});
        }
    }
    if (surface.nodePointer && after.translation != before.translation) {
        edits.push_back(
            {*surface.nodePointer + "/translation", listOf(std::array{after.translation.x, after.translation.y, after.translation.z})});
    }
    return edits;
}

std::vector<Edit> withEdit(std::vector<Edit> edits, const Edit& edit)
{
    std::erase_if(edits, [&edit](const Edit& other) { return other.pointer == edit.pointer; });
    edits.push_back(edit);
    return edits;
}

std::vector<Edit> joinEdits(std::vector<Edit> first, const std::vector<Edit>& then)
{
    first.insert(first.end(), then.begin(), then.end());
    return first;
}

std::string editOptions(const std::vector<Edit>& edits)
{
    std::string options;
    for (const Edit& edit : edits) {
        std::string value = edit.value;
        std::erase_if(value, [](char c) { return c == '[' || c == ']'; });  // which shells would read
        options += " --set " + edit.pointer + "=" + value;
    }
    return options;
}

}  // namespace glim
