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
      watch_(kStampInterval, readStamps())
{
    begin();
}

SceneLoader::Stamps SceneLoader::readStamps() const
{
    Stamps stamps;
    for (const std::filesystem::path& file : files_) {
        const std::optional<FileStamp> stamp = readStamp(file);
        if (!stamp) {
            return {};
        }
        stamps.push_back(*stamp);
    }
    return stamps;
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
        if (watch_.hasChanged(loaded_, [this] { return readStamps(); }) && !watch_.seen().empty()) {
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
    const Stamps before = std::exchange(loaded_, {});
    files_ = files;
    loaded_ = readStamps();
    for (FileStamp& stamp : loaded_) {
        stamp = stamp.time < began_ ? stamp : FileStamp{};
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
