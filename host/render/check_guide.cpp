#include "host/render/check_guide.hpp"

#include "host/render/guide.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace glim {
namespace {

// Follows what access/guide.glsl follows.
class TreeChecker {
public:
    explicit TreeChecker(const std::vector<uvec4>& texels)
        : texels_(texels),
          isReached_(texels.size())
    {}

    bool check()
    {
        for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
            reach(root, nodes_);
        }
        checkQuadtree(kUniformQuadtree);
        if (guideScatterings(texels_)) {
            reach(kGuideOfScatterings, nodes_);
        }
        while (isSound_ && !nodes_.empty()) {
            checkNode(take(nodes_));
        }
        return isSound_;
    }

private:
    using Places = std::vector<std::uint64_t>;

    static std::uint64_t take(Places& places)
    {
        const std::uint64_t last = places.back();
        places.pop_back();
        return last;
    }

    bool reach(std::uint64_t texel)
    {
        isSound_ = isSound_ && texel < texels_.size() && !isReached_[texel];
        if (isSound_) {
            isReached_[texel] = true;
        }
        return isSound_;
    }

    void reach(std::uint64_t texel, Places& places)
    {
        if (reach(texel)) {
            places.push_back(texel);
        }
    }

    void checkNode(std::uint64_t texel)
    {
        const auto children = std::bit_cast<GuideNode>(texels_[texel]).children;
        for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
            const std::uint64_t at = std::uint64_t{kGuideBlockTexels} * (children >> 10U) + 2 * quarter;
            if ((children >> (6 + quarter) & 1U) == 0) {
                reach(at, nodes_);
            } else if (reach(at) && reach(at + 1)) {
                checkCell(at);
            }
        }
    }

    void checkCell(std::uint64_t texel)
    {
        const auto cell = std::bit_cast<GuideCell>(std::array{texels_[texel], texels_[texel + 1]});
        if (cell.quadtree != kUniformQuadtree) {
            checkQuadtree(cell.quadtree);
        }
    }

    void checkQuadtree(std::uint64_t root)
    {
        Places quads;
        reach(root, quads);
        while (isSound_ && !quads.empty()) {
            const auto children = std::bit_cast<GuideQuad>(texels_[take(quads)]).children;
            for (int child = 0; child < std::popcount(children & 0xffffU); ++child) {
                reach(root + (children >> 16U) + static_cast<std::uint32_t>(child), quads);
            }
        }
    }

    const std::vector<uvec4>& texels_;
    std::vector<bool> isReached_;
    Places nodes_;
    bool isSound_ = true;
};

}  // namespace

bool hasSoundTrees(const std::vector<uvec4>& texels) { return TreeChecker(texels).check(); }

}  // namespace glim
