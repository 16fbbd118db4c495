#include "host/render/seen_instances.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace glim {
namespace {

// The pixels of an instance.
struct Region {
    std::uint32_t pixels = 0;
    glm::uvec2 low{std::numeric_limits<std::uint32_t>::max()}, end{0};

    void add(const glm::uvec2& pixel)
    {
        ++pixels;
        low = glm::min(low, pixel);
        end = glm::max(end, pixel + 1U);
    }
    Json box() const { return pixels == 0 ? Json() : Json::array({low.x, low.y, end.x - low.x, end.y - low.y}); }
};

struct Seen {
    Region visible, full;
};

// COCO's run lengths of a mask: down the columns, from the left; the first run is of pixels that are not in it.
Json runLengths(const std::vector<std::uint32_t>& ids, const glm::uvec2& size, std::uint32_t id)
{
    std::vector<std::uint32_t> counts{0};
    bool isIn = false;
    for (std::uint32_t x = 0; x < size.x; ++x) {
        for (std::uint32_t y = 0; y < size.y; ++y) {
            if ((ids[std::size_t{y} * size.x + x] == id) != isIn) {
                isIn = !isIn;
                counts.push_back(0);
            }
            ++counts.back();
        }
    }
    return Json{{"size", Json::array({size.y, size.x})}, {"counts", counts}};
}

using Categories = std::map<std::pair<std::uint32_t, std::string>, std::uint32_t>;

// The number of each mesh's category, from 1 on; spheres share one.
Categories numberCategories(const SceneInstances& instances)
{
    Categories numbers;
    for (const SceneInstance& instance : instances.all()) {
        numbers.try_emplace({instance.mesh, instance.kind});
    }
    std::uint32_t number = 0;
    for (auto& [mesh, its] : numbers) {
        its = ++number;
    }
    return numbers;
}

Json orNull(std::uint32_t index) { return index == kNoIndex ? Json() : Json(index); }

}  // namespace

Json describeSeenInstances(SurfaceTracer& tracer, const SceneInstances& instances, const glm::uvec2& size, const std::string& fileName)
{
    const std::uint32_t pixelCount = size.x * size.y;
    std::vector<Seen> seen(instances.all().size());
    std::vector<std::uint32_t> ids(pixelCount, kNoIndex), chosen;
    for (std::uint32_t begin = 0; begin < pixelCount; begin += static_cast<std::uint32_t>(chosen.size())) {
        chosen.resize(std::min(pixelCount - begin, tracer.rayCount()));
        std::iota(chosen.begin(), chosen.end(), begin);
        const auto met = tracer.meetAll(chosen);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const glm::uvec2 pixel(chosen[i] % size.x, chosen[i] / size.x);
            for (const std::uint32_t instance : met[i].all) {
                seen[instance].full.add(pixel);
            }
            if (!met[i].all.empty()) {
                ids[chosen[i]] = met[i].first;
                seen[met[i].first].visible.add(pixel);
            }
        }
    }
    const Categories categories = numberCategories(instances);
    Json all = Json::array(), annotations = Json::array(), kinds = Json::array();
    for (std::uint32_t id = 0; id < seen.size(); ++id) {
        const SceneInstance& instance = instances.all()[id];
        const auto& [visible, full] = seen[id];
        const std::uint32_t category = categories.at({instance.mesh, instance.kind});
        const Json share = full.pixels == 0 ? Json() : Json(static_cast<double>(visible.pixels) / full.pixels);
        all.append(Json{{"id", id},
                        {"name", instance.name},
                        {"node", orNull(instance.node)},
                        {"mesh", orNull(instance.mesh)},
                        {"category_id", category},
                        {"pixels", visible.pixels},
                        {"bbox", visible.box()},
                        {"full_pixels", full.pixels},
                        {"full_bbox", full.box()},
                        {"visible", share}});
        if (visible.pixels > 0) {
            annotations.append(Json{{"id", id + 1},
                                    {"image_id", 1},
                                    {"category_id", category},
                                    {"bbox", visible.box()},
                                    {"area", visible.pixels},
                                    {"iscrowd", 0},
                                    {"segmentation", runLengths(ids, size, id)}});
        }
    }
    for (const auto& [mesh, number] : categories) {
        kinds.append(Json{{"id", number}, {"name", mesh.second}});
    }
    return Json{{"images", Json::array({Json{{"id", 1}, {"width", size.x}, {"height", size.y}, {"file_name", fileName}}})},
                {"categories", kinds},
                {"annotations", annotations},
                {"instances", all}};
}

}  // namespace glim
