#include "host/scene/gltf/read_material.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr const char* kKnownExtensions[] = {"KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular",
                                            "KHR_materials_transmission", "KHR_materials_volume"};

const tinygltf::Value* findProperty(const tinygltf::Material& source, const char* extension, const char* name)
{
    const auto found = source.extensions.find(extension);
    return found == source.extensions.end() || !found->second.Has(name) ? nullptr : &found->second.Get(name);
}

double numberOr(const tinygltf::Material& source, const char* extension, const char* name, double fallback)
{
    const tinygltf::Value* value = findProperty(source, extension, name);
    return value == nullptr ? fallback : value->GetNumberAsDouble();
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
    std::optional<Texture> readTexture(const char* extension, const char* name);
    template <class Info>
    std::optional<Texture> readTexture(const Info& info)
    {
        const auto transform = info.extensions.find("KHR_texture_transform");
        return readTexture(info.index, info.texCoord, transform == info.extensions.end() ? nullptr : &transform->second);
    }
    float readIor() const;
    bool readGlass();
    void warnOfExtensions();
    void ignore(bool condition, const std::string& what)
    {
        if (condition) {
            warnings_.add(what, place_);
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
        if (source.basis) {
            refuse(file_, label("textures", static_cast<std::size_t>(index), source.name) +
                              " has only a KTX2 image (KHR_texture_basisu); expected a source that is PNG, JPEG or WebP");
        }
        ignore(true, "textures without a source are ignored");
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
    if (texture.uvSet > 1) {
        ignore(true, "texture coordinates beyond TEXCOORD_1 are replaced by TEXCOORD_0");
        texture.uvSet = 0;
    }
    return texture;
}

std::optional<Texture> MaterialReader::readTexture(const char* extension, const char* name)
{
    const tinygltf::Value* info = findProperty(source_, extension, name);
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
    material.baseColorTexture = readTexture(source_.pbrMetallicRoughness.baseColorTexture);
    material.metallicRoughnessTexture = readTexture(source_.pbrMetallicRoughness.metallicRoughnessTexture);
    material.normalTexture = readTexture(source_.normalTexture);
    material.normalScale = static_cast<float>(source_.normalTexture.scale);
    material.emissiveTexture = readTexture(source_.emissiveTexture);
    material.specularTexture = readTexture("KHR_materials_specular", "specularTexture");
    material.specularColorTexture = readTexture("KHR_materials_specular", "specularColorTexture");
}

float MaterialReader::readIor() const
{
    const double ior = numberOr(source_, "KHR_materials_ior", "ior", 1.5);
    if (ior < 1.0 && ior != 0.0) {
        refuse(file_, place_ + " has the index of refraction " + toText(ior) + "; expected 0 or at least 1");
    }
    return static_cast<float>(ior);
}

// Whether the material transmits. All that does is smooth solid glass so far.
bool MaterialReader::readGlass()
{
    const double transmission = numberOr(source_, "KHR_materials_transmission", "transmissionFactor", 0.0);
    if (!(transmission > 0.0)) {
        return false;
    }
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    const bool attenuates = findProperty(source_, "KHR_materials_volume", "attenuationDistance") != nullptr &&
                            colorOr(source_, "KHR_materials_volume", "attenuationColor", glm::vec3(1.0F)) != glm::vec3(1.0F);
    ignore(transmission < 1.0 || findProperty(source_, "KHR_materials_transmission", "transmissionTexture") != nullptr,
           "partial transmission is drawn as full transmission");
    ignore(numberOr(source_, "KHR_materials_volume", "thicknessFactor", 0.0) == 0.0, "thin-walled glass is drawn as solid glass");
    ignore(attenuates, "attenuation in a volume is ignored");
    ignore(pbr.roughnessFactor > 0.0, "rough glass is drawn as smooth glass");
    ignore(pbr.metallicFactor > 0.0, "the metallic part of glass is ignored");
    return true;
}

void MaterialReader::warnOfExtensions()
{
    for (const auto& [name, extension] : source_.extensions) {
        const bool known = std::find(std::begin(kKnownExtensions), std::end(kKnownExtensions), name) != std::end(kKnownExtensions);
        ignore(!known, name + " is ignored");
    }
}

Material MaterialReader::read()
{
    const std::vector<double>& color = source_.pbrMetallicRoughness.baseColorFactor;
    const std::vector<double>& emissive = source_.emissiveFactor;
    const double strength = numberOr(source_, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);
    Material material;
    material.name = source_.name;
    material.baseColor = glm::dvec3(color[0], color[1], color[2]);
    material.metallic = static_cast<float>(source_.pbrMetallicRoughness.metallicFactor);
    material.roughness = static_cast<float>(source_.pbrMetallicRoughness.roughnessFactor);
    material.ior = readIor();
    material.specular = static_cast<float>(numberOr(source_, "KHR_materials_specular", "specularFactor", 1.0));
    material.specularColor = colorOr(source_, "KHR_materials_specular", "specularColorFactor", glm::vec3(1.0F));
    material.glass = readGlass();
    material.emission = strength * glm::dvec3(emissive[0], emissive[1], emissive[2]);
    material.doubleSided = source_.doubleSided;
    material.alphaMode = source_.alphaMode == "MASK"    ? AlphaMode::Mask
                         : source_.alphaMode == "BLEND" ? AlphaMode::Blend
                                                        : AlphaMode::Opaque;
    material.alpha = static_cast<float>(color[3]);
    material.alphaCutoff = static_cast<float>(source_.alphaCutoff);
    readTextures(material);
    warnOfExtensions();
    if (material.glass && material.ior == 0.0F) {
        refuse(file_, place_ + " is glass with the index of refraction 0; expected at least 1");
    }
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
