#include "host/scene/gltf/read_material.hpp"

#include <algorithm>

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

// True if an RGB property is absent or white.
bool isWhite(const tinygltf::Material& source, const char* extension, const char* name)
{
    const tinygltf::Value* value = findProperty(source, extension, name);
    bool white = true;
    for (int c = 0; value != nullptr && c < 3; ++c) {
        white = white && value->Get(c).GetNumberAsDouble() == 1.0;
    }
    return white;
}

Scattering chooseScattering(const tinygltf::Material& source)
{
    if (numberOr(source, "KHR_materials_transmission", "transmissionFactor", 0.0) > 0.0) {
        return Scattering::Dielectric;
    }
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    return pbr.metallicFactor > 0.5 && pbr.roughnessFactor < 0.2 ? Scattering::Mirror : Scattering::Lambert;
}

class Ignored {
public:
    void addIf(bool condition, const std::string& what)
    {
        if (condition) {
            list_ += (list_.empty() ? "" : ", ") + what;
        }
    }
    const std::string& list() const { return list_; }

private:
    std::string list_;
};

void addTextures(const tinygltf::Material& source, Ignored& ignored)
{
    ignored.addIf(source.pbrMetallicRoughness.baseColorTexture.index >= 0, "baseColorTexture");
    ignored.addIf(source.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0, "metallicRoughnessTexture");
    ignored.addIf(source.normalTexture.index >= 0, "normalTexture");
    ignored.addIf(source.occlusionTexture.index >= 0, "occlusionTexture");
    ignored.addIf(source.emissiveTexture.index >= 0, "emissiveTexture");
    for (const auto& [name, extension] : source.extensions) {
        const bool known = std::find(std::begin(kKnownExtensions), std::end(kKnownExtensions), name) != std::end(kKnownExtensions);
        ignored.addIf(!known, name);
        for (const std::string& key : known ? extension.Keys() : std::vector<std::string>{}) {
            ignored.addIf(key.size() > 7 && key.compare(key.size() - 7, 7, "Texture") == 0, key);
        }
    }
}

void addGlass(const tinygltf::Material& source, Ignored& ignored)
{
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const double transmission = numberOr(source, "KHR_materials_transmission", "transmissionFactor", 0.0);
    const double specular = numberOr(source, "KHR_materials_specular", "specularFactor", 1.0);
    const bool attenuates = findProperty(source, "KHR_materials_volume", "attenuationDistance") != nullptr &&
                            !isWhite(source, "KHR_materials_volume", "attenuationColor");
    ignored.addIf(transmission < 1.0, "transmissionFactor " + toText(transmission));
    ignored.addIf(numberOr(source, "KHR_materials_volume", "thicknessFactor", 0.0) == 0.0, "thin walls (thicknessFactor 0)");
    ignored.addIf(attenuates, "attenuation in the volume");
    ignored.addIf(pbr.metallicFactor > 0.0, "metallicFactor " + toText(pbr.metallicFactor));
    ignored.addIf(pbr.roughnessFactor > 0.0, "roughnessFactor " + toText(pbr.roughnessFactor));
    ignored.addIf(specular < 1.0, "specularFactor " + toText(specular));
    ignored.addIf(!isWhite(source, "KHR_materials_specular", "specularColorFactor"), "specularColorFactor");
}

void addMirror(const tinygltf::Material& source, Ignored& ignored)
{
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    ignored.addIf(pbr.metallicFactor < 1.0, "metallicFactor " + toText(pbr.metallicFactor));
    ignored.addIf(pbr.roughnessFactor > 0.0, "roughnessFactor " + toText(pbr.roughnessFactor));
}

// glTF's diffuse lobe is Lambertian at any roughness. What glim lacks is the metal and the specular coat of dielectrics.
void addLambert(const tinygltf::Material& source, Ignored& ignored)
{
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const double specular = numberOr(source, "KHR_materials_specular", "specularFactor", 1.0);
    const bool coated = specular > 0.0 && pbr.metallicFactor < 1.0;
    ignored.addIf(pbr.metallicFactor > 0.0, "metallicFactor " + toText(pbr.metallicFactor));
    ignored.addIf(coated, "the specular coat (specularFactor " + toText(specular) + ")");
    ignored.addIf(coated || pbr.metallicFactor > 0.0, "roughnessFactor " + toText(pbr.roughnessFactor));
}

std::string listIgnored(const tinygltf::Material& source, Scattering scattering)
{
    Ignored ignored;
    switch (scattering) {
    case Scattering::Dielectric: addGlass(source, ignored); break;
    case Scattering::Mirror: addMirror(source, ignored); break;
    case Scattering::Lambert: addLambert(source, ignored); break;
    }
    const bool hasHoles = source.pbrMetallicRoughness.baseColorFactor[3] < 1.0 || source.pbrMetallicRoughness.baseColorTexture.index >= 0;
    ignored.addIf(hasHoles && (source.alphaMode == "MASK" || source.alphaMode == "BLEND"), "alphaMode " + source.alphaMode);
    addTextures(source, ignored);
    return ignored.list();
}

float readIor(const GltfFile& file, const std::string& place, const tinygltf::Material& source)
{
    const double ior = numberOr(source, "KHR_materials_ior", "ior", 1.5);
    if (ior < 1.0) {
        refuse(file, place + " has the index of refraction " + toText(ior) + "; expected at least 1");
    }
    return static_cast<float>(ior);
}

tinygltf::Material makeDefaultMaterial()
{
    tinygltf::Material material;
    material.emissiveFactor = {0.0, 0.0, 0.0};
    return material;
}

}  // namespace

MaterialReading readMaterial(const GltfFile& file, int index)
{
    const tinygltf::Material source = index < 0 ? makeDefaultMaterial() : file.model.materials[static_cast<std::size_t>(index)];
    const std::string place = index < 0 ? "the default material" : label("materials", index, source.name);
    const std::vector<double>& color = source.pbrMetallicRoughness.baseColorFactor;
    const std::vector<double>& emissive = source.emissiveFactor;
    const double strength = numberOr(source, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);

    MaterialReading reading;
    Material& material = reading.material;
    material.name = index < 0 ? "default" : source.name;
    material.scattering = chooseScattering(source);
    material.baseColor = glm::dvec3(color[0], color[1], color[2]);
    material.emission = strength * glm::dvec3(emissive[0], emissive[1], emissive[2]);
    material.doubleSided = source.doubleSided;
    if (material.scattering == Scattering::Dielectric) {
        material.ior = readIor(file, place, source);
    }
    if (const std::string ignored = listIgnored(source, material.scattering); !ignored.empty()) {
        const char* names[] = {"Lambert", "mirror", "solid glass"};
        reading.warning = place + " is drawn as " + names[static_cast<int>(material.scattering)] + " without " + ignored;
    }
    return reading;
}

}  // namespace glim
