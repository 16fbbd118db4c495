#include "host/render/guide_map.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr std::uint32_t kProbeGroup = 64;
constexpr int kPerSide = 8;  // directions of a cell: a guide's leaf may be smaller. With 4 the integral of a ball's light was off by 12 %.
constexpr int kFineColumns = kPerSide * GuideMap::kColumns, kFineRows = kPerSide * GuideMap::kRows;

// Row by row.
std::vector<vec3> directionsOfMap(const FlatCamera& camera)
{
    const glm::dvec3 right = glm::normalize(glm::dvec3(camera.right)), up = glm::normalize(glm::dvec3(camera.up));
    std::vector<glm::dvec3> level;
    for (int column = 0; column < kFineColumns; ++column) {
        const double longitude = 2.0 * std::numbers::pi * ((column + 0.5) / kFineColumns - 0.5);
        level.push_back(std::sin(longitude) * right + std::cos(longitude) * glm::dvec3(camera.forward));
    }
    std::vector<vec3> directions;
    directions.reserve(std::size_t{kFineColumns} * kFineRows);
    for (int row = 0; row < kFineRows; ++row) {
        const double latitude = std::numbers::pi * (0.5 - (row + 0.5) / kFineRows);
        for (const glm::dvec3& w : level) {
            directions.emplace_back(std::cos(latitude) * w + std::sin(latitude) * up);
        }
    }
    return directions;
}

}  // namespace

float GuideMap::highestDensity() const { return std::ranges::max_element(cells, {}, &Cell::density)->density; }

GuideProbe::GuideProbe(Device& device)
    : device_(device),
      layout_(device, {{kBindGuide, BufferKind::Texel}, {kBindProbed, BufferKind::Storage}}, sizeof(GuideProbePass)),
      kernel_(layout_, kernels::probe_guide, {{kSpecWorkgroup, kProbeGroup}})
{}

std::vector<ProbedDirection> GuideProbe::ask(const Buffer& guide, const vec3& point, const vec3& normal,
                                             std::span<const vec3> directions) const
{
    std::vector<ProbedDirection> asked;
    asked.reserve(directions.size());
    for (const vec3& w : directions) {
        asked.push_back({w, 0.0F, 0.0F});
    }
    Buffer probed(device_, "probed directions", BufferKind::Storage, asked.size() * sizeof(ProbedDirection));
    upload(probed, std::span<const ProbedDirection>(asked));
    const GuideProbePass pass{point, normal, static_cast<std::uint32_t>(asked.size())};
    const Bindings bindings(layout_, {{kBindGuide, &guide}, {kBindProbed, &probed}});
    Commands commands(device_);
    commands.dispatch(kernel_, bindings, std::as_bytes(std::span<const GuideProbePass, 1>(&pass, 1)),
                      (pass.directions + kProbeGroup - 1) / kProbeGroup);
    commands.submitAndWait();
    return download<ProbedDirection>(probed, asked.size());
}

GuideMap GuideProbe::map(const Buffer& guide, const vec3& point, const vec3& normal, const FlatCamera& camera) const
{
    const std::vector<ProbedDirection> answers = ask(guide, point, normal, directionsOfMap(camera));
    GuideMap map;
    map.share = answers.front().share;
    map.cells.resize(std::size_t{GuideMap::kColumns} * GuideMap::kRows);
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const std::size_t row = i / kFineColumns / kPerSide, column = i % kFineColumns / kPerSide;
        GuideMap::Cell& cell = map.cells[row * GuideMap::kColumns + column];
        cell.density += answers[i].pdf * 4.0F * std::numbers::pi_v<float> / float{kPerSide * kPerSide};
        cell.isBelow = cell.isBelow || glm::dot(answers[i].w, normal) < 0.0F;
    }
    return map;
}

}  // namespace glim
