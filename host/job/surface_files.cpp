#include "host/job/surface_files.hpp"

#include "host/clock.hpp"
#include "host/job/output_file.hpp"
#include "host/render/identify.hpp"
#include "host/render/seen_instances.hpp"

namespace glim {
namespace {

OtherMoment momentAt(SceneSession& session, const RenderJob& job, const PictureFrame& frame, double time)
{
    OtherMoment moment{session.sceneAt(time), {}};
    const float aspect = static_cast<float>(frame.settings.width) / static_cast<float>(frame.settings.height);
    moment.camera = flattenCamera(makeCamera(moment.scene, job), aspect, job.lens);
    return moment;
}

}  // namespace

std::optional<Flow> makeFlow(SceneSession& session, const RenderJob& job, const PictureFrame& frame)
{
    if (!job.flow) {
        return std::nullopt;
    }
    const double now = job.at.value();
    return Flow{momentAt(session, job, frame, now + *job.flow), momentAt(session, job, frame, now - *job.flow)};
}

std::optional<double> SurfaceFiles::write(SceneSession& session, const RenderJob& job, const PictureFrame& frame, const Film& film)
{
    if (!job.ids && !job.surfaces && !job.objects) {
        return std::nullopt;
    }
    const auto start = Clock::now();
    if (job.ids) {
        Identifier identifier(session.renderer(), session.prepared(), frame.camera, sampleKernels_);
        writeIds(*job.ids, identifier, film);
        sampleKernels_ = identifier.kernels();
    }
    if (job.surfaces || job.objects) {
        const SceneInstances instances(session.prepared().scene);
        const std::optional<Flow> flow = makeFlow(session, job, frame);
        SurfaceTracer tracer(session.renderer(), session.prepared(), frame.camera, instances, flow ? &*flow : nullptr, centerKernels_);
        if (job.surfaces) {
            writeSurfaces(*job.surfaces, tracer, film);
        }
        if (job.objects) {
            const glm::uvec2 size(film.width, film.height);
            writeJson(*job.objects, describeSeenInstances(tracer, instances, size, job.mainFile().filename().string()));
        }
        centerKernels_ = tracer.kernels();
    }
    return secondsSince(start);
}

}  // namespace glim
