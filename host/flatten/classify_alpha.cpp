#include "host/flatten/classify_alpha.hpp"

#include "host/flatten/flatten_materials.hpp"

#include <algorithm>

namespace glim {
namespace {

float alphaOf(const DecodedImage& image, std::size_t texel)
{
    return image.rgba16.empty() ? static_cast<float>(image.rgba8[4 * texel + 3]) / 255.0F
                                : static_cast<float>(image.rgba16[4 * texel + 3]) / 65535.0F;
}

Coverage computeCoverage(const Material& material, float alpha)
{
    if (material.alphaMode == AlphaMode::Mask) {
        return alpha >= material.alphaCutoff ? Coverage::Opaque : Coverage::Transparent;
    }
    return alpha >= 1.0F ? Coverage::Opaque : alpha > 0.0F ? Coverage::Mixed : Coverage::Transparent;
}

bool hasAlpha(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners)
{
    return !mesh.colors.empty() && std::ranges::any_of(corners, [&](std::uint32_t corner) { return mesh.colors[corner].a != 1.0F; });
}

}  // namespace

const AlphaClassifier::Shares& AlphaClassifier::findShares(const Material& material)
{
    const Rule rule(material.textures[kSlotBaseColor]->image, material.alphaMode, material.alphaCutoff, material.alpha);
    const auto known = shares_.find(rule);
    if (known != shares_.end()) {
        return known->second;
    }
    const DecodedImage& image = *scene_.images[material.textures[kSlotBaseColor]->image].pixels;
    const auto sumsOf = [&](Coverage coverage) {
        return BoxSums(image.width, image.height, [&](std::uint32_t x, std::uint32_t y) {
            const float alpha = material.alpha * alphaOf(image, std::size_t{y} * image.width + x);
            return computeCoverage(material, alpha) == coverage ? 1U : 0U;
        });
    };
    return shares_.emplace(rule, Shares{sumsOf(Coverage::Opaque), sumsOf(Coverage::Transparent)}).first->second;
}

Coverage AlphaClassifier::classify(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners)
{
    const Material& material = scene_.materials[mesh.material];
    if (material.unlit || passesStraight(material)) {
        return Coverage::Mixed;
    }
    if (material.alphaMode == AlphaMode::Opaque) {
        return Coverage::Opaque;
    }
    if (hasAlpha(mesh, corners)) {
        return Coverage::Mixed;
    }
    if (!material.textures[kSlotBaseColor]) {
        return computeCoverage(material, material.alpha);
    }
    const Texture& texture = *material.textures[kSlotBaseColor];
    const std::vector<glm::vec2>& uv = texture.uvSet == 0 ? mesh.uv0 : mesh.uv1;
    glm::vec2 at[3] = {};
    for (std::size_t v = 0; v < 3 && !uv.empty(); ++v) {
        at[v] = uv[corners[v]];
    }
    const Shares& shares = findShares(material);
    const UvBox box = computeUvBox(texture, at);
    return shares.opaque.mean(box, texture) == 1.0        ? Coverage::Opaque
           : shares.transparent.mean(box, texture) == 1.0 ? Coverage::Transparent
                                                          : Coverage::Mixed;
}

Coverage AlphaClassifier::classify(std::uint32_t id, float vertexAlpha) const
{
    const Material& material = scene_.materials[id];
    return material.unlit || passesStraight(material) ? Coverage::Mixed
           : material.alphaMode == AlphaMode::Opaque  ? Coverage::Opaque
           : material.textures[kSlotBaseColor]        ? Coverage::Mixed
                                                      : computeCoverage(material, material.alpha * vertexAlpha);
}

}  // namespace glim
