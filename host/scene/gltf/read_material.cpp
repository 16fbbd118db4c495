#include "host/scene/gltf/read_material.hpp"

#include "host/message.hpp"
#include "host/scene/gltf/extensions.hpp"
#include "host/scene/gltf/gltf_schema.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>

namespace glim {
namespace {

constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kTransmission = "KHR_materials_transmission";
constexpr const char* kVolume = "KHR_materials_volume";
constexpr const char* kDiffuseTransmission = "KHR_materials_diffuse_transmission";
constexpr const char* kClearcoat = "KHR_materials_clearcoat";
constexpr const char* kSheen = "KHR_materials_sheen";
constexpr const char* kAnisotropy = "KHR_materials_anisotropy";
constexpr const char* kIridescence = "KHR_materials_iridescence";
constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* kScatter = "KHR_materials_scatter";  // and the drafts before it:
constexpr const char* kVolumeScatter = "KHR_materials_volume_scatter";
constexpr const char* kSubsurface = "KHR_materials_subsurface";
constexpr const char* kSss = "KHR_materials_sss";  // the same, by its first name
constexpr const char* kScatterTextures[] = {"scatterStrengthTexture", "scatterTexture", "multiscatterColorTexture"};

constexpr double kMinAttenuation = 1e-6;  // of a channel: black would absorb all at once
constexpr float kMostAnisotropy = 0.999F;

const tinygltf::Value* findProperty(const tinygltf::Material& source, const std::string& extension, const std::string& name)
{
    const auto found = source.extensions.find(extension);
    return found == source.extensions.end() || !found->second.Has(name) ? nullptr : &found->second.Get(name);
}

float numberOr(const tinygltf::Material& source, const char* extension, const char* name, double fallback)
{
    const tinygltf::Value* value = findProperty(source, extension, name);
    return static_cast<float>(value == nullptr ? fallback : value->GetNumberAsDouble());
}

glm::vec3 colorOr(const tinygltf::Material& source, const char* extension, const char* name, const glm::vec3& fallback)
{
    const tinygltf::Value* value = findProperty(source, extension, name);
    glm::vec3 color = fallback;
    for (int c = 0; value != nullptr && c < 3; ++c) {
        color[c] = static_cast<float>(value->Get(c).GetNumberAsDouble());
    }
    return color;
}

// The albedo of one scattering in a medium that has this colour where it is thick: Kulla and Conty, "Revisiting Physically Based Shading at
// Imageworks", 2017. Their fit is off by 4e-6 at its ends.
glm::dvec3 singleScatteringAlbedo(const glm::dvec3& color, double anisotropy)
{
    const glm::dvec3 root = glm::sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
    const glm::dvec3 s = glm::clamp(4.09712 + 4.20863 * color - root, 0.0, 1.0), s2 = s * s;
    return glm::mix((1.0 - s2) / (1.0 - anisotropy * s2), glm::dvec3(0.0), glm::equal(color, glm::dvec3(0.0)));
}

// KHR_texture_transform: translation * rotation * scale, counter-clockwise in uv.
void transformTexture(const tinygltf::Value& transform, Texture& texture)
{
    const auto pair = [&transform](const char* name, double fallback) {
        return transform.Has(name)
                   ? glm::dvec2(transform.Get(name).Get(0).GetNumberAsDouble(), transform.Get(name).Get(1).GetNumberAsDouble())
                   : glm::dvec2(fallback);
    };
    const glm::dvec2 offset = pair("offset", 0.0), scale = pair("scale", 1.0);
    const double rotation = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
    const double c = std::cos(rotation), s = std::sin(rotation);
    texture.rowU = glm::dvec3(c * scale.x, s * scale.y, offset.x);
    texture.rowV = glm::dvec3(-s * scale.x, c * scale.y, offset.y);
    if (transform.Has("texCoord")) {
        texture.uvSet = static_cast<std::uint32_t>(transform.Get("texCoord").GetNumberAsInt());
    }
}

class MaterialReader {
public:
    MaterialReader(const GltfFile& file, const tinygltf::Material& source, std::string place, Warnings& warnings)
        : file_(file),
          source_(source),
          place_(std::move(place)),
          warnings_(warnings)
    {}

    Material read();

private:
    void readTextures(Material& material);
    std::optional<Texture> readTexture(int index, int uvSet, const tinygltf::Value* transform);
    std::optional<Texture> readTexture(std::string_view path);
    template <class Info>
    std::optional<Texture> readTexture(const Info& info)
    {
        const auto transform = info.extensions.find("KHR_texture_transform");
        return readTexture(info.index, info.texCoord, transform == info.extensions.end() ? nullptr : &transform->second);
    }
    void readTransmission(Material& material);
    void readScattering(Material& material);
    void readThinScattering(Material& material);
    float readStrength() const;
    glm::vec3 readCoefficient(const char* extension, const char* color, const char* distance) const;
    std::optional<glm::dvec3> readAlbedo(double anisotropy) const;
    void readLayers(Material& material);
    void readGlossiness(Material& material);
    void chooseUvSets(Material& material);
    void warnOfExtensions(const Material& material);
    void ignore(bool condition, MessageId id, const std::string& what)
    {
        if (condition) {
            warnings_.add(id, what, place_);
        }
    }

    const GltfFile& file_;
    const tinygltf::Material& source_;
    std::string place_;
    Warnings& warnings_;
};

std::optional<Texture> MaterialReader::readTexture(int index, int uvSet, const tinygltf::Value* transform)
{
    if (index < 0) {
        return std::nullopt;
    }
    const GltfTexture& source = file_.textures[static_cast<std::size_t>(index)];
    if (!source.image) {
        ignore(true, MessageId::TextureWithoutSource, "textures without a source are ignored");
        return std::nullopt;
    }
    Texture texture;
    texture.image = static_cast<std::uint32_t>(*source.image);
    texture.uvSet = static_cast<std::uint32_t>(uvSet);
    texture.wrapS = source.wrapS;
    texture.wrapT = source.wrapT;
    texture.nearest = source.nearest;
    if (transform != nullptr) {
        transformTexture(*transform, texture);
    }
    return texture;
}

// `path`: of an extension, as in gltf_schema.hpp.
std::optional<Texture> MaterialReader::readTexture(std::string_view path)
{
    const std::size_t extension = path.find('.') + 1, name = path.find('.', extension) + 1;
    const tinygltf::Value* info =
        findProperty(source_, std::string(path.substr(extension, name - 1 - extension)), std::string(path.substr(name)));
    if (info == nullptr) {
        return std::nullopt;
    }
    const tinygltf::Value* transform = nullptr;
    if (info->Has("extensions") && info->Get("extensions").Has("KHR_texture_transform")) {
        transform = &info->Get("extensions").Get("KHR_texture_transform");
    }
    return readTexture(info->Get("index").GetNumberAsInt(), info->Has("texCoord") ? info->Get("texCoord").GetNumberAsInt() : 0, transform);
}

void MaterialReader::readTextures(Material& material)
{
    for (const TextureSlot& slot : kTextureSlots) {
        if (slot.path.starts_with("extensions.")) {
            material.textures[slot.number] = readTexture(slot.path);
        }
    }
    // The core's are members of tinygltf's material.
    material.textures[kSlotBaseColor] = readTexture(source_.pbrMetallicRoughness.baseColorTexture);
    material.textures[kSlotMetallicRoughness] = readTexture(source_.pbrMetallicRoughness.metallicRoughnessTexture);
    material.textures[kSlotNormal] = readTexture(source_.normalTexture);
    material.textures[kSlotEmissive] = readTexture(source_.emissiveTexture);
    material.normalScale = static_cast<float>(source_.normalTexture.scale);
}

void MaterialReader::readTransmission(Material& material)
{
    material.ior = numberOr(source_, "KHR_materials_ior", "ior", 1.5);
    if (material.ior < 1.0F && 1.0 - static_cast<double>(material.ior) <= kFileRounding) {
        warnings_.add(MessageId::NumberClamped, kClamped, place_ + " (index of refraction)");
        material.ior = 1.0F;
    }
    if (material.ior < 1.0F && material.ior != 0.0F) {
        refuse(file_, MessageId::OutOfRange,
               {part::place(place_), " has the index of refraction ", part::value(toText(material.ior)), "; expected ",
                part::expected("0 or at least 1")});
    }
    material.transmission = numberOr(source_, kTransmission, "transmissionFactor", 0.0);
    material.diffuseTransmission = numberOr(source_, kDiffuseTransmission, "diffuseTransmissionFactor", 0.0);
    material.diffuseTransmissionColor = colorOr(source_, kDiffuseTransmission, "diffuseTransmissionColorFactor", glm::vec3(1.0F));
    const bool transmits = material.transmission > 0.0F || material.diffuseTransmission > 0.0F;
    material.thick = numberOr(source_, kVolume, "thicknessFactor", 0.0) > 0.0F;
    material.solid = transmits && material.thick;
    if (!material.solid) {
        readThinScattering(material);
        return;
    }
    if (material.ior == 0.0F) {
        refuse(file_, MessageId::OutOfRange,
               {part::place(place_), " is glass with the index of refraction ", part::value("0"), "; expected ",
                part::expected("at least 1")});
    }
    material.absorption = readCoefficient(kVolume, "attenuationColor", "attenuationDistance");
    readScattering(material);
    material.dispersion = numberOr(source_, "KHR_materials_dispersion", "dispersion", 0.0);
}

// Per metre: `color` is left after `distance`. Without one it is endless.
glm::vec3 MaterialReader::readCoefficient(const char* extension, const char* color, const char* distance) const
{
    const tinygltf::Value* metres = findProperty(source_, extension, distance);
    if (metres == nullptr) {
        return glm::vec3(0.0F);
    }
    const glm::dvec3 left = glm::max(glm::dvec3(colorOr(source_, extension, color, glm::vec3(1.0F))), kMinAttenuation);
    return glm::min((0.0 - glm::log(left)) / metres->GetNumberAsDouble(), 1e30);  // no -0
}

// Of KHR_materials_scatter; its schema has another name than its text.
float MaterialReader::readStrength() const
{
    return numberOr(source_, kScatter, "scatterStrengthFactor", numberOr(source_, kScatter, "scatterFactor", 0.0));
}

void MaterialReader::readThinScattering(Material& material)
{
    if (source_.extensions.count(kScatter) == 0 || material.transmission == 0.0F) {
        return;
    }
    material.scattersThin = true;
    material.scatterAnisotropy = numberOr(source_, kScatter, "scatterAnisotropy", 0.0);
    material.diffuseTransmission = readStrength();
    material.diffuseTransmissionColor = colorOr(source_, kScatter, "multiscatterColorFactor", glm::vec3(1.0F));
    const bool isDraft = findProperty(source_, kScatter, "scatterStrengthTexture") == nullptr;
    material.textures[kSlotDiffuseTransmission] = readTexture(isDraft ? kScatterDraftTexture : kScatterStrengthTexture);
    material.textures[kSlotDiffuseTransmissionColor] = readTexture(kScatterColorTexture);
}

// Of one scattering in the medium, if the material names a colour from which it follows.
std::optional<glm::dvec3> MaterialReader::readAlbedo(double anisotropy) const
{
    if (source_.extensions.count(kScatter) > 0) {
        return singleScatteringAlbedo(readStrength() * colorOr(source_, kScatter, "multiscatterColorFactor", glm::vec3(1.0F)), anisotropy);
    }
    if (source_.extensions.count(kVolumeScatter) > 0) {
        const glm::vec3 color = colorOr(source_, kVolumeScatter, "multiscatterColorFactor", glm::vec3(0.0F));
        return singleScatteringAlbedo(colorOr(source_, kVolumeScatter, "multiscatterColor", color), 0.0);
    }
    if (findProperty(source_, kSss, "subsurfaceColor") != nullptr) {
        return singleScatteringAlbedo(colorOr(source_, kSss, "subsurfaceColor", glm::vec3(0.0F)), 0.0);
    }
    return std::nullopt;
}

// The drafts differ in what KHR_materials_volume's attenuation is beside them: the whole extinction, of which the albedo scatters (glTF's
// pull requests 2453 and 2579), or absorption, beside a coefficient of scattering (1928).
void MaterialReader::readScattering(Material& material)
{
    const bool isNewest = source_.extensions.count(kScatter) > 0;
    const float anisotropy = numberOr(source_, isNewest ? kScatter : kVolumeScatter, "scatterAnisotropy", 0.0);
    material.scatterAnisotropy = std::clamp(anisotropy, -kMostAnisotropy, kMostAnisotropy);
    if (const std::optional<glm::dvec3> albedo = readAlbedo(static_cast<double>(material.scatterAnisotropy))) {
        const glm::dvec3 extinction = material.absorption;
        material.scattering = extinction * *albedo;
        material.absorption = extinction * (1.0 - *albedo);
    } else {
        const char* const draft = source_.extensions.count(kSubsurface) > 0 ? kSubsurface : kSss;
        material.scattering = readCoefficient(draft, "scatterColor", "scatterDistance");
    }
    const char* const textured = isNewest ? kScatter : kVolumeScatter;
    ignore(std::ranges::any_of(kScatterTextures, [&](const char* name) { return findProperty(source_, textured, name) != nullptr; }),
           MessageId::VolumeTextureIgnored, "textures of what is within a solid are ignored: its factors hold throughout");
}

void MaterialReader::readLayers(Material& material)
{
    material.clearcoat = numberOr(source_, kClearcoat, "clearcoatFactor", 0.0);
    material.clearcoatRoughness = numberOr(source_, kClearcoat, "clearcoatRoughnessFactor", 0.0);
    const tinygltf::Value* normal = findProperty(source_, kClearcoat, "clearcoatNormalTexture");
    if (normal != nullptr && normal->Has("scale")) {
        material.clearcoatNormalScale = static_cast<float>(normal->Get("scale").GetNumberAsDouble());
    }
    material.sheenColor = colorOr(source_, kSheen, "sheenColorFactor", glm::vec3(0.0F));
    material.sheenRoughness = numberOr(source_, kSheen, "sheenRoughnessFactor", 0.0);
    material.anisotropy = numberOr(source_, kAnisotropy, "anisotropyStrength", 0.0);
    material.anisotropyRotation = numberOr(source_, kAnisotropy, "anisotropyRotation", 0.0);
    material.iridescence = numberOr(source_, kIridescence, "iridescenceFactor", 0.0);
    material.iridescenceIor = numberOr(source_, kIridescence, "iridescenceIor", 1.3);
    material.iridescenceThicknessMinimum = numberOr(source_, kIridescence, "iridescenceThicknessMinimum", 100.0);
    material.iridescenceThicknessMaximum = numberOr(source_, kIridescence, "iridescenceThicknessMaximum", 400.0);
}

// Replaces metallic and roughness, where the file has both: KHR_materials_pbrSpecularGlossiness is the better version of the two.
void MaterialReader::readGlossiness(Material& material)
{
    if (source_.extensions.count(kGlossiness) == 0) {
        return;
    }
    material.glossy = true;
    material.metallic = 0.0F;
    material.ior = 0.0F;  // reflects by the specular colour alone
    material.specular = 1.0F;
    material.roughness = numberOr(source_, kGlossiness, "glossinessFactor", 1.0);
    material.specularColor = colorOr(source_, kGlossiness, "specularFactor", glm::vec3(1.0F));
    material.baseColor = colorOr(source_, kGlossiness, "diffuseFactor", glm::vec3(1.0F));
    const tinygltf::Value* diffuse = findProperty(source_, kGlossiness, "diffuseFactor");
    material.alpha = diffuse == nullptr ? 1.0F : static_cast<float>(diffuse->Get(3).GetNumberAsDouble());
    material.textures[kSlotBaseColor] = readTexture(kGlossinessColor);
    material.textures[kSlotSpecularColor] = readTexture(kGlossinessSpecular);
    material.textures[kSlotMetallicRoughness].reset();
    material.textures[kSlotSpecular].reset();
}

// A mesh keeps two sets: the lowest two that the material's textures use.
void MaterialReader::chooseUvSets(Material& material)
{
    std::set<std::uint32_t> used;
    for (const std::optional<Texture>& texture : material.textures) {
        if (texture) {
            used.insert(texture->uvSet);
        }
    }
    if (used.empty() || *used.rbegin() <= 1) {
        return;
    }
    ignore(used.size() > 2, MessageId::TooManyUvSets,
           "of more than two sets of texture coordinates the highest are replaced by the lowest");
    material.uvSets[0] = *used.begin();
    material.uvSets[1] = used.size() > 1 ? *std::next(used.begin()) : *used.begin();
    for (std::optional<Texture>& texture : material.textures) {
        if (texture) {
            texture->uvSet = texture->uvSet == material.uvSets[1] && used.size() > 1 ? 1 : 0;
        }
    }
}

void MaterialReader::warnOfExtensions(const Material& material)
{
    for (const auto& [name, extension] : source_.extensions) {
        const bool scatters = name == kScatter || name == kVolumeScatter || name == kSubsurface || name == kSss;
        const bool isEmpty = scatters && !material.solid && !(name == kScatter && material.scattersThin);
        if (isMissing(name) || isEmpty) {
            const char* const why = isEmpty ? " is ignored (no light enters a volume of the material)" : " is ignored";
            warnings_.add({MessageId::ExtensionIgnored, {part::value(shortened(name)), why}}, part::place(place_));
        }
    }
}

Material MaterialReader::read()
{
    const std::vector<double>& color = source_.pbrMetallicRoughness.baseColorFactor;
    const std::vector<double>& emissive = source_.emissiveFactor;
    const auto strength = static_cast<double>(numberOr(source_, "KHR_materials_emissive_strength", "emissiveStrength", 1.0));
    Material material;
    material.name = source_.name;
    material.baseColor = glm::dvec3(color[0], color[1], color[2]);
    material.metallic = static_cast<float>(source_.pbrMetallicRoughness.metallicFactor);
    material.roughness = static_cast<float>(source_.pbrMetallicRoughness.roughnessFactor);
    material.specular = numberOr(source_, kSpecular, "specularFactor", 1.0);
    material.specularColor = colorOr(source_, kSpecular, "specularColorFactor", glm::vec3(1.0F));
    material.emission = strength * glm::dvec3(emissive[0], emissive[1], emissive[2]);
    material.isDisplay = source_.extensions.count("KHR_materials_emissive_strength") == 0;
    material.doubleSided = source_.doubleSided;
    material.alphaMode = source_.alphaMode == "MASK"    ? AlphaMode::Mask
                         : source_.alphaMode == "BLEND" ? AlphaMode::Blend
                                                        : AlphaMode::Opaque;
    material.alpha = static_cast<float>(color[3]);
    material.alphaCutoff = static_cast<float>(source_.alphaCutoff);
    readTextures(material);
    readTransmission(material);
    readLayers(material);
    readGlossiness(material);
    material.isCatcher =
        source_.extras.IsObject() && source_.extras.Has("shadowCatcher") && source_.extras.Get("shadowCatcher").Get<bool>();
    material.unlit = source_.extensions.count("KHR_materials_unlit") > 0;
    if (material.unlit) {
        material.emission = glm::vec3(0.0F);
    }
    chooseUvSets(material);
    warnOfExtensions(material);
    return material;
}

tinygltf::Material makeDefaultMaterial()
{
    tinygltf::Material material;
    material.name = "default";
    material.emissiveFactor = {0.0, 0.0, 0.0};
    return material;
}

}  // namespace

Material readMaterial(const GltfFile& file, int index, Warnings& warnings)
{
    const tinygltf::Material source = index < 0 ? makeDefaultMaterial() : file.model.materials[static_cast<std::size_t>(index)];
    return MaterialReader(file, source, materialLabel(file, index), warnings).read();
}

std::string materialLabel(const GltfFile& file, int index)
{
    const auto at = static_cast<std::size_t>(index);
    return index < 0 ? "the default material" : label("materials", at, file.model.materials[at].name);
}

}  // namespace glim
