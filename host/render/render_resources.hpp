// The resources of a render: the scene, the path buffers, the parameters, and the kernels themselves. Passes (pass_tracer.hpp), rays
// (ray_tracer.hpp) and single paths (replay.hpp) are traced with them.
#pragma once

#include "host/render/course.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/guide_buffers.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/parameters.hpp"
#include "host/render/path_buffers.hpp"
#include "host/render/recording.hpp"
#include "host/render/splats.hpp"

#include <limits>
#include <memory>

namespace glim {

// The schedule that a render is to use, of a scene with these features. Throws InputError if the one asked for cannot render the other
// settings.
Schedule chooseSchedule(const RenderSettings& settings, const DeviceDescription& device, FeatureMask features);

// What several renders of one scene may share. Only one of them may render at a time.
struct SharedResources {
    DeviceScene scene;
    PathBuffers paths;
};

// What the scene at another time may use again.
struct LastingResources {
    std::shared_ptr<const CompiledKernels> kernels;
    LastingBuffers buffers;
};

// What the last passes tell of the next one. No bit depends on it.
struct PassHistory {
    std::uint32_t rounds;                                      // to record at once
    std::uint32_t firstRound = 0;                              // of the last pass
    double seconds = std::numeric_limits<double>::infinity();  // of the device
};

struct RenderResources {
    // Uploads the scene and compiles the kernels for what it needs, unless those of `lasting`, made for the same settings, serve it too.
    RenderResources(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                    LastingResources lasting = {});
    // Shares the scene and the path buffers of `other`, which is of the same scene and must be idle while this one is used.
    RenderResources(const RenderResources& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);
    RenderResources(const RenderResources&) = delete;
    RenderResources& operator=(const RenderResources&) = delete;

    LastingResources lasting() const { return {compiled, shared->scene.lasting()}; }
    // Whether the present kernels, or those before, serve this camera.
    bool hasKernels(const FlatScene& scene, const FlatCamera& camera) const;
    // Takes other kernels if the present ones do not serve this camera, and compiles them if need be: a camera close to large triangles
    // needs kFeatureLargeTriangles. The kernels before stay for cameras that come back.
    void adapt(const FlatScene& scene, const FlatCamera& camera);
    // What paths are guided by from now on. Tiles made before are of no use afterwards.
    void setGuide(const Guide& of) { guide->set(device, of); }
    // Counters on the device too.
    void clearStatistics();

    // A tile of the film's pixels, all of them chosen.
    std::unique_ptr<Tile> makeTile(std::uint32_t begin, std::uint32_t count) const;
    // For the pixels of a picture with these settings.
    std::unique_ptr<SplatBuffer> makeSplatBuffer(const RenderSettings& of) const;

    const KernelSet& kernels() const { return compiled->set; }
    PathBuffers& paths() const { return shared->paths; }
    std::uint32_t countGroups(std::uint32_t count) const { return (count + settings.workgroup - 1) / settings.workgroup; }

    Device& device;
    const RenderSettings settings;
    const Schedule schedule;  // never Auto
    const std::uint32_t lightCount;
    const bool scatters;  // some volume does, and rounds are no bounces: walks take several
    const std::shared_ptr<SharedResources> shared;
    DeviceParameters parameters;
    const std::unique_ptr<GuideBuffers> guide;
    const CourseEstimators course;
    double compileSeconds = 0.0;
    std::shared_ptr<const CompiledKernels> compiled, spare;
    std::map<std::string, KernelStatistics> statistics;
    PassHistory history{.rounds = schedule == Schedule::Persistent ? 1U : 8U};

private:
    RenderResources(Device& device, std::shared_ptr<SharedResources> shared, std::shared_ptr<const CompiledKernels> kernels,
                    const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);
    // Both add to compileSeconds.
    std::shared_ptr<const CompiledKernels> compile(const FlatScene& scene, const FlatCamera& camera);
    void runOnce();
    BufferMap constants() const;
};

}  // namespace glim
