#include "host/render/regroup.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/error.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <span>
#include <thread>

namespace glim {
namespace {

struct Weighted {
    glm::vec3 mean, squares;
};

Weighted weigh(std::span<const glm::vec3> moments, const std::vector<glm::vec3>& factors)
{
    glm::dvec3 mean(0.0), squares(0.0);
    std::size_t pair = factors.size();
    for (std::size_t g = 0; g < factors.size(); ++g) {
        mean += glm::dvec3(factors[g]) * glm::dvec3(moments[g]);
        for (std::size_t other = g; other < factors.size(); ++other, ++pair) {
            const double times = g == other ? 1.0 : 2.0;
            squares += times * glm::dvec3(factors[g]) * glm::dvec3(factors[other]) * glm::dvec3(moments[pair]);
        }
    }
    return {glm::vec3(mean), glm::vec3(glm::max(squares, 0.0))};
}

template <class Visit>
void forEachPixel(std::size_t count, const Visit& visit)
{
    constexpr std::size_t kPart = 1U << 13U;  // large enough to be worth a thread
    parallelFor((count + kPart - 1) / kPart, std::thread::hardware_concurrency(), [&](std::size_t part) {
        for (std::size_t i = part * kPart; i < std::min(count, (part + 1) * kPart); ++i) {
            visit(i);
        }
    });
}

float mostOf(const std::vector<glm::vec3>& factors)
{
    float most = 0.0F;
    for (const glm::vec3& factor : factors) {
        most = std::max({most, factor.r, factor.g, factor.b});
    }
    return most;
}

std::string factorText(const glm::vec3& factor)
{
    const bool isGrey = factor.r == factor.g && factor.g == factor.b;
    return exactText(factor.r) + (isGrey ? "" : ":" + exactText(factor.g) + ":" + exactText(factor.b));
}

}  // namespace

std::vector<glm::vec3> factorsOf(const std::filesystem::path& name, const Film& film, const std::vector<LightWeight>& weights)
{
    const std::vector<std::string> groups = getLightGroups(film);
    std::vector<glm::vec3> factors(groups.size(), glm::vec3(1.0F));
    std::string known;
    for (const std::string& group : groups) {
        known += (known.empty() ? "" : ", ") + inQuotes(group);
    }
    for (const LightWeight& weight : weights) {
        const auto found = std::ranges::find(groups, weight.group);
        if (found == groups.end()) {
            throw InputError(
                MessageId::UnknownName,
                {part::file(name), ": has no light group ", part::quoted(weight.group), "; expected ",
                 groups.empty() ? part::expected("a film that was rendered with --light-group") : part::expected("one of " + known), "."});
        }
        factors[static_cast<std::size_t>(found - groups.begin())] = weight.factor;
    }
    return factors;
}

Film regroup(const Film& film, const std::vector<glm::vec3>& factors)
{
    Film weighed;
    static_cast<FilmHeader&>(weighed) = film;
    weighed.pixels = film.pixels;
    weighed.splats = film.splats;
    const float most = mostOf(factors);
    const auto apply = [&](auto& pixels, const GroupMoments& groups) {
        forEachPixel(groups.pixelCount(), [&](std::size_t i) {
            const Weighted light = weigh(groups.of(i), factors);
            pixels[i].mean = light.mean;
            pixels[i].squares = light.squares;
            pixels[i].clamped *= most;
        });
    };
    apply(weighed.pixels, film.groups);
    apply(weighed.splats, film.splatGroups);
    const std::vector<std::string> names = getLightGroups(film);
    std::string text;
    for (std::size_t g = 0; g < names.size(); ++g) {
        text += (g == 0 ? "" : ",") + names[g] + ":" + factorText(factors[g]);
    }
    std::string& settings = weighed.identity.settings;
    const std::string before = " light-groups=";
    const std::size_t begin = settings.find(before), end = settings.find(' ', begin + 1);
    settings.replace(begin, std::min(end, settings.size()) - begin, " lights=" + text);
    return weighed;
}

}  // namespace glim
