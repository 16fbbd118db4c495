#include "host/preview/surface_edits.hpp"

#include "host/text.hpp"

#include <algorithm>
#include <array>

namespace glim {
namespace {

constexpr const char* kVisibility = "/extensions/KHR_node_visibility/visible";

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
    ChosenSurface surface{primitive.object + ", material " + primitive.material,
                          primitive.node,
                          primitive.materialIndex,
                          file.pointerToNode(primitive.node),
                          hasFactors ? file.pointerToMaterial(primitive.materialIndex) : std::nullopt,
                          {}};
    surface.choices = choicesOf(surface, scene, file);
    return surface;
}

SurfaceChoices choicesOf(const ChosenSurface& surface, const Scene& scene, const SceneFile& file)
{
    const Material& material = scene.materials[surface.material];
    SurfaceChoices choices;
    choices.baseColor = glm::vec4(material.baseColor, material.alpha);
    for (std::size_t i = 0; i < kMaterialFactors.size(); ++i) {
        choices.factors[i] = material.*kMaterialFactors[i].value;
    }
    choices.emissionStrength = std::max({1.0F, material.emission.r, material.emission.g, material.emission.b});
    choices.emission = material.emission / choices.emissionStrength;
    choices.hasStrength = !material.isDisplay;
    choices.translation = surface.nodePointer ? glm::vec3(file.translationOf(surface.node)) : glm::vec3(0.0F);
    return choices;
}

std::vector<Edit> listEdits(const ChosenSurface& surface, const SurfaceChoices& before, const SurfaceChoices& after)
{
    std::vector<Edit> edits;
    if (surface.materialPointer) {
        const auto add = [&](const std::string& pointer, const std::string& value) {
            edits.push_back({*surface.materialPointer + pointer, value});
        };
        if (after.baseColor != before.baseColor) {
            const glm::vec4& color = after.baseColor;
            add("/pbrMetallicRoughness/baseColorFactor", listOf(std::array{color.r, color.g, color.b, color.a}));
        }
        for (std::size_t i = 0; i < kMaterialFactors.size(); ++i) {
            if (after.factors[i] != before.factors[i]) {
                add(kMaterialFactors[i].pointer, exactText(after.factors[i]));
            }
        }
        if (after.emission != before.emission || after.emissionStrength != before.emissionStrength) {
            add("/emissiveFactor", listOf(std::array{after.emission.r, after.emission.g, after.emission.b}));
        }
        if ((after.emission != before.emission && after.hasStrength) || after.emissionStrength != before.emissionStrength) {
            add("/extensions/KHR_materials_emissive_strength/emissiveStrength", exactText(after.emissionStrength));
        }
    }
    if (surface.nodePointer && after.translation != before.translation) {
        edits.push_back(
            {*surface.nodePointer + "/translation", listOf(std::array{after.translation.x, after.translation.y, after.translation.z})});
    }
    if (surface.nodePointer && after.hides) {
        edits.push_back(hidingEdit(*surface.nodePointer));
    }
    return edits;
}

Edit hidingEdit(const std::string& nodePointer) { return {nodePointer + kVisibility, "false"}; }

bool hides(const Edit& edit) { return edit.pointer.ends_with(kVisibility) && edit.value == "false"; }

std::vector<Edit> withEdit(std::vector<Edit> edits, const Edit& edit)
{
    std::erase_if(edits, [&edit](const Edit& other) { return other.pointer == edit.pointer; });
    edits.push_back(edit);
    return edits;
}

}  // namespace glim
