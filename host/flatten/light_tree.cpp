#include "host/flatten/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr std::uint32_t kBins = 16;
// How many lights a cluster has. With fewer, the way down is as short.
constexpr std::uint32_t kMinClusterLights = 100, kMaxClusterLights = 1U << 14;
// Squared radii of its lights over its own, at least. A ball of small triangles has 4.5, an eighth of it 2. Lamps that are apart have less:
// they are seldom small together.
constexpr float kClusterDensity = 2.0F;
// Its radius over that of the scene, at most. To many points a larger one is not small, and lanes of both kinds cost more than one.
constexpr float kMaxClusterSize = 0.04F;
constexpr float kClusterPower = (1U << 24) - 2 * kMaxClusterLights;  // on each side, at most
// Of a light's power it counts this much on every side: the point does not see all lights of a cluster from the same direction.
constexpr float kClusterFloor = 0.03125F;
constexpr float kShareEverywhere = 0.6667F;     // of a light without a normal: the inverse of the mean sum of a direction's components
constexpr std::uint32_t kMaxUnevenLevels = 32;  // below these, halves have equal numbers of lights: no tree is deeper than 64

struct Item {
    LightBounds bounds;
    std::uint32_t light;
};

vec3 centerOf(const LightBounds& bounds) { return 0.5F * (bounds.low + bounds.high); }

// What some lights have in common. `axes` is the sum of their axes, turned to one side if all are two-sided.
struct Cluster {
    vec3 low{INFINITY}, high{-INFINITY};
    vec3 axes{0.0F};
    float power = 0.0F;
    float cosEmission = 1.0F;
    bool twoSided = true;
    std::uint32_t count = 0;

    void add(const LightBounds& light, const vec3& front)
    {
        low = glm::min(low, light.low);
        high = glm::max(high, light.high);
        axes += light.twoSided && glm::dot(light.axis, front) < 0.0F ? -light.axis : light.axis;
        power += light.power;
        cosEmission = std::min(cosEmission, light.cosEmission);
        twoSided = twoSided && light.twoSided;
        ++count;
    }
    void add(const Cluster& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
        axes += other.axes;
        power += other.power;
        cosEmission = std::min(cosEmission, other.cosEmission);
        twoSided = twoSided && other.twoSided;
        count += other.count;
    }
};

// The measure of directions that a cluster shines in (section 4.3). Its cone of normals is that of a spherical cap with the same mean of
// unit vectors, (1 + cos) / 2: it needs no second pass, and one light that faces elsewhere does not open it.
float orientationCost(const Cluster& cluster)
{
    const float cosNormals = std::clamp(2.0F * glm::length(cluster.axes) / static_cast<float>(cluster.count) - 1.0F, -1.0F, 1.0F);
    const float normals = std::acos(cosNormals), sinNormals = std::sqrt((1.0F - cosNormals) * (1.0F + cosNormals));
    constexpr float kPi = std::numbers::pi_v<float>;
    const float emission = cluster.cosEmission == 0.0F ? 0.5F * kPi : std::acos(std::clamp(cluster.cosEmission, -1.0F, 1.0F));
    const float reach = std::min(normals + emission, kPi);
    return 2.0F * kPi * (1.0F - cosNormals) +
           0.5F * kPi * (2.0F * reach * sinNormals - std::cos(normals - 2.0F * reach) - 2.0F * normals * sinNormals + cosNormals);
}

// Power times directions times extent. The squared diagonal tells apart clusters along a line, whose boxes have no surface.
float computeCost(const Cluster& cluster)
{
    const vec3 d = cluster.high - cluster.low;
    const float surface = 2.0F * (d.x * d.y + d.y * d.z + d.z * d.x);
    return cluster.power * orientationCost(cluster) * (surface + 0.01F * glm::dot(d, d));
}

class Builder {
public:
    Builder(std::span<const LightBounds> lights, float sceneRadius)
        : maxClusterRadius_(kMaxClusterSize * sceneRadius)
    {
        items_.reserve(lights.size());
        for (const LightBounds& light : lights) {
            items_.push_back({light, static_cast<std::uint32_t>(items_.size())});
        }
    }

    LightTree build()
    {
        const auto count = static_cast<std::uint32_t>(items_.size());
        halves_.reserve(2 * std::size_t{count});
        halves_.emplace_back();
        split(0, 0, count, 0);
        LightTree tree;
        tree.nodes.reserve(2 * std::size_t{count});
        tree.nodes.push_back(halves_[0].node);
        if (count == 1) {
            tree.nodes.push_back(halves_[0].node);  // the root has a child in any case
            tree.nodes[0].children |= 1U | 1U << kLightChildBits;
        }
        collapse(tree.nodes, 0, 0);
        for (const Item& item : items_) {
            tree.order.push_back(item.light);
        }
        if (std::ranges::any_of(tree.nodes, [](const LightNode& node) { return (node.children & kClusterNode) != 0; })) {
            tree.powers.resize(2);
            addPowers(tree, 0, count);
        }
        return tree;
    }

private:
    // Of the lights below a node, up to `end`: the sums before the next light.
    void addPowers(LightTree& tree, std::uint32_t at, std::uint32_t end) const
    {
        const LightNode& node = tree.nodes[at];
        const std::uint32_t first = node.children & ((1U << kLightChildBits) - 1U);
        const std::uint32_t count = (node.children & ~(kTwoSidedNode | kClusterNode)) >> kLightChildBits;
        if ((node.children & kClusterNode) == 0) {
            for (std::uint32_t i = 0; i < count; ++i) {
                addPowers(tree, first + i, i + 1 < count ? tree.nodes[first + i + 1].firstLight : end);
            }
        }
        const bool isCluster = (node.children & kClusterNode) != 0;
        for (std::uint32_t i = node.firstLight; i < end && (isCluster || count == 0); ++i) {
            const LightBounds& light = items_[i].bounds;
            const float unit = isCluster ? kClusterPower * (light.power / node.power) / (1.0F + kClusterFloor) : 0.0F;
            const bool everywhere = light.axis == vec3(0.0F);
            const auto side = [&](float cosine) {
                const float share = everywhere ? kShareEverywhere : std::max(0.0F, cosine) + kClusterFloor;
                return isCluster ? 1U + static_cast<std::uint32_t>(unit * share) : 0U;
            };
            const auto sides = [&](const vec3& n) { return uvec4(side(n.x), side(n.y), side(n.z), 0); };
            const vec3 front = light.twoSided ? glm::abs(light.axis) : light.axis;
            const std::size_t before = tree.powers.size() - 2;
            tree.powers.push_back(tree.powers[before] + sides(front));
            tree.powers.push_back(tree.powers[before + 1] + sides(light.twoSided ? front : -front));
        }
    }

    // A node of the binary tree.
    struct Half {
        LightNode node;
        std::uint32_t child = 0;  // the first of two; 0: a leaf
        float cost = 0.0F;
    };

    LightNode leaf(std::uint32_t at) const
    {
        const LightBounds& b = items_[at].bounds;
        const bool everywhere = b.axis == vec3(0.0F);
        return {centerOf(b),
                b.radius,
                everywhere ? vec3(0, 0, 1) : b.axis,
                b.power,
                everywhere ? -1.0F : 1.0F,
                b.cosEmission,
                b.twoSided ? kTwoSidedNode : 0U,
                at};
    }

    // What a child of half `binary` costs; below 0 if it stays whole, as a node where the way down can end: a cluster that is not within
    // another.
    float costOfWhole(std::uint32_t child, std::uint32_t binary) const
    {
        const bool staysWhole = (halves_[child].node.children & ~halves_[binary].node.children & kClusterNode) != 0;
        return staysWhole ? -1.0F : halves_[child].cost;
    }

    // Gives node `wide` of `nodes` the children of half `binary`; those that cost most are replaced by their own while there is room.
    void collapse(std::vector<LightNode>& nodes, std::size_t wide, std::uint32_t binary)
    {
        if (halves_[binary].child == 0) {
            return;
        }
        std::vector<std::uint32_t> children{halves_[binary].child, halves_[binary].child + 1};
        while (children.size() < kMaxLightChildren) {
            const auto dearest = std::ranges::max_element(children, {}, [&](std::uint32_t i) { return costOfWhole(i, binary); });
            if (halves_[*dearest].child == 0 || costOfWhole(*dearest, binary) < 0.0F) {
                break;
            }
            const std::uint32_t child = halves_[*dearest].child;
            *dearest = child;
            children.insert(dearest + 1, child + 1);
        }
        const auto first = static_cast<std::uint32_t>(nodes.size());
        nodes[wide].children |= first | static_cast<std::uint32_t>(children.size()) << kLightChildBits;
        for (const std::uint32_t child : children) {
            nodes.push_back(halves_[child].node);
        }
        for (std::size_t i = 0; i < children.size(); ++i) {
            collapse(nodes, first + i, children[i]);
        }
    }

    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::uint32_t level)
    {
        if (end - begin == 1) {
            halves_[node].node = leaf(begin);
            return;
        }
        Cluster cluster;
        for (std::uint32_t i = begin; i < end; ++i) {
            cluster.add(items_[i].bounds, items_[begin].bounds.axis);
        }
        const std::uint32_t middle = partition(cluster, begin, end, level), child = static_cast<std::uint32_t>(halves_.size());
        halves_[node] = {inner(cluster, begin, end), child, computeCost(cluster)};
        halves_.resize(halves_.size() + 2);
        split(child, begin, middle, level + 1);
        split(child + 1, middle, end, level + 1);
    }

    LightNode inner(const Cluster& cluster, std::uint32_t begin, std::uint32_t end) const
    {
        const float length = glm::length(cluster.axes);
        const vec3 axis = length > 0.0F ? cluster.axes / length : vec3(0, 0, 1);
        float cosNormals = length > 0.0F ? 1.0F : -1.0F;
        bool isCluster = cluster.count >= kMinClusterLights && cluster.count <= kMaxClusterLights;
        float radii2 = 0.0F;
        for (std::uint32_t i = begin; i < end; ++i) {
            const LightBounds& light = items_[i].bounds;
            const float cosine = glm::dot(axis, light.axis);
            cosNormals = std::min(cosNormals, light.axis == vec3(0.0F) ? -1.0F : cluster.twoSided ? std::abs(cosine) : cosine);
            // A light that shines both ways among some that do not shines against the axis too.
            cosNormals = light.twoSided && !cluster.twoSided ? -1.0F : cosNormals;
            isCluster = isCluster && light.cosEmission == 0.0F;
            radii2 += light.radius * light.radius;
        }
        cosNormals = std::clamp(cosNormals - 1e-6F, -1.0F, 1.0F);  // the rounding of axis and dot
        const vec3 half = 0.5F * (cluster.high - cluster.low);
        const float radius = glm::length(half);
        isCluster = isCluster && radii2 >= kClusterDensity * radius * radius && radius <= maxClusterRadius_;
        return {cluster.low + half,
                radius,
                axis,
                cluster.power,
                cosNormals,
                cluster.cosEmission,
                (cluster.twoSided ? kTwoSidedNode : 0U) | (isCluster ? kClusterNode : 0U),
                begin};
    }

    // Orders the items so that those of the first child come first, and returns the first of the second child.
    std::uint32_t partition(const Cluster& cluster, std::uint32_t begin, std::uint32_t end, std::uint32_t level)
    {
        vec3 low(INFINITY), high(-INFINITY);
        for (std::uint32_t i = begin; i < end; ++i) {
            low = glm::min(low, centerOf(items_[i].bounds));
            high = glm::max(high, centerOf(items_[i].bounds));
        }
        const vec3 extent = high - low;
        const Split best = level < kMaxUnevenLevels && end - begin > 2 ? findSplit(low, extent, begin, end, cluster) : Split{};
        const auto first = items_.begin() + begin, last = items_.begin() + end;
        if (best.cost < INFINITY) {
            const auto middle = std::partition(first, last, [&](const Item& item) {
                return binOf(centerOf(item.bounds)[best.axis], low[best.axis], extent[best.axis], binsFor(end - begin)) < best.bin;
            });
            return static_cast<std::uint32_t>(middle - items_.begin());
        }
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto middle = first + (end - begin) / 2;
        std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
            return std::pair(centerOf(a.bounds)[axis], a.light) < std::pair(centerOf(b.bounds)[axis], b.light);
        });
        return begin + (end - begin) / 2;
    }

    struct Split {
        float cost = INFINITY;
        int axis = 0;
        std::uint32_t bin = 0;  // the first of the second child
    };

    static std::uint32_t binOf(float x, float low, float extent, std::uint32_t bins)
    {
        return std::min(static_cast<std::uint32_t>((x - low) / extent * static_cast<float>(bins)), bins - 1);
    }

    // As many bins as lights, kBins at most.
    static std::uint32_t binsFor(std::uint32_t lights) { return std::min(lights, kBins); }

    Split findSplit(const vec3& low, const vec3& extent, std::uint32_t begin, std::uint32_t end, const Cluster& cluster) const
    {
        const std::uint32_t count = binsFor(end - begin);
        const vec3 size = cluster.high - cluster.low;
        const float longest = std::max({size.x, size.y, size.z});
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(extent[axis] > 0.0F)) {
                continue;
            }
            std::array<Cluster, kBins> bins;
            for (std::uint32_t i = begin; i < end; ++i) {
                const LightBounds& light = items_[i].bounds;
                bins[binOf(centerOf(light)[axis], low[axis], extent[axis], count)].add(light, cluster.axes);
            }
            findSplit(std::span(bins).first(count), axis, longest / size[axis], best);
        }
        return best;
    }

    // `thinness`: cutting a long side is better than cutting a short one.
    static void findSplit(std::span<const Cluster> bins, int axis, float thinness, Split& best)
    {
        std::array<float, kBins> costOfRest{};
        Cluster rest;
        for (std::size_t bin = bins.size() - 1; bin > 0; --bin) {
            if (bins[bin].count > 0) {
                rest.add(bins[bin]);
                costOfRest[bin] = computeCost(rest);
            }
        }
        // A split before an empty bin is one before the next bin that is not.
        Cluster first;
        for (std::size_t bin = 1; bin < bins.size(); ++bin) {
            first.add(bins[bin - 1]);
            if (bins[bin].count == 0 || first.count == 0) {
                continue;
            }
            const float cost = thinness * (computeCost(first) + costOfRest[bin]);
            if (cost < best.cost) {
                best = {cost, axis, static_cast<std::uint32_t>(bin)};
            }
        }
    }

    float maxClusterRadius_;
    std::vector<Item> items_;
    std::vector<Half> halves_;
};

}  // namespace

LightTree buildLightTree(std::span<const LightBounds> lights, float sceneRadius) { return Builder(lights, sceneRadius).build(); }

}  // namespace glim
