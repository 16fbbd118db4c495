// Writes the first inputs of each target: write_seeds FOLDER. Fuzzing grows the corpus from these and from scenes/.
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "places.h"
#include "shaders/shared/limits.h"
#include "tests/support/compress_geometry.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/guide_records.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>

namespace fs = std::filesystem;
using nlohmann::json;

namespace glim::test {
namespace {

template <class Range>
void writeFile(const fs::path& path, const Range& bytes)
{
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

Bytes smallPng() { return encodePng(2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}); }

std::size_t addTexture(GltfBuilder& builder, const Bytes& image, const char* type)
{
    builder.append("images", {{"bufferView", builder.addAov(image)}, {"mimeType", type}});
    builder.append("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
    return builder.append("textures", {{"source", builder.document["images"].size() - 1}, {"sampler", 0}});
}

// Every attribute, a normal map, an alpha mask and most extensions of materials.
GltfBuilder textured()
{
    GltfBuilder builder;
    const json slot = {{"index", addTexture(builder, smallPng(), "image/png")},
                       {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}, {"scale", {2, 1}}}}}}};
    const json webp = {{"index", addTexture(builder, encodeWebp(1, 1, {9, 8, 7, 6}), "image/webp")}};
    const json jpeg = {{"index", addTexture(builder, encodeJpeg(2, 1, {9, 8}, JpegColors::Grey), "image/jpeg")}};
    builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", slot}, {"metallicRoughnessTexture", jpeg}}},
                                 {"normalTexture", slot},
                                 {"emissiveTexture", webp},
                                 {"emissiveFactor", {1, 0.5, 0}},
                                 {"alphaMode", "MASK"},
                                 {"extensions",
                                  {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", slot}}},
                                   {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
                                   {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1}}},
                                   {"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 0}}}},
                                   {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}},
                                   {"KHR_materials_iridescence", {{"iridescenceFactor", 1}}},
                                   {"KHR_materials_dispersion", {{"dispersion", 1}}},
                                   {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
    json primitive = addPlain(builder, makeHills(3));
    primitive["material"] = 0;
    builder.addNode({{"mesh", builder.addMesh(primitive)}, {"scale", {1, -2, 3}}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 1.5}, {"material", 0}}}}}});
    return builder;
}

GltfBuilder lit()
{
    GltfBuilder builder;
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}, {"range", 5}},
        {{"type", "point"}, {"color", {1, 0, 0}}, {"intensity", 40}}};
    builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 2}}}});
    builder.addNode({{"mesh", builder.addTriangleMesh()}, {"camera", 0}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"rotation", {0, 0.6, 0, 0.8}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    // A cube of one image.
    builder.append("images", {{"bufferView", builder.addAov(smallPng())}, {"mimeType", "image/png"}});
    const json faces = {0, 0, 0, 0, 0, 0};
    builder.document["extensions"]["EXT_lights_image_based"]["lights"] = {
        {{"specularImages", json::array({faces})}, {"specularImageSize", 2}, {"intensity", 2}, {"rotation", {0, 0, 0, 1}}}};
    builder.document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    return builder;
}

GltfBuilder instanced()
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    const std::size_t sparse = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.document["accessors"][sparse]["sparse"] = {{"count", 1},
                                                       {"indices", {{"bufferView", builder.addAov({2})}, {"componentType", kUnsignedByte}}},
                                                       {"values", {{"bufferView", builder.addAov(toBytes<float>({0, 1, 0.5F}))}}}};
    builder.addNode({{"mesh", mesh},
                     {"extensions",
                      {{"EXT_mesh_gpu_instancing",
                        {{"attributes", {{"TRANSLATION", sparse}, {"SCALE", builder.addVec3({1, 1, 1, 2, 2, 2, 3, 1, 1})}}}}}}}});
    builder.append("nodes", {{"mesh", mesh}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
    builder.addNode({{"children", {builder.document["nodes"].size() - 1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    return builder;
}

// Points with indices, splats, and lines of each kind.
GltfBuilder clouds()
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}),
                      colors = builder.addVec3(std::vector<float>(12, 0.5F));
    const json attributes = {{"POSITION", positions}, {"COLOR_0", colors}};
    const json splats = {{"POSITION", positions}, {"KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", colors}};
    const auto add = [&builder](const json& primitive) { builder.addNode({{"mesh", builder.addMesh(primitive)}, {"scale", {1, -2, 3}}}); };
    add({{"attributes", attributes}, {"mode", 0}, {"indices", builder.addIndices({3, 1, 1})}});
    add({{"attributes", splats}, {"mode", 0}, {"extensions", {{"KHR_gaussian_splatting", {{"colorSpace", "lin_rec709_display"}}}}}});
    for (const int mode : {1, 2, 3}) {
        add({{"attributes", attributes}, {"mode", mode}, {"extras", {{"radius", 0.1}}}});
    }
    builder.document["extensionsUsed"] = {"KHR_gaussian_splatting"};
    return builder;
}

// Filters of meshopt, on streams of version 0; gltfpack.glb has those that it writes.
GltfBuilder filtered()
{
    GltfBuilder builder = build(makeHills(3), meshopt("TRIANGLES"));
    json& views = builder.document["bufferViews"];
    for (json& view : views) {
        if (view.contains("extensions")) {
            json& source = view["extensions"]["EXT_meshopt_compression"];
            const int stride = source["byteStride"];
            source["filter"] = source["mode"] != "ATTRIBUTES" ? "NONE" : stride == 4 ? "COLOR" : stride == 8 ? "QUATERNION" : "EXPONENTIAL";
        }
    }
    return builder;
}

// Streams of both versions by the current encoder, each in a file of its own.
void writeStreams(const fs::path& folder)
{
    const std::string path = GLIM_SOURCE_DIR "/tests/host/meshopt/streams.glb";
    const GltfContainer container = openContainer(path);
    const Bytes binary = readBytes(path, container.binary->size, container.binary->begin);
    const json document = json::parse(container.json);
    std::size_t count = 0;
    for (const json& view : document["bufferViews"]) {
        const json extensions = view.value("extensions", json::object());
        for (const auto& [name, source] : extensions.items()) {
            GltfBuilder builder = oneTriangle();
            const auto first = binary.begin() + source["byteOffset"].get<std::ptrdiff_t>();
            const Bytes stream(first, first + source["byteLength"].get<std::ptrdiff_t>());
            addMeshoptView(builder, stream, {name, source["mode"], source.value("filter", "NONE"), source["byteStride"], source["count"]});
            writeFile(folder / ("stream_" + std::to_string(count++) + ".glb"), builder.toGlb());
        }
    }
}

void writeScenes(const fs::path& folder)
{
    writeStreams(folder);
    const std::pair<const char*, GltfBuilder> scenes[] = {
        {"textured", textured()},
        {"lit", lit()},
        {"instanced", instanced()},
        {"posed", posedTriangle()},
        {"clouds", clouds()},
        {"draco", build(makeHills(3), draco({}))},
        {"draco_sequential", build(makeHills(3), draco({false, 8, true}))},
        {"meshopt", build(makeHills(3), meshopt("TRIANGLES"))},
        {"meshopt_indices", build(makeHills(3), meshopt("INDICES"))},
        {"meshopt_filters", filtered()},
    };
    for (const auto& [name, builder] : scenes) {
        writeFile(folder / (std::string(name) + ".glb"), builder.toGlb());
        writeFile(folder / (std::string(name) + ".gltf"), builder.toGltf());
    }
}

void writeImages(const fs::path& folder)
{
    const Bytes rows(16, 77), wide(64, 200);
    writeFile(folder / "rgb.png", smallPng());
    writeFile(folder / "grey.png", encodePng(4, 4, rows, {PNG_COLOR_TYPE_GRAY}));
    writeFile(folder / "bits.png", encodePng(8, 16, rows, {PNG_COLOR_TYPE_GRAY, 1}));
    writeFile(folder / "wide.png", encodePng(4, 2, wide, {PNG_COLOR_TYPE_RGB_ALPHA, 16, true}));
    PngFormat palette{PNG_COLOR_TYPE_PALETTE, 4, true};
    palette.palette = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {9, 9, 9}, {9, 9, 9}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    palette.transparentEntries = {128};
    writeFile(folder / "palette.png", encodePng(8, 4, Bytes(16, 0x12), palette));
    PngFormat clear{PNG_COLOR_TYPE_RGB};
    clear.transparentColor = {77, 77, 77};
    clear.chunks = {{"tEXt", {'a', 0, 'b'}}, {"gAMA", {0, 0, 177, 143}}};
    writeFile(folder / "clear.png", encodePng(2, 2, Bytes(12, 77), clear));
    writeFile(folder / "grey.jpg", encodeJpeg(4, 4, rows, JpegColors::Grey));
    writeFile(folder / "rgb.jpg", encodeJpeg(17, 9, Bytes(17 * 9 * 3, 50), JpegColors::Color));
    writeFile(folder / "progressive.jpg", encodeJpeg(17, 9, Bytes(17 * 9 * 3, 50), JpegColors::Color, true));
    writeFile(folder / "cmyk.jpg", encodeJpeg(2, 2, rows, JpegColors::Cmyk));
    writeFile(folder / "alpha.webp", encodeWebp(4, 4, wide));
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n";
    writeFile(folder / "plain.hdr", header + "-Y 2 +X 2\n" + std::string("abcdefghijklmnop"));
    writeFile(folder / "old.hdr", header + "+X 2 -Y 4\nabcd\1\1\1\3" + "abcd\1\1\1\3");
    writeFile(folder / "new.hdr", header + "-Y 1 +X 8\n\2\2" + std::string("\0\b", 2) + "\x88x\x88y\x88z\x88\x80");
    Image exr;
    exr.width = 3;
    exr.height = 2;
    exr.attributes = {{"word", "x"}, {"number", 1.5}};
    for (const char* name : {"R", "G", "B"}) {
        exr.channels[name] = {0, 1, 2, 3, -4, 5};
    }
    exr.counts["count.X"] = {0, 1, 2, 3, 4, 5};
    writeExr(folder / "rgb.exr", exr);
}

Film smallFilm(std::uint32_t begin, std::uint32_t end, bool splats)
{
    Film film;
    film.width = 3;
    film.height = 2;
    film.sampleRanges = {{begin, end}};
    film.identity = {"3f2a", "bounces=64 sampler=sobol", 1, "kernels"};
    film.arithmetic = "abc";
    film.device = "device";
    film.sceneFile = "box.gltf";
    for (std::uint32_t i = 0; i < 6; ++i) {
        PixelMoments pixel{};
        pixel.count = end - begin;
        pixel.blocks = 3;
        pixel.mean = glm::vec3(0.1F * static_cast<float>(i), 1.0F, 2.0F);
        pixel.squares = glm::vec3(0.3F);
        pixel.alpha = 1.0F;
        film.pixels.push_back(pixel);
    }
    if (splats) {
        film.splats.assign(6, {end - begin, 2, glm::vec3(0.5F), glm::vec3(0.25F), 0.0F});
    }
    return film;
}

void writeFilms(const fs::path& folder)
{
    fs::create_directories(folder);
    writeFilm(folder / "plain.exr", smallFilm(0, kPageSamples, false));
    writeFilm(folder / "splats.exr", smallFilm(0, kPageSamples, true));
    Film caught = smallFilm(0, kPageSamples, false);
    caught.catcher.assign(6, {kPageSamples, 0.5F, glm::vec3(0.25F), glm::vec3(0.5F), glm::vec3(0.1F)});
    Checkpoint catching = makeCheckpoint(caught).value();
    catching.page = catching.film;
    writeFilm(folder / "catcher.exr", makeFilm(catching), catching);
    Film grouped = smallFilm(0, kPageSamples, true);
    grouped.identity.settings += " light-groups=key,others";
    grouped.groups = grouped.splatGroups = GroupMoments(2, 6);
    std::ranges::fill(grouped.groups.values, glm::vec3(0.25F));
    Checkpoint grouping = makeCheckpoint(grouped).value();
    grouping.page = grouping.film;
    writeFilm(folder / "groups.exr", makeFilm(grouping), grouping);
    Film apart = smallFilm(0, 64, false);
    apart.sampleRanges.emplace_back(128, 256);
    writeFilm(folder / "apart.exr", apart);
    Checkpoint checkpoint = makeCheckpoint(smallFilm(0, kPageSamples, true)).value();
    writeFilm(folder / "whole_page.exr", makeFilm(checkpoint), checkpoint);
    checkpoint.page = checkpoint.film;
    writeFilm(folder / "page.exr", makeFilm(checkpoint), checkpoint);
    Random random(1);
    const auto guide = std::make_shared<const Guide>(guideOf(recordsOfBall(600, random)));
    Checkpoint guided = checkpoint;
    guided.guide = LearnedGuide{guide, 2.5};
    guided.film.identity.settings += " guide=" + guide->digest;
    writeFilm(folder / "guide.exr", makeFilm(guided), guided);
    checkpoint.halves = {checkpoint.page, checkpoint.page};
    writeFilm(folder / "halves.exr", makeFilm(checkpoint), checkpoint);
    checkpoint.halves = {};
    checkpoint.progress.adaptive =
        AdaptiveProgress{64, 128, 64, 128, true, false, std::vector<std::uint32_t>(6, 4), std::vector<std::uint32_t>(6, 2), {}};
    checkpoint.common = checkpoint.page;
    writeFilm(folder / "adaptive.exr", makeFilm(checkpoint), checkpoint);
    checkpoint.progress.adaptive->blocksLater = checkpoint.progress.adaptive->blocksLeft;
    checkpoint.halves = {checkpoint.page, checkpoint.page};
    checkpoint.before = checkpoint.page;
    writeFilm(folder / "adaptive_halves.exr", makeFilm(checkpoint), checkpoint);
}

}  // namespace
}  // namespace glim::test

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::cerr << "usage: write_seeds FOLDER\n";
        return 2;
    }
    const fs::path folder = argv[1];
    glim::test::writeScenes(folder / "load");
    glim::test::writeImages(folder / "image");
    glim::test::writeFilms(folder / "film");
}
