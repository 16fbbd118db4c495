// Files that are dropped on the window: another scene, or an environment.
#include "host/memory.hpp"
#include "host/preview/session.hpp"

#include <algorithm>
#include <cctype>
#include <exception>
#include <new>
#include <utility>

namespace glim {
namespace {

std::string kindOf(const std::filesystem::path& file)
{
    std::string kind = file.extension().string();
    std::ranges::transform(kind, kind.begin(), [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return kind;
}

// Those that do not speak of what one file has.
LoadOptions ofEveryScene(const LoadOptions& options)
{
    LoadOptions kept;
    kept.environment = options.environment;
    kept.environmentRotation = options.environmentRotation;
    kept.environmentStrength = options.environmentStrength;
    kept.environmentBackground = options.environmentBackground;
    kept.sun = options.sun;
    kept.showsBackFaces = options.showsBackFaces;
    kept.pointRadius = options.pointRadius;
    kept.lineRadius = options.lineRadius;
    kept.missingTextures = options.missingTextures;
    kept.confined = options.confined;
    kept.maxTexture = options.maxTexture;
    kept.floor = options.floor;
    kept.aspectRatio = options.aspectRatio;
    kept.yfov = options.yfov;
    return kept;
}

}  // namespace

void Session::drop(const std::filesystem::path& file)
{
    const std::string kind = kindOf(file);
    if (kind == ".gltf" || kind == ".glb") {
        dropped_ = std::make_unique<SceneLoader>(file, ofEveryScene(changes_.options()), options_.split);
    } else if (kind == ".hdr" || kind == ".exr") {
        LoadOptions options = changes_.options();
        options.environment = file;
        changes_.change(options, ++action_);
        maps_ = findMaps(scene_, options);
    } else {
        tell(file.string() + ": what is dropped here is a scene (.gltf, .glb) or an environment (.hdr, .exr)");
    }
}

// If it is refused, the present scene stays.
void Session::takeDropped()
{
    if (!dropped_) {
        return;
    }
    try {
        if (std::unique_ptr<LoadedScene> loaded = dropped_->take()) {
            enterDropped(std::move(loaded));
        }
    } catch (const std::bad_alloc&) {
        dropped_.reset();
        tell("the scene that was dropped: " + memorySentence());
    } catch (const std::exception& error) {  // a lost device fails again in the next pass
        dropped_.reset();
        tell(error.what());
    }
}

// Camera, lens, edits and time start anew.
void Session::enterDropped(std::unique_ptr<LoadedScene> loaded)
{
    checkPicture(loaded->prepared, size());
    exchange(std::move(loaded));
    loader_ = std::exchange(dropped_, nullptr);
    scene_ = pictures_.scene().scene.file;
    changes_ = SceneChanges(pictures_.options());
    maps_ = findMaps(scene_, changes_.options());
    timeline_ = Timeline({});
    lens_ = LensControl(options_.lens);
    viewpoint_.emplace(0, std::nullopt, options_.field, options_.projection);
    viewpoint_->enter(pictures_.scene().scene);
    timeline_.enter(pictures_.scene().scene.animations);
    messages_.trouble.clear();
    show();
}

}  // namespace glim
