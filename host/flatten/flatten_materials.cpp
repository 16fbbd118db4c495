#include "host/flatten/flatten_materials.hpp"

#include "host/error.hpp"

#include <cmath>
#include <map>

namespace glim {
namespace {

// Below this roughness a metal is a mirror: its alpha is below that of the GGX lobe's limit (lib/bsdf/ggx.glsl).
constexpr float kMirrorAlpha = 1e-3F;

double linearFromSrgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

bool isTextured(const Material& material)
{
    for (const auto* texture : texturesOf(material)) {
        if (texture->has_value()) {
            return true;
        }
    }
    return false;
}

// The one colour of an image, if it has no other: in [0, 1], as stored.
std::optional<glm::dvec4> oneColor(const DecodedImage& image)
{
    const auto find = [](const auto& values, double most) -> std::optional<glm::dvec4> {
        for (std::size_t i = 4; i < values.size(); ++i) {
            if (values[i] != values[i - 4]) {
                return std::nullopt;
            }
        }
        return glm::dvec4(values[0], values[1], values[2], values[3]) / most;
    };
    return image.rgba16.empty() ? find(image.rgba8, 255.0) : find(image.rgba16, 65535.0);
}

class MaterialFlattener {
public:
    MaterialFlattener(FlatScene& flat, const Scene& scene)
        : flat_(flat),
          scene_(scene)
    {
        for (const TextureImage& image : scene.images) {
            colors_.push_back(oneColor(image.pixels));
        }
    }

    void add(const Material& source, bool colored)
    {
        Material material = source;
        foldTextures(material);
        const bool textured = isTextured(material);
        MaterialData data{};
        data.baseColor = material.baseColor;
        data.emission = material.emission;
        data.ior = material.glass ? material.ior : kUnusedIor;
        data.doubleSided = material.doubleSided ? 1 : 0;
        data.lobe = textured || colored ? (material.glass ? kDielectric : kPrincipled) : lobeOf(material);
        if (material.alphaMode != AlphaMode::Opaque) {
            data.alpha = material.alpha;
            data.alphaCutoff = material.alphaMode == AlphaMode::Mask ? material.alphaCutoff : -1.0F;
        }
        if (textured || colored || data.lobe == kPrincipled) {
            data.principled = static_cast<std::uint32_t>(flat_.principled.size() + 1);  // its place is known at the end
            flat_.principled.push_back(makePrincipled(material));
        }
        flat_.materials.push_back(data);
    }

    // Turns counts into texels of the buffer: materials, principled, textures.
    void finish()
    {
        const auto first = static_cast<std::uint32_t>(flat_.materials.size() * kMaterialTexels);
        const auto firstTexture = first + static_cast<std::uint32_t>(flat_.principled.size() * kPrincipledTexels);
        for (MaterialData& data : flat_.materials) {
            data.principled = data.principled == 0 ? 0 : first + (data.principled - 1) * kPrincipledTexels;
        }
        for (PrincipledData& data : flat_.principled) {
            for (std::uint32_t* texture : {&data.baseColorTexture, &data.metallicRoughnessTexture, &data.normalTexture,
                                           &data.emissiveTexture, &data.specularTexture, &data.specularColorTexture}) {
                *texture = *texture == 0 ? 0 : firstTexture + (*texture - 1) * kTextureTexels;
            }
        }
    }

private:
    static constexpr float kUnusedIor = 1.5F;

    // A colour is fetched by `multiply`, which gets it as a linear one if `srgb`.
    template <class Multiply>
    void fold(std::optional<Texture>& texture, bool srgb, const Multiply& multiply)
    {
        if (!texture || !colors_[texture->image]) {
            return;
        }
        glm::dvec4 color = *colors_[texture->image];
        for (int c = 0; srgb && c < 3; ++c) {
            color[c] = linearFromSrgb(color[c]);
        }
        multiply(color);
        texture.reset();
    }

    void foldTextures(Material& m)
    {
        fold(m.baseColorTexture, true, [&m](const glm::dvec4& color) {
            m.baseColor *= glm::vec3(color);
            m.alpha *= static_cast<float>(color.a);
        });
        fold(m.metallicRoughnessTexture, false, [&m](const glm::dvec4& color) {
            m.roughness *= static_cast<float>(color.g);
            m.metallic *= static_cast<float>(color.b);
        });
        fold(m.emissiveTexture, true, [&m](const glm::dvec4& color) { m.emission *= glm::vec3(color); });
        fold(m.specularTexture, false, [&m](const glm::dvec4& color) { m.specular *= static_cast<float>(color.a); });
        fold(m.specularColorTexture, true, [&m](const glm::dvec4& color) { m.specularColor *= glm::vec3(color); });
    }

    PrincipledData makePrincipled(const Material& m)
    {
        PrincipledData data{};
        data.metallic = m.metallic;
        data.roughness = m.roughness;
        const double ior = static_cast<double>(m.ior);
        data.reflectance = static_cast<float>(std::pow((ior - 1.0) / (ior + 1.0), 2.0));
        data.specular = m.specular;
        data.specularColor = m.specularColor;
        data.normalScale = m.normalScale;
        data.baseColorTexture = addTexture(m.baseColorTexture, true);
        data.metallicRoughnessTexture = addTexture(m.metallicRoughnessTexture, false);
        data.normalTexture = addTexture(m.normalTexture, false);
        data.emissiveTexture = addTexture(m.emissiveTexture, true);
        data.specularTexture = addTexture(m.specularTexture, false);
        data.specularColorTexture = addTexture(m.specularColorTexture, true);
        flat_.features |= data.normalTexture != 0 ? kFeatureNormalMaps : 0U;
        return data;
    }

    // Its number from 1 on, or 0.
    std::uint32_t addTexture(const std::optional<Texture>& texture, bool srgb)
    {
        if (!texture) {
            return 0;
        }
        const DecodedImage& image = scene_.images[texture->image].pixels;
        const bool transformed = texture->rowU != glm::vec3(1, 0, 0) || texture->rowV != glm::vec3(0, 1, 0);
        const bool wide = !image.rgba16.empty();
        TextureData data{};
        data.firstTexel = addImage(texture->image);
        data.size = image.width | image.height << 16U;
        data.flags = wrapBits(texture->wrapS) << kWrapS | wrapBits(texture->wrapT) << kWrapT | (texture->nearest ? kNearest : 0U) |
                     (srgb ? kSrgb : 0U) | (wide ? kWide : 0U) | (texture->uvSet == 1 ? kSecondUv : 0U) | (transformed ? kTransformed : 0U);
        data.rowU = texture->rowU;
        data.rowV = texture->rowV;
        flat_.textures.push_back(data);
        flat_.features |= kFeatureTextures | (transformed ? kFeatureTextureTransforms : 0U) | (wide ? kFeatureWideTextures : 0U);
        return static_cast<std::uint32_t>(flat_.textures.size());
    }

    static std::uint32_t wrapBits(Wrap wrap) { return wrap == Wrap::Clamp ? kClamp : wrap == Wrap::Mirrored ? kMirrored : kRepeat; }

    // Each image once, however many textures use it.
    std::uint32_t addImage(std::uint32_t id)
    {
        const auto [known, fresh] = firstTexels_.try_emplace(id, static_cast<std::uint32_t>(flat_.texels.size()));
        if (!fresh) {
            return known->second;
        }
        const DecodedImage& image = scene_.images[id].pixels;
        const std::size_t texels = std::size_t{image.width} * image.height, words = image.rgba16.empty() ? texels : 2 * texels;
        constexpr std::size_t kMost = std::size_t{kMaxTexelViews} << kTexelViewBits;
        if (flat_.texels.size() + words > kMost) {
            throw InputError(scene_.file + ": its images have more than " + std::to_string(kMost) +
                             " texels; expected fewer (--max-texture N scales them down)");
        }
        flat_.texels.reserve(flat_.texels.size() + words);
        for (std::size_t i = 0; i < texels; ++i) {
            if (image.rgba16.empty()) {
                const std::uint8_t* t = &image.rgba8[4 * i];
                flat_.texels.push_back(t[0] | t[1] << 8U | t[2] << 16U | static_cast<std::uint32_t>(t[3]) << 24U);
            } else {
                const std::uint16_t* t = &image.rgba16[4 * i];
                const auto bytes = [](std::uint32_t a, std::uint32_t b) {
                    return a >> 8U | (a & 0xffU) << 8U | (b >> 8U) << 16U | (b & 0xffU) << 24U;
                };
                flat_.texels.push_back(bytes(t[0], t[1]));
                flat_.texels.push_back(bytes(t[2], t[3]));
            }
        }
        return known->second;
    }

    FlatScene& flat_;
    const Scene& scene_;
    std::vector<std::optional<glm::dvec4>> colors_;       // by image
    std::map<std::uint32_t, std::uint32_t> firstTexels_;  // by image
};

}  // namespace

std::uint32_t lobeOf(const Material& m)
{
    if (m.glass) {
        return kDielectric;
    }
    if (m.metallic == 0.0F && m.specular == 0.0F) {
        return kLambert;
    }
    return m.metallic == 1.0F && m.roughness * m.roughness < kMirrorAlpha ? kMirror : kPrincipled;
}

void flattenMaterials(FlatScene& flat, const Scene& scene, const std::vector<bool>& colored)
{
    MaterialFlattener flattener(flat, scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        flattener.add(scene.materials[i], colored[i]);
    }
    flattener.finish();
}

std::uint32_t featuresOf(const FlatScene& flat, std::uint32_t material)
{
    const MaterialData& data = flat.materials[material];
    const std::uint32_t lobe = data.lobe == kMirror ? kFeatureMirror : data.lobe == kDielectric ? kFeatureDielectric : 0U;
    return lobe | (data.principled != 0 ? kFeaturePrincipled : 0U);
}

}  // namespace glim
