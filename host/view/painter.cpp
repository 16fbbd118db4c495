#include "host/view/painter.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kWorkgroup = 256;

}  // namespace

Painter::Painter(Device& device)
    : device_(device),
      layout_(device, {{kBindViewed, BufferKind::Storage}, {kBindReference, BufferKind::Storage}}, sizeof(ViewPass), {kBindPicture}),
      kernel_(layout_, kernels::view, {{kSpecWorkgroup, kWorkgroup}})
{}

void Painter::resize(const glm::uvec2& size)
{
    const std::uint64_t bytes = std::uint64_t{size.x} * size.y * sizeof(glm::vec3);
    picture_.emplace(device_, "window's picture", size.x, size.y);
    values_.emplace(device_, "values under the window", BufferKind::Storage, bytes);
    reference_.emplace(device_, "reference under the window", BufferKind::Storage, bytes);
}

void Painter::draw(ViewPass pass)
{
    pass.width = picture_->width();
    pass.height = picture_->height();
    const Bindings bindings(layout_, {{kBindViewed, &*values_}, {kBindReference, &*reference_}}, {{kBindPicture, &*picture_}});
    const std::uint32_t groups = (pass.width * pass.height + kWorkgroup - 1) / kWorkgroup;
    Commands commands(device_);
    commands.dispatch(kernel_, bindings, std::as_bytes(std::span<const ViewPass, 1>(&pass, 1)),
                      std::min(groups, device_.description().maxGroups));
    commands.submitAndWait();
}

}  // namespace glim
