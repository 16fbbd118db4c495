#include "host/job/fastest_schedule.hpp"

#include "host/error.hpp"
#include "host/image/atomic_file.hpp"
#include "host/job/output_file.hpp"
#include "host/job/version.hpp"
#include "host/message.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace glim {
namespace {

// Samples of 512x512 pixels at 64 each.
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
    if (cache != nullptr && std::filesystem::path(cache).is_absolute()) {  // relative paths are to be ignored (XDG Base Directory 0.8)
        return std::filesystem::path(cache) / "glim";
    }
    return home != nullptr && *home != '\0' ? std::filesystem::path(home) / ".cache" / "glim" : std::filesystem::path();
}

std::filesystem::path rememberedFile() { return cacheFolder() / "schedules.json"; }

// Makes the folder if there is none.
bool canRemember()
{
    if (cacheFolder().empty()) {
        return false;
    }
    std::error_code ignored;
    std::filesystem::create_directories(cacheFolder(), ignored);
    try {
        checkWritable(rememberedFile());
    } catch (const InputError&) {
        return false;
    }
    return true;
}

std::string keyOf(const DeviceDescription& device) { return device.name + ", " + device.driver; }

Json readRemembered()
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(rememberedFile(), ignored)) {
        return Json::object();
    }
    std::ifstream file(rememberedFile());
    const std::optional<Json> json = Json::parse({std::istreambuf_iterator<char>(file), {}});
    return json && json->isObject() ? *json : Json::object();
}

double slowest(const std::vector<double>& rates) { return *std::ranges::min_element(rates); }

void remember(const DeviceDescription& device, const ScheduleRates& rates)
{
    Json json = readRemembered();
    json.set(keyOf(device), {{"version", versionText()},
                             {"fastest", getName(rates.fastest())},
                             {"samplesPerSecond", {{"wavefront", slowest(rates.wavefront)}, {"persistent", slowest(rates.persistent)}}}});
    writeJson(rememberedFile(), json);
}

void report(const ScheduleRates& rates)
{
    char text[128];
    std::snprintf(text, sizeof text, "measured once on this device: persistent %.2f, wavefront %.2f Msamples/s; kept in ",
                  1e-6 * slowest(rates.persistent), 1e-6 * slowest(rates.wavefront));
    say(MessageId::ScheduleChosen, {text, part::file(rememberedFile())});
}

}  // namespace

Schedule rememberedSchedule(const DeviceDescription& device)
{
    if (device.software) {
        return Schedule::Auto;
    }
    const Json json = readRemembered();
    const Json* found = json.find(keyOf(device));
    const Json* version = found != nullptr ? found->find("version") : nullptr;
    const Json* fastest = found != nullptr ? found->find("fastest") : nullptr;
    if (version == nullptr || !version->is(versionText()) || fastest == nullptr) {
        return Schedule::Auto;
    }
    return fastest->is(getName(Schedule::Persistent))  ? Schedule::Persistent
           : fastest->is(getName(Schedule::Wavefront)) ? Schedule::Wavefront
                                                       : Schedule::Auto;
}

Schedule fastestSchedule(const DeviceDescription& device, const RenderSettings& settings, const std::function<ScheduleRates()>& measure)
{
    const Schedule remembered = rememberedSchedule(device);
    if (device.software || remembered != Schedule::Auto || !isLong(settings) || !canMeasureSchedules(settings) || !canRemember()) {
        return remembered;
    }
    const ScheduleRates rates = measure();
    if (rates.fastest() == Schedule::Auto) {
        return Schedule::Auto;
    }
    try {
        remember(device, rates);
        report(rates);
    } catch (const InputError& error) {  // the disk is full, say
        say(MessageId::ScheduleForgotten, {"the faster schedule will be measured again: ", error.what()});
    }
    return rates.fastest();
}

}  // namespace glim
