// Loads the scene in a thread of its own, and loads it again whenever one of its files changes.
#pragma once

#include "host/preview/stamps.hpp"
#include "host/render/prepare_scene.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>

namespace glim {

// A scene, and its file to change it by.
struct LoadedScene {
    LoadedScene(const std::filesystem::path& path, const LoadOptions& options)
        : file(path, options)
    {}

    SceneFile file;
    PreparedScene prepared;
};

class SceneLoader {
public:
    SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split);

    ~SceneLoader() { ended_ = true; }  // then waits until the current stage ends

    // The scene if it has been loaded since the last call, or null. Throws what loading threw.
    std::unique_ptr<LoadedScene> take();
    // Of scenes that are loaded from now on.
    void setOptions(const LoadOptions& options) { options_ = options; }
    // The current stage, as in "loading a.gltf"; empty if nothing is being loaded.
    std::string stage() const;

private:
    using Stamps = std::vector<FileStamp>;
    // The stamp of each file. Empty while a file is missing.
    Stamps readStamps() const;
    void begin();
    void watch(const std::vector<std::filesystem::path>& files);

    std::filesystem::path file_;
    std::vector<std::filesystem::path> files_;  // that the scene was read from; the glTF file is the first
    LoadOptions options_;
    SplitRule split_;
    Stamps loaded_;  // the stamps when loading began
    StampWatch<Stamps> watch_;
    std::filesystem::file_time_type began_;  // when the last loading began
    std::atomic<bool> ended_ = false;
    mutable std::mutex mutex_;
    std::string stage_;
    std::future<std::unique_ptr<LoadedScene>> loading_;
};

}  // namespace glim
