#include "tests/fuzz/targets.hpp"

#include "host/error.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/image/decode_image.hpp"
#include "host/image/exr.hpp"
#include "host/image/radiance_map.hpp"
#include "host/image/shrink_image.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/scene/load_gltf.hpp"
#include "tests/fuzz/contract.hpp"
#include "tests/support/check_bvh.hpp"

#include <stdlib.h>
#include <webp/decode.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string_view>

namespace fs = std::filesystem;

namespace glim::fuzz {
namespace {

// A folder in memory for this process. It lies so deep that a path of an input would need many ".." to lead out of it; glim only reads
// what an input names.
class PrivateFolder {
public:
    PrivateFolder()
    {
        const fs::path memory = "/dev/shm";
        std::string name = ((fs::is_directory(memory) ? memory : fs::temp_directory_path()) / "glim-fuzz-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw std::runtime_error("no temporary folder: " + name);
        }
        top_ = path_ = name;
        for (int level = 0; level < 16; ++level) {
            path_ /= "d";
        }
        fs::create_directories(path_);
    }
    ~PrivateFolder() { fs::remove_all(top_); }
    PrivateFolder(const PrivateFolder&) = delete;
    PrivateFolder& operator=(const PrivateFolder&) = delete;

    fs::path write(const char* name, Bytes bytes) const
    {
        std::ofstream(path_ / name, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
        return path_ / name;
    }
    fs::path operator/(const char* name) const { return path_ / name; }

private:
    fs::path top_, path_;
};

const PrivateFolder& folder()
{
    static const PrivateFolder only;
    return only;
}

using Defect = std::optional<std::string>;

bool contains(Bytes bytes, std::string_view word)
{
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).find(word) != std::string_view::npos;
}

// A file with animations is read at a time. One without lights of the environment gets a plain one: making the studio takes longer than
// most inputs.
LoadOptions optionsFor(Bytes bytes)
{
    LoadOptions options;
    if (contains(bytes, "\"animations\"")) {
        options.at = 0.5;
    }
    if (!contains(bytes, "EXT_lights_image_based")) {
        options.environment = glm::vec3(1.0F);
    }
    return options;
}

// An input may name itself, as "scene.gltf", where it needs a buffer or an image.
Defect runOnScene(Bytes bytes, const std::function<void(const Scene&)>& use)
{
    const fs::path file = folder().write("scene.gltf", bytes);
    return findDefect(file.string() + ": ", [&] { use(loadGltf(file, optionsFor(bytes))); });
}

std::uint64_t countTriangles(const Scene& scene)
{
    std::uint64_t count = 0;
    for (const MeshInstance& instance : scene.instances) {
        count += scene.meshes[instance.mesh].indices.size() / 3;
    }
    return count;
}

Defect load(Bytes bytes)
{
    return runOnScene(bytes, [](const Scene&) {});
}

Defect build(Bytes bytes)
{
    constexpr std::uint64_t kMaxTriangles = 100'000;
    Defect defect;
    const Defect broken = runOnScene(bytes, [&](const Scene& scene) {
        if (countTriangles(scene) > kMaxTriangles) {
            return;
        }
        const std::uint64_t maxFlat = bytes.size() % 2 == 0 ? kMaxFlatTriangles : 4;  // beyond it instances share meshes
        const Primitives primitives = makePrimitives(scene, maxFlat);
        if (const std::vector<Box> boxes = primitiveBoxes(primitives); !boxes.empty()) {
            defect = findBvhDefect(buildBvh(boxes), boxes);
        }
        flattenScene(scene, primitives, buildSceneBvh(primitives));
    });
    return broken ? broken : defect;
}

// One to merge with: of the same picture as films of the corpus, and of samples that follow theirs.
const fs::path& anotherFilm()
{
    static const fs::path file = [] {
        Film film;
        film.width = 3;
        film.height = 2;
        film.sampleRanges = {{1024, 1152}};
        film.identity = {"3f2a", "bounces=64 sampler=sobol", 1, ""};
        for (unsigned i = 0; i < film.width * film.height; ++i) {
            PixelMoments pixel{};
            pixel.count = 128;
            pixel.blocks = 2;
            pixel.mean = glm::vec3(0.25F * static_cast<float>(i));
            pixel.squares = glm::vec3(1.0F);
            film.pixels.push_back(pixel);
        }
        fs::path path = folder() / "other.exr";
        writeFilm(path, film);
        return path;
    }();
    return file;
}

std::vector<uvec4> texelsOf(const Checkpoint& checkpoint)
{
    return checkpoint.guide && checkpoint.guide->guide ? checkpoint.guide->guide->texels : std::vector<uvec4>();
}

// What was read is written again and then reads as the same.
Defect findRoundTripDefect(const StoredFilm& stored)
{
    const fs::path copy = folder() / "copy.exr";
    if (stored.checkpoint) {
        writeFilm(copy, stored.film, *stored.checkpoint);
    } else {
        writeFilm(copy, stored.film);
    }
    const StoredFilm back = readStoredFilm(copy);
    if (computeDigest(back.film) != computeDigest(stored.film)) {
        return "a film that is written again is not the same";
    }
    if (stored.checkpoint && (!back.checkpoint || computeDigest(*back.checkpoint) != computeDigest(*stored.checkpoint))) {
        return "a checkpoint that is written again is not the same";
    }
    if (stored.checkpoint && texelsOf(*back.checkpoint) != texelsOf(*stored.checkpoint)) {
        return "a guide that is written again is not the same";
    }
    return std::nullopt;
}

Defect film(Bytes bytes)
{
    const fs::path file = folder().write("film.exr", bytes), other = anotherFilm();
    const std::string either = file.parent_path().string();
    Defect lost;
    Defect defect = findDefect(file.string() + ": ", [&] {
        const StoredFilm stored = readStoredFilm(file);
        lost = findRoundTripDefect(stored);
        readGuide(file);
        makeCheckpoint(stored.film);
        if (stored.checkpoint) {
            makeFilm(*stored.checkpoint);
        }
    });
    for (const std::vector<fs::path>& files : {std::vector{file, file}, std::vector{other, file}}) {
        defect = defect ? defect : findDefect(either, [&] { mergeFilms(files); });
    }
    return defect ? defect : lost;
}

// A legal WebP of 40 bytes may have 16383x16383 pixels, which take a gigabyte and seconds.
bool isLargeWebp(Bytes bytes)
{
    constexpr int kMaxPixels = 1 << 22;
    WebPBitstreamFeatures features;
    return WebPGetFeatures(bytes.data(), bytes.size(), &features) == VP8_STATUS_OK && features.width > kMaxPixels / features.height;
}

Defect image(Bytes bytes)
{
    if (isLargeWebp(bytes)) {
        return std::nullopt;
    }
    const fs::path file = folder().write("image", bytes);
    const Defect defects[] = {
        findDefect("", [&] { shrinkImage(decodeImage(bytes), 16, bytes.size() % 2 == 0); }),
        findDefect(file.string() + ": ", [&] { readRadianceMap(file); }),
        findDefect(file.string() + ": ", [&] { readExr(file); }),
    };
    for (const Defect& defect : defects) {
        if (defect) {
            return defect;
        }
    }
    return std::nullopt;
}

// A legal KTX2 of 300 bytes may have 16384x16384 pixels.
bool isLargeKtx2(Bytes bytes)
{
    constexpr std::uint64_t kMaxPixels = 1 << 22;
    constexpr std::size_t kSizeAt = 20;
    std::uint32_t size[2];
    if (bytes.size() < kSizeAt + sizeof size) {
        return false;
    }
    std::memcpy(size, bytes.data() + kSizeAt, sizeof size);
    return std::uint64_t{size[0]} * size[1] > kMaxPixels;
}

Defect ktx2(Bytes bytes)
{
    return isLargeKtx2(bytes) ? std::nullopt : findDefect("", [&] { decodeImage(bytes); });
}

}  // namespace

std::optional<std::string> runTarget(const std::string& target, Bytes bytes)
{
    static const std::map<std::string, Defect (*)(Bytes)> kTargets{
        {"load", load}, {"build", build}, {"film", film}, {"image", image}, {"ktx2", ktx2}};
    return kTargets.at(target)(bytes);
}

}  // namespace glim::fuzz
