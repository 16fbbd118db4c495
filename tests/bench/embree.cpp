#include "tests/bench/embree.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <stdexcept>
#include <thread>

namespace glim {
namespace {

constexpr std::size_t kChunk = 512;  // rays that a thread takes at once

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Calls `trace` for every index; returns the seconds.
double onAllThreads(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& trace)
{
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t begin = next.fetch_add(kChunk); begin < count; begin = next.fetch_add(kChunk)) {
            trace(begin, std::min(count, begin + kChunk));
        }
    };
    const Clock::time_point start = Clock::now();
    std::vector<std::thread> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
        others.emplace_back(work);
    }
    work();
    for (std::thread& other : others) {
        other.join();
    }
    return secondsSince(start);
}

RTCRay rayOf(const vec3& origin, const vec3& direction, float tfar)
{
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = tfar;
    ray.mask = ~0U;
    return ray;
}

}  // namespace

Embree::Embree(const Primitives& primitives)
    : device_(rtcNewDevice(nullptr)),
      scene_(rtcNewScene(device_))
{
    if (!primitives.spheres.empty()) {
        throw std::runtime_error("The scene has spheres; expected triangles alone, which Embree is compared with.");
    }
    const Clock::time_point start = Clock::now();
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                     sizeof(glm::vec3), 3 * primitives.triangles.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                        3 * sizeof(std::uint32_t), primitives.triangles.size()));
    for (std::size_t i = 0; i < 3 * primitives.triangles.size(); ++i) {
        vertices[i] = primitives.triangles[i / 3].vertices[i % 3];
        indices[i] = static_cast<std::uint32_t>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    buildSeconds_ = secondsSince(start);
}

Embree::~Embree()
{
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

Embree::Closest Embree::trace(std::span<const PathRay> rays) const
{
    Closest closest{std::vector<Hit>(rays.size()), 0.0};
    closest.seconds = onAllThreads(rays.size(), [&](std::size_t begin, std::size_t end) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRayHit hit{};
            hit.ray = rayOf(rays[i].origin, rays[i].direction, std::numeric_limits<float>::infinity());
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &hit);
            const bool met = hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            closest.hits[i] = {met ? hit.hit.primID : kNoPrimitive, hit.ray.tfar};
        }
    });
    return closest;
}

Embree::Shadow Embree::trace(std::span<const ShadowRay> rays) const
{
    Shadow shadow{std::vector<char>(rays.size()), 0.0};
    shadow.seconds = onAllThreads(rays.size(), [&](std::size_t begin, std::size_t end) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (std::size_t i = begin; i < end; ++i) {
            RTCRay ray = rayOf(rays[i].origin, rays[i].direction, rays[i].tMax);
            rtcOccluded1(scene_, &context, &ray);
            shadow.free[i] = ray.tfar >= 0.0F ? 1 : 0;
        }
    });
    return shadow;
}

}  // namespace glim
