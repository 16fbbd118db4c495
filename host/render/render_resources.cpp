#include "host/render/render_resources.hpp"

#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/check_infinities.hpp"
#include "shaders/shared/bindings.h"

#include <utility>

namespace glim {

Schedule chooseSchedule(const RenderSettings& settings, const DeviceDescription& device, FeatureMask features)
{
    const bool course = usesCourseEstimators(settings);
    if (settings.schedule == Schedule::Persistent && course) {
        throw InputError(MessageId::Conflict, {part::place("--schedule"), " ", part::value("persistent"),
                                               ": the course's estimators (--direct, --roulette, --accelerator, --intersector) need ",
                                               part::expected("--schedule wavefront"), "."});
    }
    if (settings.schedule != Schedule::Auto) {
        return settings.schedule;
    }
    const bool scatters = (features & kFeatureScattering) != 0;
    return !course && !scatters && rulesOf(device.deviceClass).persistent ? Schedule::Persistent : Schedule::Wavefront;
}

namespace {

// But for what a specialization says.
bool hasSameKernels(const RenderResources& other, const FlatScene& scene, const RenderSettings& asked)
{
    return other.schedule == chooseSchedule(asked, other.device.description(), scene.features) && other.settings.course == asked.course &&
           isCourse(other.settings.adaptive) == isCourse(asked.adaptive) && other.settings.learns == asked.learns;
}

// At once, of those that learn: an eighth of the least storage buffer that Vulkan allows.
constexpr std::uint32_t kRecordedPaths = 65536;

}  // namespace

RenderResources::RenderResources(Device& of, std::shared_ptr<SharedResources> resources, std::shared_ptr<const CompiledKernels> kernels,
                                 const FlatScene& scene, const FlatCamera& camera, const RenderSettings& asked)
    : device(of),
      settings(asked),
      schedule(chooseSchedule(asked, of.description(), scene.features)),
      lightCount(static_cast<std::uint32_t>(scene.lights.size())),
      scatters((scene.features & kFeatureScattering) != 0 && !usesCourseEstimators(asked)),
      shared(std::move(resources)),
      parameters(of, scene, camera, asked),
      guide(std::make_unique<GuideBuffers>(of, asked.guide ? *asked.guide : emptyGuide(), asked.learns ? kRecordedPaths : 0)),
      course(of, scene, asked),
      compiled(kernels && serves(kernels->set.specialization, specialize(scene, camera, asked, of.description())) ? std::move(kernels)
                                                                                                                  : compile(scene, camera))
{
    runOnce();
}

RenderResources::RenderResources(Device& of, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& asked,
                                 LastingResources lasting)
    : RenderResources(of,
                      std::make_shared<SharedResources>(
                          SharedResources{DeviceScene(of, scene, std::move(lasting.buffers)),
                                          PathBuffers(of, choosePathCapacity(asked, of.description()), asked.groupCount())}),
                      std::move(lasting.kernels), scene, camera, asked)
{}

RenderResources::RenderResources(const RenderResources& other, const FlatScene& scene, const FlatCamera& camera,
                                 const RenderSettings& asked)
    : RenderResources(other.device, other.shared, hasSameKernels(other, scene, asked) ? other.compiled : nullptr, scene, camera, asked)
{}

bool RenderResources::hasKernels(const FlatScene& scene, const FlatCamera& camera) const
{
    const Specialization needed = specialize(scene, camera, settings, device.description());
    return serves(kernels().specialization, needed) || (spare && serves(spare->set.specialization, needed));
}

void RenderResources::adapt(const FlatScene& scene, const FlatCamera& camera)
{
    const Specialization needed = specialize(scene, camera, settings, device.description());
    if (serves(kernels().specialization, needed)) {
        return;
    }
    const bool isNew = !spare || !serves(spare->set.specialization, needed);
    if (isNew) {
        spare = compile(scene, camera);  // may throw
    }
    std::swap(compiled, spare);
    if (isNew) {
        runOnce();
    }
}

void RenderResources::clearStatistics()
{
    statistics.clear();
    shared->paths.clearCounters();
}

BufferMap RenderResources::constants() const
{
    BufferMap constants = shared->scene.buffers();
    constants.insert({{kBindParameters, &parameters.buffer()},
                      {kBindCourseParameters, &course.parameters()},
                      {kBindGuide, &guide->texels()},
                      {kBindGuideRecords, &guide->records()}});
    return constants;
}

std::unique_ptr<Tile> RenderResources::makeTile(std::uint32_t begin, std::uint32_t count) const
{
    return std::make_unique<Tile>(device, compiled->layout, constants(), shared->paths, begin, count, settings);
}

std::unique_ptr<SplatBuffer> RenderResources::makeSplatBuffer(const RenderSettings& of) const
{
    return std::make_unique<SplatBuffer>(device, compiled->layout, constants(), shared->paths, of);
}

std::shared_ptr<const CompiledKernels> RenderResources::compile(const FlatScene& scene, const FlatCamera& camera)
{
    refuseLostInfinities(device);
    const auto start = Clock::now();
    auto kernels = std::make_shared<CompiledKernels>(device, scene, camera, settings, schedule);
    compileSeconds += secondsSince(start);
    device.pipelines().write();  // now, since programs that render for long may be killed
    return kernels;
}

// Some drivers compile a kernel at its first dispatch. This one has nothing to do, so that no timed dispatch pays for that.
void RenderResources::runOnce()
{
    const auto start = Clock::now();
    const std::unique_ptr<Tile> tile = makeTile(0, 1);
    RenderSettings onePixel;
    onePixel.width = onePixel.height = 1;
    const std::unique_ptr<SplatBuffer> splats = makeSplatBuffer(onePixel);
    CoursePass nothing{tile->pass(), {}};
    shared->paths.setRounds(makeRounds(0, 0));
    Commands commands(device);
    for (const Kernel* kernel : kernels().all()) {
        const bool light = kernels().traceLightPaths && (kernel == &*kernels().traceLightPaths || kernel == &*kernels().addSplats);
        commands.dispatch(*kernel, light ? splats->bands().front()->bindings(0) : tile->bindings(0),
                          std::as_bytes(std::span<const CoursePass, 1>(&nothing, 1)), 1);
    }
    commands.submitAndWait();
    compileSeconds += secondsSince(start);
}

}  // namespace glim
