// Reading anything but a regular file is refused at once: a pipe could wait for ever.
#include "host/input_file.hpp"
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/image/radiance_map.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <sys/stat.h>

namespace glim::test {
namespace {

using nlohmann::json;

TEST(InputFile, OnlyRegularFilesAndLinksToThem)
{
    const ScratchFolder folder;
    writeText(folder / "file", "");
    std::filesystem::create_symlink("file", folder / "link");
    EXPECT_NO_THROW(requireFile(folder / "file", "a file"));
    EXPECT_NO_THROW(requireFile(folder / "link", "a file"));
    const auto expectRefusedAs = [](const std::filesystem::path& file, MessageId id, const std::string& value) {
        expectRefusal<InputError>([&] { requireFile(file, "a map"); }, id, {.file = file, .value = value});
    };
    expectRefusedAs(folder.path(), MessageId::WrongType, "a folder");
    expectRefusedAs("/dev/zero", MessageId::WrongType, "a device");
    expectRefusedAs(folder / "none", MessageId::FileMissing, "No such file or directory");
    expectRefusedAs(folder / "file" / "none", MessageId::FileMissing, "Not a directory");
    expectRefusedAs("http://example.org/a.hdr", MessageId::Unsupported, "a URL");
    expectRefusal<InputError>([&] { requireFile("", "a map"); }, MessageId::Missing, {.expected = "a map"});
}

TEST(InputFile, NoReaderWaitsForAPipe)
{
    const ScratchFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const auto expectNoPipe = [&](const auto& read, const std::string& expected) {
        expectRefusal<InputError>([&] { read(pipe); }, MessageId::WrongType, {.file = "pipe", .value = "a pipe", .expected = expected});
    };
    expectNoPipe([](const auto& file) { loadGltf(file); }, ".gltf or a .glb");
    expectNoPipe([](const auto& file) { readExr(file); }, "OpenEXR");
    expectNoPipe([](const auto& file) { readRadianceMap(file); }, ".hdr or .exr");

    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    json document = json::parse(builder.toGltf());
    document["buffers"][0]["uri"] = "pipe";
    writeText(folder / "scene.gltf", document.dump());
    expectRefusal<InputError>([&] { loadGltf(folder / "scene.gltf"); }, MessageId::WrongType,
                              {.file = "scene.gltf", .place = "buffers[0]", .value = "pipe"});
}

}  // namespace
}  // namespace glim::test
