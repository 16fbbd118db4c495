// Loads the scene in a thread of its own, and again whenever its file or one of its buffers' changes.
#pragma once

#include "host/render/prepare_scene.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>

namespace glim {

class SceneLoader {
public:
    SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split);

    ~SceneLoader() { ended_ = true; }  // and waits for the end of the stage under way

    // A scene that has been loaded since the last call, or nothing. Throws what loading it threw.
    std::unique_ptr<PreparedScene> take();
    // What it is doing, as in "loading a.gltf"; empty when nothing.
    std::string stage() const;

private:
    struct Stamp {
        std::filesystem::file_time_type time;
        std::uintmax_t size = 0;
        bool operator==(const Stamp&) const = default;
    };
    // Of each file; nothing while one is missing, as between the two steps of some editors' saving.
    std::vector<Stamp> look() const;
    bool hasChanged();
    void begin();
    void watch(const std::vector<std::filesystem::path>& files);

    std::filesystem::path file_;
    std::vector<std::filesystem::path> files_;  // that the scene was read from last; its own is the first
    LoadOptions options_;
    SplitRule split_;
    std::vector<Stamp> loaded_, seen_;          // when loading began, and at the last look
    std::filesystem::file_time_type began_;     // the last loading
    std::chrono::steady_clock::time_point lastLook_;
    std::atomic<bool> ended_ = false;
    mutable std::mutex mutex_;
    std::string stage_;
    std::future<std::unique_ptr<PreparedScene>> loading_;
};

}  // namespace glim
