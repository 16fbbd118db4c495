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

void Display::resize(std::uint32_t width, std::uint32_t height) { picture_.emplace(device_, "window's picture", width, height); }

const Kernel& Display::getPreview(Aov aov, bool folded, bool composites)
{
    const auto found = previews_.find({aov, folded, composites});
    if (found != previews_.end()) {
        return found->second;
    }
    Specialization constants = makeConstants(composites ? kFeatureCatcher : 0);
    constants.insert({{kSpecWorkgroup, kWorkgroup}, {kSpecAov, static_cast<std::uint32_t>(aov)}, {kSpecFolded, folded}});
    return previews_.emplace(std::tuple(aov, folded, composites), Kernel(layout_, kernels::preview, constants)).first->second;
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

void Display::draw(const Renderer& renderer, Aov aov, const DisplayRange& range, const Look& look, std::uint32_t drawn)
{
    takeFolded(renderer);
    DisplayPass pass{};
    pass.width = picture_->width();
    pass.height = picture_->height();
    pass.filmWidth = renderer.settings().width;
    pass.filmHeight = renderer.settings().height;
    pass.scale = static_cast<float>(std::exp2(look.exposure));
    pass.tone = static_cast<std::uint32_t>(look.tone);
    pass.low = range.low;
    pass.high = range.high;
    pass.drawn = drawn;
    const bool anyFolded = renderer.films().foldVersion() != 0, composites = aov == Aov::Radiance && renderer.settings().catcher;
    for (std::size_t i = 0; i < renderer.films().tiles().size(); ++i) {
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
        run(getPreview(aov, anyFolded, composites), bindings, pass, tile.count());
    }
}

}  // namespace glim
