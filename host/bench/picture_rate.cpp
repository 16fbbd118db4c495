#include "host/bench/picture_rate.hpp"

#include "host/render/renderer.hpp"

#include <algorithm>

namespace glim {
namespace {

double secondsOf(std::uint64_t count, const char* rays, const std::vector<KernelRate>& rates)
{
    const auto found = std::find_if(rates.begin(), rates.end(), [&](const KernelRate& rate) { return rate.rays == rays; });  // as rendered
    return count == 0 || found == rates.end() ? 0.0 : static_cast<double>(count) / found->rate.median;
}

double secondsOfRender(Renderer& renderer, const FlatCamera& camera)
{
    renderer.restart(camera, renderer.settings().seed);
    const auto start = std::chrono::steady_clock::now();
    renderer.render([](const RenderProgress&) { return true; });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<PictureRate> measurePictureRate(Device& device, const FlatScene& scene, const FlatCamera& camera,
                                              const RenderSettings& settings, const std::vector<KernelRate>& rates,
                                              const std::function<bool(int round)>& goesOn)
{
    RenderSettings eight = settings;
    eight.sampleEnd = kPictureSamples;
    Renderer renderer(device, scene, camera, eight);
    std::vector<double> seconds;
    for (int round = -1; round < kPictureRenders; ++round) {  // uncounted the first time: what is dispatched first takes longer
        if (!goesOn(std::max(0, round))) {
            return std::nullopt;
        }
        const double took = secondsOfRender(renderer, camera);
        if (round >= 0) {
            seconds.push_back(took);
        }
    }
    const RenderStatistics& all = renderer.statistics();  // of kPictureRenders + 1 renders with the same paths
    PictureRate picture{all.schedule, all.samples, all.cameraAndBounceRays, all.shadowRays, spreadOf(seconds), 0.0};
    for (std::uint64_t* sum : {&picture.samples, &picture.closest, &picture.shadow}) {
        *sum /= kPictureRenders + 1;
    }
    picture.traceSeconds = secondsOf(picture.samples, "primary", rates) + secondsOf(picture.closest - picture.samples, "diffuse", rates) +
                           secondsOf(picture.shadow, "shadow", rates);
    return picture;
}

}  // namespace glim
