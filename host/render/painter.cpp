#include "host/render/painter.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>

namespace glim {
namespace {

constexpr std::uint32_t kPaintGroup = 256;
constexpr std::uint32_t kPaintedPixels = 1U << 20;  // about 25 ms on a software device with two cores

}  // namespace

Painter::Painter(Device& device)
    : device_(device),
      layout_(device, {{kBindViewed, BufferKind::Storage}, {kBindReference, BufferKind::Storage}}, sizeof(ViewPass), {kBindPicture}),
      kernel_(layout_, kernels::view, {{kSpecWorkgroup, kPaintGroup}})
{}

void Painter::resize(const glm::uvec2& size)
{
    picture_.emplace(device_, "window's picture", size.x, size.y);
    bands_.clear();
    const std::uint32_t most = std::max(1U, kPaintedPixels / size.x);
    for (std::uint32_t row = 0; row < size.y; row += most) {
        const std::uint32_t rows = std::min(most, size.y - row);
        const std::uint64_t bytes = std::uint64_t{size.x} * rows * sizeof(glm::vec3);
        bands_.push_back({row, rows, Buffer(device_, "values under the window", BufferKind::Storage, bytes),
                          Buffer(device_, "reference under the window", BufferKind::Storage, bytes)});
    }
}

std::span<const glm::vec3> Painter::partOf(std::span<const glm::vec3> values, const Band& band) const
{
    const std::size_t width = picture_->width();
    return values.subspan(band.firstRow * width, band.rows * width);
}

void Painter::setValues(std::span<const glm::vec3> values)
{
    for (Band& band : bands_) {
        upload(band.values, partOf(values, band));
    }
}

void Painter::setReference(std::span<const glm::vec3> values)
{
    for (Band& band : bands_) {
        upload(band.reference, partOf(values, band));
    }
}

void Painter::draw(ViewPass pass)
{
    pass.width = picture_->width();
    for (const Band& band : bands_) {
        pass.firstRow = band.firstRow;
        pass.rows = band.rows;
        const Bindings bindings(layout_, {{kBindViewed, &band.values}, {kBindReference, &band.reference}}, {{kBindPicture, &*picture_}});
        const std::uint32_t groups = (pass.width * pass.rows + kPaintGroup - 1) / kPaintGroup;
        Commands commands(device_);
        commands.dispatch(kernel_, bindings, std::as_bytes(std::span<const ViewPass, 1>(&pass, 1)),
                          std::min(groups, device_.description().maxGroups));
        commands.submitAndWait();
    }
}

}  // namespace glim
