// Reading anything but a regular file is refused at once: a pipe could wait for ever.
#include "host/input_file.hpp"
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/image/radiance_map.hpp"
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
    expectRefusal<InputError>([&] { requireFile(folder.path(), "a map"); }, ": is a folder; expected a map");
    expectRefusal<InputError>([&] { requireFile("/dev/zero", "a map"); }, "/dev/zero: is a device; expected a map");
    expectRefusal<InputError>([&] { requireFile(folder / "none", "a map"); }, "none: cannot be read: No such file");
    expectRefusal<InputError>([&] { requireFile(folder / "file" / "none", "a map"); }, "none: cannot be read: Not a directory");
    expectRefusal<InputError>([&] { requireFile("", "a map"); }, "expected that of a map");
}

TEST(InputFile, NoReaderWaitsForAPipe)
{
    const ScratchFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expectRefusal<InputError>([&] { loadGltf(pipe); }, "pipe: is a pipe; expected a .gltf or a .glb file");
    expectRefusal<InputError>([&] { readExr(pipe); }, "pipe: is a pipe; expected an OpenEXR file");
    expectRefusal<InputError>([&] { readRadianceMap(pipe); }, "pipe: is a pipe; expected a .hdr or .exr map");

    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    json document = json::parse(builder.toGltf());
    document["buffers"][0]["uri"] = "pipe";
    writeText(folder / "scene.gltf", document.dump());
    expectRefusal<InputError>([&] { loadGltf(folder / "scene.gltf"); }, "buffers[0] names the file \"pipe\", which cannot be read (");
}

}  // namespace
}  // namespace glim::test
