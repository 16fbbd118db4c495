#include "host/cli/fastest_schedule.hpp"

#include "host/cli/version.hpp"
#include "host/error.hpp"
#include "host/image/whole_file.hpp"
#include "host/render/measure_schedules.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace glim {
namespace {

using Json = nlohmann::ordered_json;

// As many as 512x512 pixels have at 64 samples: ten seconds on two cores without a GPU, of which measuring takes one.
constexpr std::uint64_t kLongRender = 1U << 24;

bool isLong(const RenderSettings& settings)
{
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    return pixels * (settings.sampleEnd - settings.sampleBegin) >= kLongRender && settings.seconds.value_or(10.0) >= 10.0;
}

// Empty where nothing is to be kept.
std::filesystem::path cacheFolder()
{
    if (const char* given = std::getenv("GLIM_CACHE_DIR")) {
        return given;
    }
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    if (cache != nullptr && std::filesystem::path(cache).is_absolute()) {  // others are to be ignored (XDG Base Directory 0.8)
        return std::filesystem::path(cache) / "glim";
    }
    return home != nullptr && *home != '\0' ? std::filesystem::path(home) / ".cache" / "glim" : std::filesystem::path();
}

std::filesystem::path rememberedFile() { return cacheFolder() / "schedules.json"; }

// Makes the folder where there is none.
bool canRemember()
{
    if (cacheFolder().empty()) {
        return false;
    }
    std::error_code ignored;
    std::filesystem::create_directories(cacheFolder(), ignored);
    try {
        checkWritable(rememberedFile(), ".json");
    } catch (const InputError&) {
        return false;
    }
    return true;
}

std::string keyOf(const DeviceDescription& device) { return device.name + ", " + device.driver; }

Json readRemembered()
{
    std::ifstream file(rememberedFile());
    const Json json = Json::parse(file, nullptr, false);
    return json.is_object() ? json : Json::object();
}

void remember(const DeviceDescription& device, const ScheduleRates& rates)
{
    Json json = readRemembered();
    json[keyOf(device)] = {{"version", versionText()},
                           {"fastest", nameOf(rates.fastest())},
                           {"samplesPerSecond", {{"wavefront", rates.wavefront}, {"persistent", rates.persistent}}}};
    const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
    WholeFile file(rememberedFile());
    file.write(text.data(), text.size());
    file.commit();
}

void report(const ScheduleRates& rates)
{
    char text[128];
    std::snprintf(text, sizeof text, "glim: measured once on this device: persistent %.2f, wavefront %.2f Msamples/s; kept in ",
                  1e-6 * rates.persistent, 1e-6 * rates.wavefront);
    std::cerr << text << rememberedFile().string() << '\n';
}

}  // namespace

Schedule rememberedSchedule(const DeviceDescription& device)
{
    const Json json = readRemembered();
    const auto found = json.find(keyOf(device));
    if (found == json.end() || !found->is_object() || found->value("version", Json()) != versionText()) {
        return Schedule::Auto;
    }
    const Json fastest = found->value("fastest", Json());
    return fastest == nameOf(Schedule::Persistent)  ? Schedule::Persistent
           : fastest == nameOf(Schedule::Wavefront) ? Schedule::Wavefront
                                                    : Schedule::Auto;
}

Schedule fastestSchedule(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    const Schedule remembered = rememberedSchedule(device.description());
    if (remembered != Schedule::Auto || !isLong(settings) || !canMeasureSchedules(scene, settings) || !canRemember()) {
        return remembered;
    }
    const ScheduleRates rates = measureSchedules(device, scene, camera, settings);
    try {
        remember(device.description(), rates);
        report(rates);
    } catch (const InputError& error) {  // the disk is full, say
        std::cerr << "glim: the faster schedule will be measured again: " << error.what() << '\n';
    }
    return rates.fastest();
}

}  // namespace glim
