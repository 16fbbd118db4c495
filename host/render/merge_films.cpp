#include "host/render/merge_films.hpp"

#include "host/error.hpp"
#include "host/render/film_file.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace fs = std::filesystem;

namespace glim {
namespace {

using SampleRange = std::pair<std::uint32_t, std::uint32_t>;

std::string quoted(const std::string& text) { return '"' + text + '"'; }

// The first "key=value" in which the settings differ.
std::pair<std::string, std::string> firstDifference(const std::string& a, const std::string& b)
{
    std::istringstream wordsOfA(a), wordsOfB(b);
    std::string wordOfA, wordOfB;
    do {
        wordOfA.clear();
        wordOfB.clear();
        wordsOfA >> wordOfA;
        wordsOfB >> wordOfB;
    } while (wordOfA == wordOfB && wordsOfA && wordsOfB);
    return {wordOfA, wordOfB};
}

void checkSamePicture(const Film& film, const std::string& name, const Film& first, const std::string& firstName)
{
    if (const std::string difference = describeDifference(film, first); !difference.empty()) {
        throw InputError(name + ": cannot be merged with " + firstName + ": " + difference + ".");
    }
}

void checkDisjoint(const std::vector<Film>& films, const std::vector<std::string>& names)
{
    std::vector<std::pair<SampleRange, std::size_t>> ranges;
    for (std::size_t i = 0; i < films.size(); ++i) {
        for (const SampleRange& range : films[i].sampleRanges) {
            ranges.emplace_back(range, i);
        }
    }
    std::sort(ranges.begin(), ranges.end());
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        const auto& [before, first] = ranges[i - 1];
        const auto& [range, second] = ranges[i];
        if (range.first < before.second) {
            throw InputError(names[second] + ": cannot be merged with " + names[first] + ": both hold samples " +
                             std::to_string(range.first) + ":" + std::to_string(std::min(range.second, before.second)) +
                             ", expected disjoint ranges.");
        }
    }
}

std::uint32_t firstSample(const Film& film) { return film.sampleRanges.empty() ? 0 : film.sampleRanges.front().first; }

void addRanges(Film& film, const Film& next, bool joined)
{
    auto& ranges = film.sampleRanges;
    if (joined) {
        ranges.back().second = next.sampleRanges.front().second;
        return;
    }
    ranges.insert(ranges.end(), next.sampleRanges.begin(), next.sampleRanges.end());
    std::sort(ranges.begin(), ranges.end());
}

void foldHeader(Film& film, const Film& next)
{
    addRanges(film, next, continuesExactly(film, next));
    film.complete = film.complete && next.complete;
    film.seconds += next.seconds;
    if (film.device.find(next.device) == std::string::npos) {
        film.device += "; " + next.device;
    }
    addArithmetic(film, next.arithmetic);
    if (film.identity.kernels != next.identity.kernels) {
        film.identity.kernels = "several";
    }
}

// The settings without those that only choose which samples are taken.
std::string samplesOf(const std::string& settings)
{
    std::istringstream words(settings);
    std::string kept;
    for (std::string word; words >> word;) {
        const std::string name = word.substr(0, word.find('='));
        if (name != "adaptive" && name != "tolerance" && name != "batch" && name != "max-spp") {
            kept += word + " ";
        }
    }
    return kept;
}

}  // namespace

bool shareSamples(const Film& a, const Film& b)
{
    const bool samePicture = a.identity.scene == b.identity.scene && a.identity.seed == b.identity.seed &&
                             samplesOf(a.identity.settings) == samplesOf(b.identity.settings);
    return samePicture && std::any_of(a.sampleRanges.begin(), a.sampleRanges.end(), [&](const SampleRange& mine) {
               return std::any_of(b.sampleRanges.begin(), b.sampleRanges.end(),
                                  [&](const SampleRange& other) { return mine.first < other.second && other.first < mine.second; });
           });
}

bool continuesExactly(const Film& film, const Film& next)
{
    if (!film.complete || !next.complete || film.sampleRanges.size() != 1 || next.sampleRanges.size() != 1) {
        return false;
    }
    const auto [begin, end] = next.sampleRanges.front();
    const bool alike = film.identity.kernels == next.identity.kernels && film.arithmetic == next.arithmetic && isOfOneArithmetic(film);
    return alike && begin == film.sampleRanges.front().second && begin % kPageSamples == 0 && end - begin <= kPageSamples;
}

std::string describeDifference(const Film& film, const Film& first)
{
    const auto sizeOf = [](const Film& of) { return std::to_string(of.width) + "x" + std::to_string(of.height); };
    const auto describe = [](const std::string& what, const std::string& value, const std::string& expected) {
        return "its " + what + " is " + value + ", expected " + expected;
    };
    if (sizeOf(film) != sizeOf(first)) {
        return describe("size", sizeOf(film), sizeOf(first));
    }
    if (film.identity.scene != first.identity.scene) {
        return describe("scene, camera or environment", quoted(film.identity.scene) + " (" + film.sceneFile + ")",
                        quoted(first.identity.scene) + " (" + first.sceneFile + ")");
    }
    if (film.identity.seed != first.identity.seed) {
        return describe("seed", std::to_string(film.identity.seed), std::to_string(first.identity.seed));
    }
    if (film.identity.settings != first.identity.settings) {
        const auto [value, expected] = firstDifference(film.identity.settings, first.identity.settings);
        return describe("setting", quoted(value), quoted(expected));
    }
    return {};
}

MergePlan planMerge(const std::vector<Film>& films, const std::vector<std::string>& names)
{
    MergePlan plan;
    plan.order.resize(films.size());
    std::iota(plan.order.begin(), plan.order.end(), std::size_t{0});
    for (std::size_t i = 1; i < films.size(); ++i) {
        checkSamePicture(films[i], names[i], films[0], names[0]);
    }
    checkDisjoint(films, names);
    std::stable_sort(plan.order.begin(), plan.order.end(),
                     [&](std::size_t a, std::size_t b) { return firstSample(films[a]) < firstSample(films[b]); });
    Film merged = films.at(plan.order[0]);
    plan.exact = merged.complete && merged.sampleRanges.size() == 1 && isOfOneArithmetic(merged);
    for (std::size_t i = 1; i < films.size(); ++i) {
        const Film& next = films[plan.order[i]];
        plan.exact = plan.exact && continuesExactly(merged, next);
        foldHeader(merged, next);
    }
    return plan;
}

void foldFilm(Film& film, const Film& next)
{
    foldPage(film, 0, next.pixels);
    foldSplats(film.splats, next.splats);
    foldHeader(film, next);
}

MergedFilm mergeFilms(const std::vector<fs::path>& files)
{
    std::vector<Film> headers;
    std::vector<std::string> names;
    for (const fs::path& file : files) {
        headers.push_back(readFilmHeader(file));
        names.push_back(file.string());
    }
    const MergePlan plan = planMerge(headers, names);
    MergedFilm merged{readFilm(files[plan.order[0]]), plan.exact};
    for (std::size_t i = 1; i < files.size(); ++i) {
        foldFilm(merged.film, readFilm(files[plan.order[i]]));
    }
    return merged;
}

}  // namespace glim
