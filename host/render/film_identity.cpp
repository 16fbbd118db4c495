#include "host/render/film_identity.hpp"

#include "host/fingerprint.hpp"
#include "host/gpu/commands.hpp"
#include "host/text.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <mutex>

namespace glim {
namespace {

// To be raised when the host changes bits that the scene's fingerprint does not know, as in the fold of pages or the light tree.
constexpr std::uint64_t kHostVersion = 1;

std::string probe(Device& device)
{
    const KernelLayout layout(device, {{kBindProbed, BufferKind::Readback}}, 0);
    const Kernel kernel(layout, kernels::probe_arithmetic, {{kSpecWorkgroup, 64}});
    constexpr std::size_t kCount = std::size_t{kProbedInputs} * kProbedOperations;
    const Buffer results(device, "probed arithmetic", BufferKind::Readback, kCount * sizeof(float));
    const Bindings bindings(layout, {{kBindProbed, &results}});
    Commands commands(device);
    commands.dispatch(kernel, bindings, {}, kProbedInputs / 64);
    commands.submitAndWait();
    Fingerprint print;
    print.add(download<float>(results, kCount));
    return hexadecimal(print.state());
}

}  // namespace

SceneIdentity::SceneIdentity(const FlatScene& scene)
    : fingerprint(glim::fingerprint(scene)),
      sharesMeshes((scene.features & kFeatureInstances) != 0)
{}

Film emptyFilm(const RenderSettings& settings)
{
    Film film;
    film.width = settings.width;
    film.height = settings.rowCount();
    film.rowsAbove = settings.rowBegin();
    film.rowsBelow = settings.height - settings.rowBegin() - settings.rowCount();
    return film;
}

FilmIdentity makeIdentity(const SceneIdentity& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    return {fingerprint(scene.fingerprint, camera), describeSettings(settings) + (scene.sharesMeshes ? " meshes=shared" : ""),
            settings.seed, kernelsFingerprint()};
}

std::vector<EmbeddedShader> filmKernels()
{
    return {kernels::generate_rays,
            kernels::accumulate,
            kernels::trace_paths,
            kernels::learn_guide,
            kernels::trace_closest,
            kernels::shade_surface,
            kernels::trace_shadow,
            kernels::trace_light_paths,
            kernels::add_splats,
            kernels::show_aov,
            kernels::course_trace_closest,
            kernels::course_sample_lights,
            kernels::course_trace_shadow,
            kernels::course_bounce,
            kernels::course_sample_hemisphere,
            kernels::course_trace_hemisphere,
            kernels::course_add_luminance,
            kernels::course_choose_pixels};
}

std::string kernelsFingerprint()
{
    static const std::string known = [] {
        Fingerprint print;
        print.add(std::vector<std::uint64_t>{kHostVersion});
        for (const EmbeddedShader& shader : filmKernels()) {
            print.addBytes(std::as_bytes(shader.words()));
        }
        return hexadecimal(print.state());
    }();
    return known;
}

std::string arithmeticFingerprint(Device& device)
{
    static std::mutex mutex;
    static std::map<std::pair<std::string, Arithmetic>, std::string> known;  // by device and driver
    const std::lock_guard lock(mutex);
    std::string& fingerprint = known[{device.description().name + ", " + device.description().driver, device.arithmetic()}];
    if (fingerprint.empty()) {
        fingerprint = probe(device);
    }
    return fingerprint;
}

}  // namespace glim
