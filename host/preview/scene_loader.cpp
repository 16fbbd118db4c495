#include "host/preview/scene_loader.hpp"

#include "host/error.hpp"

#include <utility>

namespace glim {
namespace {

constexpr std::chrono::milliseconds kStampInterval{250};

}  // namespace

SceneLoader::SceneLoader(std::filesystem::path file, LoadOptions options, SplitRule split)
    : file_(std::move(file)),
      files_{file_},
      options_(options),
      split_(split),
      lastRead_(std::chrono::steady_clock::now())
{
    begin();
    seen_ = loaded_;
}

std::vector<SceneLoader::Stamp> SceneLoader::readStamps() const
{
    std::vector<Stamp> stamps;
    for (const std::filesystem::path& file : files_) {
        std::error_code missing;
        stamps.push_back({std::filesystem::last_write_time(file, missing), 0});
        if (missing) {
            return {};
        }
        if (std::filesystem::is_regular_file(file, missing)) {
            stamps.back().size = std::filesystem::file_size(file, missing);
        }
    }
    return stamps;
}

// Whether the files have changed and then stayed the same for one interval: a program may still write them.
bool SceneLoader::hasChanged()
{
    const auto now = std::chrono::steady_clock::now();
    if (now - lastRead_ < kStampInterval) {
        return false;
    }
    lastRead_ = now;
    const std::vector<Stamp> before = std::exchange(seen_, readStamps());
    return seen_ == before && seen_ != loaded_ && !seen_.empty();
}

void SceneLoader::begin()
{
    loaded_ = readStamps();
    began_ = std::filesystem::file_time_type::clock::now();
    loading_ = std::async(std::launch::async, [this, options = options_] {
        auto loaded = std::make_unique<LoadedScene>(file_, options);
        updateScene(loaded->prepared, loaded->file, options.at, split_, [this](const std::string& stage) {
            if (ended_) {
                throw InputError(MessageId::Stopped, {"loading was given up"});
            }
            const std::lock_guard lock(mutex_);
            stage_ = stage;
        });
        return loaded;
    });
}

std::unique_ptr<LoadedScene> SceneLoader::take()
{
    if (!loading_.valid()) {
        if (hasChanged()) {
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
    try {
        std::unique_ptr<LoadedScene> loaded = loading_.get();
        watch(loaded->prepared.scene.files);
        return loaded;
    } catch (...) {
        watch({file_, std::filesystem::absolute(file_).parent_path()});  // a missing file may appear in the folder
        throw;
    }
}

// Watches `files` from now on. A file that was written after loading began counts as changed.
void SceneLoader::watch(const std::vector<std::filesystem::path>& files)
{
    if (files == files_) {
        return;
    }
    const std::vector<Stamp> before = std::exchange(loaded_, {});
    files_ = files;
    loaded_ = readStamps();
    for (Stamp& stamp : loaded_) {
        stamp = stamp.time < began_ ? stamp : Stamp{};
    }
    if (!before.empty() && !loaded_.empty()) {
        loaded_.front() = before.front();  // the glTF file, whose stamp was read before
    }
}

std::string SceneLoader::stage() const
{
    const std::lock_guard lock(mutex_);
    return stage_;
}

}  // namespace glim
