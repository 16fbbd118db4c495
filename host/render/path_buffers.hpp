// The buffers by which kernels pass data of all paths in flight to each other, and the pixels to which these paths add.
#pragma once

#include "host/gpu/kernel.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/path_types.h"
#include "shaders/shared/pixel_moments.h"

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <vector>

namespace glim {

// Buffers by binding.
using BufferMap = std::map<std::uint32_t, const Buffer*>;

// The binding slots of all kernels of a pass (shaders/kernels).
std::vector<BindingSlot> kernelSlots();

// The rounds of all passes, of which only the first has paths, for `groups` workgroups.
std::vector<Round> makeRounds(std::uint32_t paths, std::uint32_t groups);
// Where the group counts of a round are, in bytes from the start of the rounds.
constexpr std::uint64_t groupsOfPaths(std::uint32_t round)
{
    return round * sizeof(Round) + offsetof(Round, paths) + offsetof(Queue, groups);
}
constexpr std::uint64_t groupsOfShadowRays(std::uint32_t round)
{
    return round * sizeof(Round) + offsetof(Round, shadowRays) + offsetof(Queue, groups);
}

// The most paths that a device's limits have room for.
std::uint32_t maxPathCapacity(const RenderSettings& settings, const DeviceDescription& device);
// The paths in flight: as many as are asked for, or else as suit the device's class and kPathPart of its memory, within its limits.
std::uint32_t choosePathCapacity(const RenderSettings& settings, const DeviceDescription& device);

class PathBuffers {
public:
    PathBuffers(Device& device, std::uint32_t capacity, std::uint32_t lightGroups = 0);
    static std::uint64_t sizeInBytes(std::uint32_t capacity, std::uint32_t lightGroups = 0);
    std::uint32_t capacity() const { return static_cast<std::uint32_t>(queueA_.size() / sizeof(uint)); }

    // `parity` 1 swaps the active and the next queue.
    BufferMap buffers(std::uint32_t parity) const;

    void setRounds(const std::vector<Round>& rounds) { upload(rounds_, std::span<const Round>(rounds)); }
    // Stores the rays in the first slots and makes these slots the active queue at parity 0, for `groups` workgroups of round 0.
    void queueRays(std::span<const PathRay> rays, std::uint32_t groups);
    // Stores the shadow rays in the first slots, each with a contribution of 1, and makes these slots the shadow queue. Clears their
    // radiance.
    void queueShadowRays(std::span<const ShadowRay> rays, std::uint32_t groups);
    // Of rays and of what went wrong.
    void clearCounters();
    // Return and reset the radiance of slot 0 and the note.
    PathRadiance takeRadiance();
    PathNote takeNote();

    const Buffer& rays() const { return rays_; }
    const Buffer& hits() const { return hits_; }
    const Buffer& states() const { return states_; }
    const Buffer& radiance() const { return radiance_; }
    const Buffer& shadowRays() const { return shadowRays_; }
    const Buffer& nextQueue(std::uint32_t parity) const { return parity == 0 ? queueB_ : queueA_; }
    const Buffer& shadowQueue() const { return shadowQueue_; }
    const Buffer& rounds() const { return rounds_; }
    std::vector<Round> readRounds() const { return download<Round>(rounds_, kRounds); }
    const Buffer& rayCounts() const { return rayCounts_; }
    const Buffer& status() const { return status_; }

private:
    Buffer rays_, hits_, states_, radiance_, firstHits_, shadowRays_, queueA_, queueB_, shadowQueue_;
    Buffer groupLight_;  // a word and RGB of each light group, for each path
    Buffer rounds_, rayCounts_, note_, status_;
};

// Pixels [begin, begin + count) of the picture. A storage buffer's limit (128 MiB where Vulkan allows the least) cuts large pictures into
// several tiles. The tile of an adaptive render knows which of its pixels are chosen for more samples: at first, all.
class Tile {
public:
    // `constants`: buffers of the scene and the parameters.
    Tile(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths, std::uint32_t begin,
         std::uint32_t count, const RenderSettings& settings);
    static std::uint64_t bytesPerPixel(const RenderSettings& settings);

    std::uint32_t begin() const { return begin_; }
    std::uint32_t count() const { return count_; }
    // An empty pass over it.
    Pass pass() const
    {
        Pass pass{};
        pass.tileBegin = begin_;
        return pass;
    }
    const Bindings& bindings(std::uint32_t parity) const { return parity == 0 ? *even_ : *odd_; }
    const Buffer& blocks() const { return blocks_; }
    const Buffer& pages() const { return pages_; }
    const Buffer& catchers() const { return catchers_; }
    // One per pixel if the render's settings ask for suspects.
    const Buffer& brightest() const { return brightest_; }

    // Moves the pages to `target`, and empties them.
    std::span<const PixelMoments> takePages(const HostBuffer& target);
    std::vector<PixelMoments> readPages() const { return download<PixelMoments>(pages_, count_); }
    void writePages(std::span<const PixelMoments> pages) { upload(pages_, pages); }
    // What the pages know of shadow catchers, between blocks; empty if the settings ask for none.
    std::vector<CatcherMoments> takeCatchers();
    std::vector<CatcherMoments> readCatchers() const;
    void writeCatchers(std::span<const CatcherMoments> pages);
    // The same of light groups (GroupMoments::values).
    std::vector<glm::vec3> takeGroups();
    std::vector<glm::vec3> readGroups() const;
    void writeGroups(std::span<const glm::vec3> pages);
    // Empties everything; all pixels are chosen.
    void clear();
    // Copies the samples of count() pixels of `other`, from its pixel `first` on.
    void copySamples(const Tile& other, std::uint32_t first);
    void chooseAll();
    void choose(const std::vector<ChosenPixel>& pixels);
    void chooseNone();
    // How many course_choose_pixels has put into the list.
    std::uint32_t readChosenCount() const { return download<uint>(chosen_, 1)[0]; }

private:
    void fillWithZero(std::initializer_list<const Buffer*> buffers);

    Device& device_;
    std::uint32_t begin_, count_;
    bool chooses_, catches_;
    std::uint32_t groups_;
    Buffer blocks_, pages_;
    Buffer luminance_;  // LuminanceMoments
    Buffer brightest_;  // BrightestSample
    Buffer catchers_;   // CatcherSums
    Buffer groupSums_;  // sumsOfGroups() of each pixel
    Buffer chosen_;     // the number of chosen pixels, then each ChosenPixel
    std::optional<Bindings> even_, odd_;
};

}  // namespace glim
