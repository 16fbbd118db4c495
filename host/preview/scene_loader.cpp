#include "host/preview/scene_loader.hpp"

#include "host/error.hpp"

#include <utility>

namespace glim {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{250};

}  // namespace

SceneLoader::SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split)
    : file_(std::move(file)), files_{file_}, options_(options), split_(split), lastLook_(std::chrono::steady_clock::now())
{
    loaded_ = seen_ = look();
    begin();
}

std::vector<SceneLoader::Stamp> SceneLoader::look() const
{
    std::vector<Stamp> stamps;
    for (const std::filesystem::path& file : files_) {
        std::error_code missing;
        stamps.push_back({std::filesystem::last_write_time(file, missing), 0});
        stamps.back().size = missing ? 0 : std::filesystem::file_size(file, missing);
        if (missing) {
            return {};
        }
    }
    return stamps;
}

// And stays so for two looks: it may still be being written at the first.
bool SceneLoader::hasChanged()
{
    const auto now = std::chrono::steady_clock::now();
    if (now - lastLook_ < kBetweenLooks) {
        return false;
    }
    lastLook_ = now;
    const std::vector<Stamp> before = std::exchange(seen_, look());
    return seen_ == before && seen_ != loaded_ && !seen_.empty();
}

void SceneLoader::begin()
{
    loading_ = std::async(std::launch::async, [this] {
        return std::make_unique<PreparedScene>(prepareScene(file_, options_, split_, [this](const std::string& stage) {
            if (ended_) {
                throw InputError("loading was given up");
            }
            const std::lock_guard lock(mutex_);
            stage_ = stage;
        }));
    });
}

std::unique_ptr<PreparedScene> SceneLoader::take()
{
    if (!loading_.valid()) {
        if (hasChanged()) {
            loaded_ = seen_;
            begin();
        }
        return nullptr;
    }
    if (loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return nullptr;
    }
    {
        const std::lock_guard lock(mutex_);
        stage_.clear();
    }
    std::unique_ptr<PreparedScene> prepared = loading_.get();
    if (prepared->scene.files != files_) {
        files_ = prepared->scene.files;
        loaded_ = look();
    }
    return prepared;
}

std::string SceneLoader::stage() const
{
    const std::lock_guard lock(mutex_);
    return stage_;
}

}  // namespace glim
