#include "host/render/path_buffers.hpp"

#include "host/gpu/commands.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/path_types.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

namespace glim {
namespace {

template <class T>
Buffer makeArray(Device& device, const std::string& name, std::uint64_t count, BufferKind kind = BufferKind::Storage)
{
    return Buffer(device, name, kind, count * sizeof(T));
}

// An array whose elements are whole texels.
template <class T>
Buffer texelArrayOf(Device& device, const std::string& name, std::uint64_t count)
{
    static_assert(sizeof(T) % 16 == 0);
    return makeArray<T>(device, name, count, BufferKind::Both);
}

BufferMap merged(BufferMap a, const BufferMap& b)
{
    a.insert(b.begin(), b.end());
    return a;
}

constexpr std::uint64_t kPathBytes =
    sizeof(PathRay) + sizeof(PathHit) + sizeof(PathState) + sizeof(PathRadiance) + sizeof(FirstHit) + sizeof(ShadowRay) + 3 * sizeof(uint);

std::uint64_t groupBytesOf(std::uint32_t lightGroups) { return lightGroups == 0 ? 0 : sizeof(uint) + lightGroups * sizeof(vec3); }

// In one buffer.
std::uint64_t largestOfPath(std::uint32_t lightGroups) { return std::max(std::uint64_t{sizeof(ShadowRay)}, groupBytesOf(lightGroups)); }

std::vector<uint> firstSlots(std::size_t count)
{
    std::vector<uint> slots(count);
    std::iota(slots.begin(), slots.end(), 0U);
    return slots;
}

}  // namespace

std::vector<BindingSlot> kernelSlots()
{
    std::vector<BindingSlot> slots = DeviceScene::slots();
    for (std::uint32_t binding = kBindRays; binding <= kBindNote; ++binding) {
        slots.push_back({binding, binding <= kBindShadowRays ? BufferKind::Both : BufferKind::Storage, binding + kTexelsOf});
    }
    slots.push_back({kBindParameters, BufferKind::Storage});
    slots.push_back({kBindSplats, BufferKind::Storage});
    slots.push_back({kBindCatchers, BufferKind::Storage});
    slots.push_back({kBindGroupLight, BufferKind::Storage});
    slots.push_back({kBindGroupSums, BufferKind::Storage});
    slots.push_back({kBindGuide, BufferKind::Texel});
    slots.push_back({kBindGuideRecords, BufferKind::Storage});
    slots.push_back({kBindCourseParameters, BufferKind::Storage});
    return slots;
}

std::vector<Round> makeRounds(std::uint32_t paths, std::uint32_t groups)
{
    constexpr Queue kEmpty{0, uvec3(0, 1, 1)};
    std::vector<Round> rounds(kRounds, Round{kEmpty, kEmpty});
    rounds[0].paths = {paths, uvec3(groups, 1, 1)};
    return rounds;
}

std::uint32_t maxPathCapacity(const RenderSettings& settings, const DeviceDescription& device)
{
    const std::uint64_t most = std::min({std::uint64_t{device.maxGroups / kGroupsAtOnce * kGroupsAtOnce} * settings.workgroup,
                                         device.maxTexelElements / (sizeof(ShadowRay) / 16),
                                         std::min(device.maxStorageBuffer, device.maxAllocation) / largestOfPath(settings.groupCount())});
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most, kBlockSamples, 1U << 31U));
}

std::uint32_t choosePathCapacity(const RenderSettings& settings, const DeviceDescription& device)
{
    const std::uint32_t most = maxPathCapacity(settings, device), least = kBlockSamples * (settings.catcher ? 2 : 1);
    if (settings.pathCapacity) {
        return std::min(settings.catcher ? std::max(*settings.pathCapacity, least) : *settings.pathCapacity, most);
    }
    const auto ofMemory = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(device.memory / kPathPart / (kPathBytes + groupBytesOf(settings.groupCount())), most));
    return std::max(least, std::bit_floor(std::min(rulesOf(device.deviceClass).pathCapacity, ofMemory)));
}

PathBuffers::PathBuffers(Device& device, std::uint32_t capacity, std::uint32_t lightGroups)
    : rays_(texelArrayOf<PathRay>(device, "rays", capacity)),
      hits_(texelArrayOf<PathHit>(device, "hits", capacity)),
      states_(texelArrayOf<PathState>(device, "path states", capacity)),
      radiance_(texelArrayOf<PathRadiance>(device, "path radiances", capacity)),
      firstHits_(texelArrayOf<FirstHit>(device, "first hits", capacity)),
      shadowRays_(texelArrayOf<ShadowRay>(device, "shadow rays", capacity)),
      queueA_(makeArray<uint>(device, "queue's entries", capacity)),
      queueB_(makeArray<uint>(device, "queue's entries", capacity)),
      shadowQueue_(makeArray<uint>(device, "shadow queue's entries", capacity)),
      groupLight_(device, "paths' light by groups", BufferKind::Storage, std::max(sizeof(uint), capacity * groupBytesOf(lightGroups))),
      rounds_(makeArray<Round>(device, "rounds", kRounds, BufferKind::Readback)),
      rayCounts_(device, "ray counts", BufferKind::Readback, sizeof(RayCounts)),
      note_(device, "path's note", BufferKind::Readback, sizeof(PathNote)),
      status_(device, "status words", BufferKind::Readback, sizeof(Status))
{
    setRounds(makeRounds(0, 0));
    clearCounters();
    takeNote();
}

void PathBuffers::clearCounters()
{
    upload(rayCounts_, std::span<const RayCounts>(std::vector<RayCounts>(1)));
    upload(status_, std::span<const Status>(std::vector<Status>(1)));
}

std::uint64_t PathBuffers::sizeInBytes(std::uint32_t capacity, std::uint32_t lightGroups)
{
    return capacity * (kPathBytes + groupBytesOf(lightGroups)) + kRounds * sizeof(Round) + sizeof(RayCounts) + sizeof(PathNote) +
           sizeof(Status);
}

BufferMap PathBuffers::buffers(std::uint32_t parity) const
{
    return {{kBindRays, &rays_},
            {kBindHits, &hits_},
            {kBindStates, &states_},
            {kBindRadiance, &radiance_},
            {kBindFirstHits, &firstHits_},
            {kBindShadowRays, &shadowRays_},
            {kBindActiveQueue, parity == 0 ? &queueA_ : &queueB_},
            {kBindNextQueue, parity == 0 ? &queueB_ : &queueA_},
            {kBindShadowQueue, &shadowQueue_},
            {kBindGroupLight, &groupLight_},
            {kBindRounds, &rounds_},
            {kBindRayCounts, &rayCounts_},
            {kBindNote, &note_},
            {kBindStatus, &status_}};
}

void PathBuffers::queueRays(std::span<const PathRay> rays, std::uint32_t groups)
{
    setRounds(makeRounds(static_cast<std::uint32_t>(rays.size()), groups));
    upload(rays_, rays);
    upload(queueA_, std::span<const uint>(firstSlots(rays.size())));
}

void PathBuffers::queueShadowRays(std::span<const ShadowRay> rays, std::uint32_t groups)
{
    std::vector<Round> rounds = makeRounds(0, 0);
    rounds[0].shadowRays = {static_cast<uint>(rays.size()), uvec3(groups, 1, 1)};
    setRounds(rounds);
    std::vector<ShadowRay> light(rays.begin(), rays.end());
    for (ShadowRay& ray : light) {
        ray.contribution = vec3(1.0F);
    }
    upload(shadowRays_, std::span<const ShadowRay>(light));
    PathState met{};
    met.bounce = 1;  // what trace_shadow reads where volumes scatter
    upload(states_, std::span<const PathState>(std::vector<PathState>(rays.size(), met)));
    upload(shadowQueue_, std::span<const uint>(firstSlots(rays.size())));
    upload(radiance_, std::span<const PathRadiance>(std::vector<PathRadiance>(rays.size())));
}

PathRadiance PathBuffers::takeRadiance()
{
    const PathRadiance taken = download<PathRadiance>(radiance_, 1)[0];
    upload(radiance_, std::span<const PathRadiance>(std::vector<PathRadiance>(1)));
    return taken;
}

PathNote PathBuffers::takeNote()
{
    const PathNote taken = download<PathNote>(note_, 1)[0];
    PathNote empty{};
    empty.misWeightOfHit = 1.0F;
    empty.light = kNoLightIndex;
    upload(note_, std::span<const PathNote>(&empty, 1));
    return taken;
}

Tile::Tile(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths, std::uint32_t begin,
           std::uint32_t count, const RenderSettings& settings)
    : device_(device),
      begin_(begin),
      count_(count),
      chooses_(settings.adaptive != Adaptive::Off),
      catches_(settings.catcher),
      groups_(settings.groupCount()),
      blocks_(makeArray<BlockSums>(device, "film's blocks", count)),
      pages_(makeArray<PixelMoments>(device, "film's pages", count)),
      luminance_(makeArray<LuminanceMoments>(device, "pixels' luminances", isCourse(settings.adaptive) ? count : 1)),
      brightest_(makeArray<BrightestSample>(device, "pixels' brightest samples", settings.suspects > 0 ? count : 1)),
      catchers_(makeArray<CatcherSums>(device, "shadow catchers", settings.catcher ? count : 1)),
      groupSums_(makeArray<vec3>(device, "film by light groups", std::max(1U, count * sumsOfGroups(groups_)))),
      chosen_(device, "chosen pixels", BufferKind::Storage, sizeof(uint) + (chooses_ ? count : 1) * sizeof(ChosenPixel))
{
    const auto fixed = merged(constants, {{kBindBlocks, &blocks_},
                                          {kBindPages, &pages_},
                                          {kBindLuminance, &luminance_},
                                          {kBindBrightest, &brightest_},
                                          {kBindCatchers, &catchers_},
                                          {kBindGroupSums, &groupSums_},
                                          {kBindChosenPixels, &chosen_}});
    even_.emplace(layout, merged(fixed, paths.buffers(0)));
    odd_.emplace(layout, merged(fixed, paths.buffers(1)));
    clear();
}

void Tile::clear()
{
    fillWithZero({&blocks_, &pages_, &luminance_, &brightest_, &catchers_, &groupSums_});
    chooseAll();
}

void Tile::copySamples(const Tile& other, std::uint32_t first)
{
    Commands commands(device_);
    commands.copy(other.blocks_.handle(), first * sizeof(BlockSums), blocks_.handle(), count_ * sizeof(BlockSums));
    commands.copy(other.pages_.handle(), first * sizeof(PixelMoments), pages_.handle(), count_ * sizeof(PixelMoments));
    if (catches_) {
        commands.copy(other.catchers_.handle(), first * sizeof(CatcherSums), catchers_.handle(), count_ * sizeof(CatcherSums));
    }
    if (groups_ > 0) {
        const std::uint64_t bytes = sumsOfGroups(groups_) * sizeof(vec3);
        commands.copy(other.groupSums_.handle(), first * bytes, groupSums_.handle(), count_ * bytes);
    }
    commands.submitAndWait();
}

std::uint64_t Tile::bytesPerPixel(const RenderSettings& settings)
{
    return sizeof(BlockSums) + sizeof(PixelMoments) + (settings.suspects > 0 ? sizeof(BrightestSample) : 0) +
           (settings.catcher ? sizeof(CatcherSums) : 0) + sumsOfGroups(settings.groupCount()) * sizeof(vec3) +
           (settings.adaptive != Adaptive::Off ? sizeof(ChosenPixel) : 0) + (isCourse(settings.adaptive) ? sizeof(LuminanceMoments) : 0);
}

void Tile::fillWithZero(std::initializer_list<const Buffer*> buffers)
{
    Commands commands(device_);
    for (const Buffer* buffer : buffers) {
        commands.fillWithZero(*buffer);
    }
    commands.submitAndWait();
}

std::span<const PixelMoments> Tile::takePages(const HostBuffer& target)
{
    Commands commands(device_);
    commands.copy(pages_.handle(), 0, target.handle(), count_ * sizeof(PixelMoments));
    commands.fillWithZero(pages_);
    commands.submitAndWait();
    return {reinterpret_cast<const PixelMoments*>(target.mapped()), count_};
}

std::vector<CatcherMoments> Tile::readCatchers() const
{
    std::vector<CatcherMoments> pages;
    if (catches_) {
        for (const CatcherSums& sums : download<CatcherSums>(catchers_, count_)) {
            pages.push_back(sums.page);
        }
    }
    return pages;
}

std::vector<CatcherMoments> Tile::takeCatchers()
{
    std::vector<CatcherMoments> pages = readCatchers();
    if (catches_) {
        fillWithZero({&catchers_});
    }
    return pages;
}

void Tile::writeCatchers(std::span<const CatcherMoments> pages)
{
    std::vector<CatcherSums> sums(pages.size());
    std::ranges::transform(pages, sums.begin(), [](const CatcherMoments& page) { return CatcherSums{0.0F, vec3(0.0F), vec3(0.0F), page}; });
    upload(catchers_, std::span<const CatcherSums>(sums));
}

std::vector<glm::vec3> Tile::readGroups() const
{
    std::vector<glm::vec3> pages;
    if (groups_ > 0) {
        const std::size_t sums = sumsOfGroups(groups_);
        const std::vector<glm::vec3> all = download<glm::vec3>(groupSums_, count_ * sums);
        for (std::size_t at = 0; at < all.size(); at += sums) {
            pages.insert(pages.end(), all.begin() + static_cast<std::ptrdiff_t>(at + groups_),
                         all.begin() + static_cast<std::ptrdiff_t>(at + sums));
        }
    }
    return pages;
}

std::vector<glm::vec3> Tile::takeGroups()
{
    std::vector<glm::vec3> pages = readGroups();
    if (groups_ > 0) {
        fillWithZero({&groupSums_});
    }
    return pages;
}

void Tile::writeGroups(std::span<const glm::vec3> pages)
{
    const std::size_t moments = momentsOfGroups(groups_);
    std::vector<glm::vec3> all;
    for (std::size_t at = 0; at < pages.size(); at += moments) {
        all.insert(all.end(), groups_, glm::vec3(0.0F));
        const std::span<const glm::vec3> pixel = pages.subspan(at, moments);
        all.insert(all.end(), pixel.begin(), pixel.end());
    }
    upload(groupSums_, std::span<const glm::vec3>(all));
}

void Tile::chooseAll()
{
    if (chooses_) {
        std::vector<ChosenPixel> all(count_);
        for (std::uint32_t i = 0; i < count_; ++i) {
            all[i].pixel = i;
        }
        choose(all);
    }
}

void Tile::choose(const std::vector<ChosenPixel>& pixels)
{
    std::vector<uint> list(1 + 2 * pixels.size());
    list[0] = static_cast<uint>(pixels.size());
    static_assert(sizeof(ChosenPixel) == 2 * sizeof(uint));
    std::memcpy(list.data() + 1, pixels.data(), pixels.size() * sizeof(ChosenPixel));
    upload(chosen_, std::span<const uint>(list));
}

void Tile::chooseNone() { fillWithZero({&chosen_}); }

}  // namespace glim
