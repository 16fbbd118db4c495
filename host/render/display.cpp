#include "host/render/display.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 256;

std::vector<BindingSlot> slots()
{
    std::vector<BindingSlot> slots;
    for (const std::uint32_t binding : {kBindBlocks, kBindPages, kBindCatchers, kBindFolded, kBindFoldedCatchers}) {
        slots.push_back({binding, BufferKind::Storage});
    }
    return slots;
}

}  // namespace

Display::Display(Device& device)
    : device_(device),
      layout_(device, slots(), sizeof(DisplayPass), {kBindPicture})
{}

void Display::resize(const glm::uvec2& window, const glm::uvec2& low, const glm::uvec2& high)
{
    low_ = low;
    size_ = high - low;
    picture_.emplace(device_, "window's picture", window.x, window.y);
}

const Kernel& Display::getKernel(const Shader& shader)
{
    const auto found = kernels_.find(shader);
    if (found != kernels_.end()) {
        return found->second;
    }
    Specialization constants = makeConstants(shader.composites ? kFeatureCatcher : 0);
    constants.insert({{kSpecWorkgroup, kWorkgroup}, {kSpecAov, static_cast<std::uint32_t>(shader.aov)}, {kSpecFolded, shader.folded}});
    return kernels_.emplace(shader, Kernel(layout_, shader.means ? kernels::preview_means : kernels::preview, constants)).first->second;
}

void Display::run(const Kernel& kernel, const Bindings& bindings, const DisplayPass& pass, std::uint64_t threads)
{
    const std::uint64_t groups = (threads + kWorkgroup - 1) / kWorkgroup;
    Commands commands(device_);
    commands.dispatch(kernel, bindings, std::as_bytes(std::span<const DisplayPass, 1>(&pass, 1)),
                      static_cast<std::uint32_t>(std::min<std::uint64_t>(groups, device_.description().maxGroups)));
    commands.submitAndWait();
}

// Uploads again the pages that the renderer has folded on the host.
void Display::takeFolded(const Renderer& renderer)
{
    if (renderer.films().foldVersion() == 0 || renderer.films().foldVersion() == foldVersion_) {
        return;
    }
    foldVersion_ = renderer.films().foldVersion();
    folded_.clear();
    const FilmMoments& film = renderer.films().folded();
    for (const auto& tile : renderer.films().tiles()) {
        const auto take = [&](const char* name, const auto& moments) {
            const std::span part = std::span(moments).subspan(tile->begin(), tile->count());
            Buffer buffer(device_, name, BufferKind::Storage, part.size_bytes());
            upload(buffer, part);
            return buffer;
        };
        folded_.push_back({take("film's folded pages", film.pixels), std::nullopt});
        if (!film.catcher.empty()) {
            folded_.back().catchers.emplace(take("folded shadow catchers", film.catcher));
        }
    }
}

bool Display::draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look, std::uint32_t drawn,
                   const std::function<bool()>& shouldContinue)
{
    takeFolded(renderer);
    DisplayPass pass{};
    pass.left = low_.x;
    pass.top = low_.y;
    pass.width = size_.x;
    pass.height = size_.y;
    pass.filmWidth = renderer.settings().width;
    pass.filmHeight = renderer.settings().height;
    pass.scale = static_cast<float>(std::exp2(look.exposure));
    pass.tone = static_cast<std::uint32_t>(look.tone);
    pass.low = range.low;
    pass.high = range.high;
    pass.drawn = drawn;
    const bool anyFolded = renderer.films().foldVersion() != 0;
    const bool composites = aov == Aov::Radiance && drawn != kDrawnInGrey && renderer.settings().catcher;
    const bool means = pass.filmWidth > size_.x || pass.filmHeight > size_.y;
    for (std::size_t i = 0; i < renderer.films().tiles().size(); ++i) {
        if (means && !shouldContinue()) {
            return false;
        }
        const Tile& tile = *renderer.films().tiles()[i];
        // Where there is nothing, a placeholder that the kernel does not read.
        const Buffer& folded = anyFolded ? folded_[i].pixels : tile.pages();
        const Buffer& foldedCatchers = anyFolded && composites ? *folded_[i].catchers : tile.catchers();
        const Bindings bindings(layout_,
                                {{kBindBlocks, &tile.blocks()},
                                 {kBindPages, &tile.pages()},
                                 {kBindCatchers, &tile.catchers()},
                                 {kBindFolded, &folded},
                                 {kBindFoldedCatchers, &foldedCatchers}},
                                {{kBindPicture, &*picture_}});
        pass.tileBegin = tile.begin();
        pass.tileCount = tile.count();
        const std::uint64_t covered = std::uint64_t{pass.width} * pass.height;
        run(getKernel({aov, anyFolded, composites, means}), bindings, pass, means ? covered : tile.count());
    }
    return true;
}

}  // namespace glim
