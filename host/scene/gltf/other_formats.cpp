#include "host/scene/gltf/other_formats.hpp"

#include "host/text.hpp"

#include <algorithm>

namespace glim {
namespace {

constexpr std::string_view kToGltf = "which tools/to_gltf makes of it",
                           kBlender = "which Blender makes of it: import it and export glTF 2.0",
                           kFreeCad = "which FreeCAD makes of it: open it and export glTF", kUnpack = "which may be in it: unpack it",
                           kAuthor = "which the program that wrote it may export, or its converters";

// Of equals the first one counts.
constexpr OtherFormat kFormats[] = {
    {"a zip archive", "PK\3\4", ".zip", kUnpack},
    {"an archive", "", ".7z .bz2 .gz .rar .tar .tgz .xz .zst", kUnpack},
    {"OBJ", "", ".obj", kToGltf},
    {"PLY", "ply", ".ply", kToGltf},
    {"COLLADA", "", ".dae", kToGltf},
    {"FBX", "Kaydara FBX Binary", ".fbx", kBlender},
    {"FBX", "; FBX", ".fbx", kBlender},
    {"USD", "#usda", ".usd .usda", kBlender},
    {"USD", "PXR-USDC", ".usd .usdc", kBlender},
    {"USD in a zip archive", "PK\3\4", ".usdz", kBlender},
    {"a file of Blender", "BLENDER", ".blend", "which Blender exports from it (glTF 2.0)"},
    {"Alembic", "Ogawa", ".abc", kBlender},
    {"STL", "solid ", ".stl", kBlender},
    {"3DS", "", ".3ds", kBlender},
    {"VRML", "#VRML", ".wrl", kBlender},
    {"X3D", "", ".x3d", kBlender},
    {"STEP or IFC", "ISO-10303-21", ".step .stp .ifc", kFreeCad},
    {"IGES", "", ".iges .igs", kFreeCad},
    {"DXF", "", ".dxf", kFreeCad},
    {"3MF", "PK\3\4", ".3mf", kFreeCad},
    {"a file of another program", "", ".c4d .hip .lwo .ma .max .mb .skp", kAuthor},
};

bool hasWord(std::string_view words, std::string_view word)
{
    while (!words.empty()) {
        const std::string_view first = words.substr(0, words.find(' '));
        if (first == word) {
            return true;
        }
        words.remove_prefix(std::min(words.size(), first.size() + 1));
    }
    return false;
}

}  // namespace

const OtherFormat* findOtherFormat(const std::filesystem::path& file, std::string_view start)
{
    const std::string ending = lowerCase(file.extension().string());
    const auto evidence = [&](const OtherFormat& format) {
        return (!format.start.empty() && start.starts_with(format.start) ? 2 : 0) + (hasWord(format.endings, ending) ? 1 : 0);
    };
    const OtherFormat* const found = std::ranges::max_element(kFormats, {}, evidence);
    return evidence(*found) > 0 ? found : nullptr;
}

}  // namespace glim
