#include "host/flatten/flatten_materials.hpp"

#include "host/error.hpp"
#include "host/fingerprint.hpp"
#include "host/flatten/media.hpp"
#include "host/image/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace glim {
namespace {

// Below this roughness a metal is a mirror: its alpha is below that of the GGX lobe's limit (lib/bsdf/ggx.glsl).
constexpr float kMirrorAlpha = 1e-3F;

static_assert(std::size(kTextureSlots) <= 32, "PrincipledData::textures has a bit for each");
static_assert([] {
    uint number = 0;
    return std::ranges::all_of(kTextureSlots, [&number](const TextureSlot& slot) { return slot.number == number++; });
}());

// The layers that the material has.
FeatureMask findLayers(const Material& m)
{
    return (m.clearcoat > 0.0F ? kFeatureClearcoat : 0U) | (m.sheenColor != glm::vec3(0.0F) ? kFeatureSheen : 0U) |
           (m.anisotropy > 0.0F ? kFeatureAnisotropy : 0U) | (m.iridescence > 0.0F ? kFeatureIridescence : 0U) |
           (m.transmission > 0.0F ? kFeatureTransmission : 0U) | (m.diffuseTransmission > 0.0F ? kFeatureDiffuseTransmission : 0U);
}

bool isSmooth(const Material& m) { return m.roughness * m.roughness < kMirrorAlpha && !m.textures[kSlotMetallicRoughness]; }

bool mayBeRough(const Material& m) { return !isSmooth(m) || m.anisotropy > 0.0F || m.glossy; }

// A smooth solid dielectric, tinted by the base colour, and nothing else.
bool isSmoothGlass(const Material& m)
{
    const bool textured =
        m.textures[kSlotTransmission] || m.textures[kSlotMetallicRoughness] || m.textures[kSlotSpecular] || m.textures[kSlotSpecularColor];
    return m.solid && m.transmission == 1.0F && m.metallic == 0.0F && m.specular == 1.0F && m.specularColor == glm::vec3(1.0F) &&
           m.roughness * m.roughness < kMirrorAlpha && !m.glossy && findLayers(m) == kFeatureTransmission && !textured;
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

static_assert(kMaxTextureBytes == (sizeof(std::uint32_t) * kMaxTexelViews) << kMaxTexelViewBits);

std::size_t countTexels(const DecodedImage& image)
{
    const std::size_t texels = std::size_t{image.width} * image.height;
    return image.rgba16.empty() ? texels : 2 * texels;
}

void appendTexels(std::vector<std::uint32_t>& texels, const DecodedImage& image)
{
    for (std::size_t i = 0; i < image.rgba8.size(); i += 4) {
        const std::uint8_t* t = &image.rgba8[i];
        texels.push_back(t[0] | t[1] << 8U | t[2] << 16U | static_cast<std::uint32_t>(t[3]) << 24U);
    }
    for (std::size_t i = 0; i < image.rgba16.size(); i += 2) {
        const std::uint32_t a = image.rgba16[i], b = image.rgba16[i + 1];
        texels.push_back(a >> 8U | (a & 0xffU) << 8U | (b >> 8U) << 16U | (b & 0xffU) << 24U);
    }
}

using Images = std::vector<std::shared_ptr<const DecodedImage>>;

bool areOf(const PackedImages& packed, const Images& images)
{
    return std::equal(packed.sources.begin(), packed.sources.end(), images.begin(), images.end(),
                      [](const auto& source, const auto& image) { return source.lock() == image; });
}

PackedImages packImages(const Images& images, std::size_t words)
{
    PackedImages packed;
    packed.sources.assign(images.begin(), images.end());
    packed.texels.reserve(words);
    for (const auto& image : images) {
        appendTexels(packed.texels, *image);
    }
    Fingerprint print;
    print.add(packed.texels);
    packed.fingerprint = print.state();
    return packed;
}

class MaterialFlattener {
public:
    MaterialFlattener(FlatScene& flat, const Scene& scene)
        : flat_(flat),
          scene_(scene),
          media_(findMedia(scene))
    {
        for (const TextureImage& image : scene.images) {
            colors_.push_back(oneColor(*image.pixels));
        }
        flat.imageBytes.assign(scene.images.size(), 0);
    }

    void add(std::uint32_t id, bool colored)
    {
        const Material& source = scene_.materials[id];
        Material material = source;
        foldTextures(material);
        leaveOutAbsentLayers(material);
        const bool textured = isTextured(material), tracked = media_.tracked && material.solid;
        features_ = 0;
        MaterialData data{};
        data.baseColor = material.baseColor;
        data.emission = material.emission;
        data.ior = material.transmission > 0.0F ? material.ior : kUnusedIor;
        const bool thin = passesStraight(source) && material.transmission > 0.0F;
        data.flags = (material.doubleSided ? kDoubleSided : 0U) | (thin ? kThinWall : 0U) | (material.isCatcher ? kCatcher : 0U) |
                     material.lightGroup << kLightGroupShift;
        data.type = chooseMaterialType(material);
        if ((textured || colored) && (data.type == kLambert || data.type == kMirror)) {
            data.type = kPrincipled;
        }
        if (material.alphaMode != AlphaMode::Opaque || material.unlit || thin) {
            data.alpha = material.alpha;
            data.alphaCutoff = material.alphaMode == AlphaMode::Mask    ? material.alphaCutoff
                               : material.alphaMode == AlphaMode::Blend ? kCoverage
                                                                        : kOpaque;
        }
        if (textured || colored || tracked || data.type == kPrincipled) {
            data.principled = static_cast<std::uint32_t>(flat_.principled.size() + 1);  // its place is known at the end
            flat_.principled.push_back(makePrincipled(material));
            if (findLayers(material) != 0 || tracked) {
                flat_.layers.push_back(makeLayers(material, media_.ofMaterial[id]));
                flat_.principled.back().layers = static_cast<std::uint32_t>(flat_.layers.size());
            }
            features_ |= kFeaturePrincipled | (material.glossy ? kFeatureGlossiness : 0U);
        }
        features_ |= data.type == kMirror ? kFeatureMirror : data.type == kDielectric ? kFeatureDielectric : 0U;
        features_ |= tracked ? kFeatureMedia | (media_.disperses ? kFeatureDispersion : 0U) : 0U;
        features_ |= tracked && scatters(media_.scattering[media_.ofMaterial[id] - 1]) ? kFeatureScattering : 0U;
        features_ |= material.unlit ? kFeatureUnlit : thin ? kFeatureThinWalls : 0U;
        flat_.materials.push_back(data);
        flat_.materialFeatures.push_back(features_);
    }

    // Turns counts into texels of the buffer: materials, principled, layers, textures, media. Packs the images, unless the scene has
    // those of another time.
    void finish()
    {
        if (!areOf(*flat_.images, images_)) {
            flat_.images = std::make_shared<PackedImages>(packImages(images_, texelCount_));
        }
        const auto first = static_cast<std::uint32_t>(flat_.materials.size() * kMaterialTexels);
        const auto firstLayers = first + static_cast<std::uint32_t>(flat_.principled.size() * kPrincipledTexels);
        const auto firstTexture = firstLayers + static_cast<std::uint32_t>(flat_.layers.size() * kLayersTexels);
        const auto place = [](std::uint32_t& number, std::uint32_t begin, std::uint32_t texels) {
            number = number == 0 ? 0 : begin + (number - 1) * texels;
        };
        for (MaterialData& data : flat_.materials) {
            place(data.principled, first, kPrincipledTexels);
        }
        for (PrincipledData& data : flat_.principled) {
            place(data.layers, firstLayers, kLayersTexels);
            place(data.firstTexture, firstTexture, kTextureTexels);
        }
        flat_.mediumOfMaterial.assign(scene_.materials.size(), 0);
        if (media_.tracked) {
            flat_.mediumOfMaterial = std::move(media_.ofMaterial);
            flat_.media = std::move(media_.media);
        }
        if (std::ranges::any_of(media_.scattering, scatters)) {
            flat_.scattering = std::move(media_.scattering);
        }
        flat_.firstMedium = firstTexture + static_cast<std::uint32_t>(flat_.textures.size() * kTextureTexels);
        flat_.firstScattering = flat_.firstMedium + static_cast<std::uint32_t>(flat_.media.size() * kMediumTexels);
    }

private:
    static constexpr float kUnusedIor = 1.5F;

    static bool scatters(const ScatteringData& data) { return data.albedo != vec3(0.0F); }

    // Images of one colour become part of the factors.
    void foldTextures(Material& m) const
    {
        for (const TextureSlot& slot : kTextureSlots) {
            std::optional<Texture>& texture = m.textures[slot.number];
            if (texture && colors_[texture->image] && slot.holds != TexelKind::Direction) {
                glm::dvec4 color = *colors_[texture->image];
                for (int c = 0; slot.holds == TexelKind::Color && c < 3; ++c) {
                    color[c] = linearFromSrgb(color[c]);
                }
                foldTexel(slot.number, color, m);
                texture.reset();
            }
        }
        if (m.glossy && !m.textures[kSlotSpecularColor]) {
            m.roughness = 1.0F - m.roughness;
            m.baseColor *= 1.0F - std::max({m.specularColor.r, m.specularColor.g, m.specularColor.b});
            m.glossy = false;
        }
    }

    // As applyTexel on the device (access/material.glsl), and what that leaves to others.
    static void foldTexel(uint slot, const glm::vec4& texel, Material& m)
    {
        const glm::vec3 rgb(texel);
        const float r = texel.r, g = texel.g, b = texel.b, a = texel.a;
#define TIMES(part, factor, channels) m.factor *= channels;
#define SLOT(number, name, holds, feature, path, times) \
    if (slot == kSlot##name) {                          \
        times                                           \
    }
        GLIM_TEXTURE_SLOTS(SLOT)
#undef SLOT
#undef TIMES
        m.alpha *= slot == kSlotBaseColor ? a : 1.0F;
        m.roughness *= slot == kSlotSpecularColor && m.glossy ? a : 1.0F;
        if (slot == kSlotIridescenceThickness) {
            m.iridescenceThicknessMaximum = std::lerp(m.iridescenceThicknessMinimum, m.iridescenceThicknessMaximum, g);
        }
    }

    // A factor of 0 gives the kernels and bits of a material without the extension.
    static void leaveOutAbsentLayers(Material& m)
    {
        for (const TextureSlot& slot : kTextureSlots) {
            if ((slot.feature & kLayerFeatures & ~findLayers(m)) != 0) {
                m.textures[slot.number].reset();
            }
        }
    }

    LayersData makeLayers(const Material& m, std::uint32_t medium)
    {
        LayersData data{};
        data.clearcoat = m.clearcoat;
        data.clearcoatRoughness = m.clearcoatRoughness;
        data.clearcoatNormalScale = m.clearcoatNormalScale;
        data.sheenColor = m.sheenColor;
        data.sheenRoughness = m.sheenRoughness;
        data.anisotropy = m.anisotropy;
        data.anisotropyCosine = std::cos(m.anisotropyRotation);
        data.anisotropySine = std::sin(m.anisotropyRotation);
        data.iridescence = m.iridescence;
        data.iridescenceIor = m.iridescenceIor;
        data.iridescenceThicknessMinimum = m.iridescenceThicknessMinimum;
        data.iridescenceThicknessMaximum = m.iridescenceThicknessMaximum;
        data.transmission = m.transmission;
        data.diffuseTransmission = m.diffuseTransmission;
        data.diffuseTransmissionColor = m.diffuseTransmissionColor;
        data.medium = medium;
        data.scattersThin = m.scattersThin ? 1 : 0;
        data.backscattered = m.scattersThin ? 0.5F - 0.5F * m.scatterAnisotropy : 0.0F;
        const bool principled = chooseMaterialType(m) == kPrincipled;
        features_ |= findLayers(m) & ~(principled ? 0U : kFeatureTransmission);
        features_ |= principled && m.transmission > 0.0F && mayBeRough(m) ? kFeatureRoughTransmission : 0U;
        return data;
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
        data.glossy = m.glossy ? 1 : 0;
        features_ |= m.textures[kSlotNormal] || m.textures[kSlotClearcoatNormal] ? kFeatureNormalMaps : 0U;
        for (const TextureSlot& slot : kTextureSlots) {
            if (const std::optional<Texture>& texture = m.textures[slot.number]) {
                addTexture(*texture, slot.holds == TexelKind::Color);
                data.firstTexture = data.textures == 0 ? static_cast<std::uint32_t>(flat_.textures.size()) : data.firstTexture;
                data.textures |= 1U << slot.number;
            }
        }
        return data;
    }

    void addTexture(const Texture& texture, bool srgb)
    {
        const DecodedImage& image = *scene_.images[texture.image].pixels;
        const bool transformed = texture.rowU != glm::vec3(1, 0, 0) || texture.rowV != glm::vec3(0, 1, 0);
        const bool wide = !image.rgba16.empty();
        TextureData data{};
        data.firstTexel = addImage(texture.image);
        data.size = image.width | image.height << 16U;
        data.flags = wrapBits(texture.wrapS) << kWrapS | wrapBits(texture.wrapT) << kWrapT | (texture.nearest ? kNearest : 0U) |
                     (srgb ? kSrgb : 0U) | (wide ? kWide : 0U) | (texture.uvSet == 1 ? kSecondUv : 0U) | (transformed ? kTransformed : 0U);
        data.rowU = texture.rowU;
        data.rowV = texture.rowV;
        flat_.textures.push_back(data);
        features_ |= kFeatureTextures | (transformed ? kFeatureTextureTransforms : 0U) | (wide ? kFeatureWideTextures : 0U);
    }

    static std::uint32_t wrapBits(Wrap wrap) { return wrap == Wrap::Clamp ? kClamp : wrap == Wrap::Mirrored ? kMirrored : kRepeat; }

    // Each image once, however many textures use it.
    std::uint32_t addImage(std::uint32_t id)
    {
        const auto [known, fresh] = firstTexels_.try_emplace(id, texelCount_);
        if (fresh) {
            flat_.imageBytes[id] = countTexels(*scene_.images[id].pixels) * sizeof(std::uint32_t);
            images_.push_back(scene_.images[id].pixels);
            texelCount_ += static_cast<std::uint32_t>(countTexels(*scene_.images[id].pixels));
        }
        return known->second;
    }

    FlatScene& flat_;
    const Scene& scene_;
    Media media_;
    FeatureMask features_ = 0;                            // of the material that is added
    std::vector<std::optional<glm::dvec4>> colors_;       // by image
    std::map<std::uint32_t, std::uint32_t> firstTexels_;  // by image
    Images images_;                                       // that textures use
    std::uint32_t texelCount_ = 0;                        // of these
};

}  // namespace

std::uint32_t chooseMaterialType(const Material& m)
{
    const bool plain = findLayers(m) == 0, smooth = isSmooth(m);
    if (m.unlit) {
        return kUnlit;
    }
    if (isSmoothGlass(m)) {
        return kDielectric;
    }
    if (plain && m.metallic == 0.0F && m.specular == 0.0F) {
        return kLambert;
    }
    return plain && m.metallic == 1.0F && smooth ? kMirror : kPrincipled;
}

bool passesStraight(const Material& m)
{
    const bool plain = (findLayers(m) & ~kFeatureDiffuseTransmission) == kFeatureTransmission && !m.textures[kSlotSpecular] &&
                       !m.textures[kSlotSpecularColor] && !m.glossy;
    return !m.unlit && !m.solid && !m.scattersThin && m.metallic < 1.0F && isSmooth(m) && plain;
}

bool scattersBehindSmoothBoundary(const Material& m)
{
    return m.solid && m.scattering != glm::vec3(0.0F) && m.transmission > 0.0F && isSmooth(m);
}

void flattenMaterials(FlatScene& flat, const Scene& scene, const std::vector<bool>& colored)
{
    MaterialFlattener flattener(flat, scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        flattener.add(static_cast<std::uint32_t>(i), colored[i]);
    }
    flattener.finish();
}

}  // namespace glim
