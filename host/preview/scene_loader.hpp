// Loads the scene in a thread of its own, and again whenever its file changes.
#pragma once

#include "host/render/prepare_scene.hpp"

#include <chrono>
#include <future>
#include <mutex>

namespace glim {

class SceneLoader {
public:
    SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split);

    // A scene that has been loaded since the last call, or nothing. Throws InputError if loading it failed.
    std::unique_ptr<PreparedScene> take();
    // What it is doing, as in "loading a.gltf"; empty when nothing.
    std::string stage() const;

private:
    // A file that is being written changes until its size and time stay for two looks.
    struct Stamp {
        std::filesystem::file_time_type time;
        std::uintmax_t size = 0;
        bool operator==(const Stamp&) const = default;
    };
    Stamp look() const;
    void begin();

    std::filesystem::path file_;
    LoadOptions options_;
    SplitRule split_;
    Stamp loaded_, seen_;
    std::chrono::steady_clock::time_point lastLook_;
    mutable std::mutex mutex_;
    std::string stage_;
    std::future<std::unique_ptr<PreparedScene>> loading_;
};

}  // namespace glim
