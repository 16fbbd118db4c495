#include "host/preview/scene_loader.hpp"

#include <utility>

namespace glim {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{250};

}  // namespace

SceneLoader::SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split)
    : file_(std::move(file)), options_(options), split_(split), lastLook_(std::chrono::steady_clock::now())
{
    loaded_ = seen_ = look();
    begin();
}

SceneLoader::Stamp SceneLoader::look() const
{
    std::error_code missing;  // as between the two steps of some editors' saving
    const auto time = std::filesystem::last_write_time(file_, missing);
    const std::uintmax_t size = std::filesystem::file_size(file_, missing);
    return missing ? Stamp{} : Stamp{time, size};
}

void SceneLoader::begin()
{
    loading_ = std::async(std::launch::async, [this] {
        return std::make_unique<PreparedScene>(prepareScene(file_, options_, split_, [this](const std::string& stage) {
            const std::lock_guard lock(mutex_);
            stage_ = stage;
        }));
    });
}

std::unique_ptr<PreparedScene> SceneLoader::take()
{
    if (loading_.valid()) {
        if (loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            return nullptr;
        }
        {
            const std::lock_guard lock(mutex_);
            stage_.clear();
        }
        return loading_.get();
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - lastLook_ >= kBetweenLooks) {
        lastLook_ = now;
        const Stamp before = std::exchange(seen_, look());
        if (seen_ == before && seen_ != loaded_ && seen_ != Stamp{}) {
            loaded_ = seen_;
            begin();
        }
    }
    return nullptr;
}

std::string SceneLoader::stage() const
{
    const std::lock_guard lock(mutex_);
    return stage_;
}

}  // namespace glim
