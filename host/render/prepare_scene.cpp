#include "host/render/prepare_scene.hpp"

#include "host/error.hpp"
#include "host/flatten/flatten_scene.hpp"

#include <chrono>
#include <iostream>

namespace glim {
namespace {

using Clock = std::chrono::steady_clock;

double secondsBetween(Clock::time_point begin, Clock::time_point end)
{
    return std::chrono::duration<double>(end - begin).count();
}

}  // namespace

PreparedScene prepareScene(const std::filesystem::path& file, const LoadOptions& options, SplitRule split)
{
    PreparedScene prepared;
    const Clock::time_point start = Clock::now();
    prepared.scene = loadGltf(file, options);
    for (const std::string& notice : prepared.scene.notices) {
        std::cerr << "glim: " << notice << '\n';
    }
    const Clock::time_point loaded = Clock::now();
    prepared.bvh = buildBvh(primitiveBoxes(prepared.scene), split);
    prepared.split = split;
    prepared.flat = flattenScene(prepared.scene, prepared.bvh);
    prepared.loadSeconds = secondsBetween(start, loaded);
    prepared.buildSeconds = secondsBetween(loaded, Clock::now());
    return prepared;
}

void warnOfDarkness(const PreparedScene& prepared)
{
    if (prepared.flat.lights.empty()) {
        std::cerr << "glim: the scene has no light, so every picture of it is black; --environment 1,1,1 lights it\n";
    }
}

const Camera& findCamera(const Scene& scene, const std::optional<std::string>& choice)
{
    if (!choice) {
        return scene.cameras.front();
    }
    std::string list;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (scene.cameras[i].name == *choice || std::to_string(i) == *choice) {
            return scene.cameras[i];
        }
        list += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    }
    throw InputError(scene.file + ": camera \"" + *choice + "\": expected one of " + list + ".");
}

}  // namespace glim
