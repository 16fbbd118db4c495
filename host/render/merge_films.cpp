#include "host/render/merge_films.hpp"

#include "host/error.hpp"
#include "host/render/film_file.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

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

bool haveSameRows(const Film& a, const Film& b) { return a.rowsAbove == b.rowsAbove && a.height == b.height; }

std::string rowsText(const Film& film)
{
    return std::to_string(film.rowsAbove) + ":" + std::to_string(std::uint64_t{film.rowsAbove} + film.height);
}

Message mismatch(const std::string& what, const std::string& value, const std::string& expected)
{
    return {MessageId::Mismatch, {"its ", part::place(what), " is ", part::value(value), ", expected ", part::expected(expected)}};
}

// As findDifference, but for the rows.
std::optional<Message> findOtherPicture(const Film& film, const Film& first)
{
    const auto sizeOf = [](const Film& of) {
        return std::to_string(of.width) + "x" + std::to_string(std::uint64_t{of.rowsAbove} + of.height + of.rowsBelow);
    };
    if (sizeOf(film) != sizeOf(first)) {
        return mismatch("size", sizeOf(film), sizeOf(first));
    }
    const auto groupsOf = [](const Film& of) {
        const std::string groups = findSetting(of.identity.settings, "light-groups");
        return groups.empty() ? "none" : groups;
    };
    if (groupsOf(film) != groupsOf(first)) {  // by which scenes differ too
        return mismatch("choice of light groups", groupsOf(film), groupsOf(first));
    }
    if (film.identity.scene != first.identity.scene) {
        return mismatch("scene, camera or environment", quoted(film.identity.scene) + " (" + film.sceneFile + ")",
                        quoted(first.identity.scene) + " (" + first.sceneFile + ")");
    }
    if (film.identity.seed != first.identity.seed) {
        return mismatch("seed", std::to_string(film.identity.seed), std::to_string(first.identity.seed));
    }
    if (film.identity.settings != first.identity.settings) {
        const auto [value, expected] = firstDifference(film.identity.settings, first.identity.settings);
        return mismatch("setting", quoted(value), quoted(expected));
    }
    return std::nullopt;
}

void checkSamePicture(const Film& film, const std::string& name, const Film& first, const std::string& firstName)
{
    if (const std::optional<Message> other = findOtherPicture(film, first)) {
        throw InputError(Message(*other, {part::file(name), ": cannot be merged with ", firstName, ": ", other->sentence, "."}));
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
    std::sort(ranges.begin(), ranges.end(), [&](const auto& a, const auto& b) {
        const auto key = [&](const auto& entry) {
            const auto& [range, film] = entry;
            return std::tuple(films[film].rowsAbove, films[film].height, range, film);
        };
        return key(a) < key(b);
    });
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        const auto& [before, first] = ranges[i - 1];
        const auto& [range, second] = ranges[i];
        if (haveSameRows(films[first], films[second]) && range.first < before.second) {
            throw InputError(MessageId::Duplicate,
                             {part::file(names[second]), ": cannot be merged with ", names[first], ": both hold ", part::place("samples"),
                              " ", part::value(std::to_string(range.first) + ":" + std::to_string(std::min(range.second, before.second))),
                              ", expected ", part::expected("disjoint ranges"), "."});
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

// Who rendered both, and how long.
void addOrigin(Film& film, const Film& next)
{
    film.complete = film.complete && next.complete;
    film.seconds += next.seconds;
    film.showsBackground = film.showsBackground && next.showsBackground;
    if (film.device.find(next.device) == std::string::npos) {
        film.device += "; " + next.device;
    }
    addArithmetic(film, next.arithmetic);
    if (film.identity.kernels != next.identity.kernels) {
        film.identity.kernels = "several";
    }
}

void foldHeader(Film& film, const Film& next)
{
    addRanges(film, next, continuesExactly(film, next));
    addOrigin(film, next);
}

bool isOneRun(const Film& film) { return film.complete && film.sampleRanges.size() == 1 && hasOneArithmetic(film); }

// `below`: the next rows.
void appendRows(Film& film, Film below)
{
    addOrigin(film, below);
    film.height += below.height;
    film.rowsBelow = below.rowsBelow;
    const auto append = [](auto& rows, const auto& more) { rows.insert(rows.end(), more.begin(), more.end()); };
    append(film.pixels, below.pixels);
    append(film.splats, below.splats);
    append(film.catcher, below.catcher);
    append(film.groups.values, below.groups.values);
    append(film.splatGroups.values, below.splatGroups.values);
}

// Whether bands of one run are one run together. Refuses `below` unless it is the next band of `above`, with the same samples.
bool continuesBelow(const Film& above, const Film& below, const std::string& name)
{
    const MessagePart itsRows = part::place("rows " + rowsText(below));
    if (below.rowsAbove != std::uint64_t{above.rowsAbove} + above.height) {
        throw InputError(MessageId::Mismatch,
                         {part::file(name), ": cannot be merged: its ", itsRows, " come after ", part::value("rows " + rowsText(above)),
                          ", expected ", part::expected("the same rows or those that begin where they end"), "."});
    }
    if (below.sampleRanges != above.sampleRanges) {
        throw InputError(MessageId::Mismatch,
                         {part::file(name), ": cannot be merged: its ", itsRows, " have samples ", part::value(sampleRangesText(below)),
                          ", expected ", part::expected(sampleRangesText(above)), " as rows ", rowsText(above), " have."});
    }
    return above.identity.kernels == below.identity.kernels && above.arithmetic == below.arithmetic;
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
    const bool alike = film.identity.kernels == next.identity.kernels && film.arithmetic == next.arithmetic && hasOneArithmetic(film);
    return alike && begin == film.sampleRanges.front().second && begin % kPageSamples == 0 && end - begin <= kPageSamples;
}

std::optional<Message> findDifference(const Film& film, const Film& first)
{
    const std::optional<Message> difference = findOtherPicture(film, first);
    return difference || haveSameRows(film, first) ? difference : mismatch("range of rows", rowsText(film), rowsText(first));
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
    std::stable_sort(plan.order.begin(), plan.order.end(), [&](std::size_t a, std::size_t b) {
        const auto key = [&](const Film& film) { return std::tuple(film.rowsAbove, film.height, firstSample(film)); };
        return key(films[a]) < key(films[b]);
    });
    std::vector<std::pair<Film, std::string>> bands;  // each with the name of its first film
    for (const std::size_t i : plan.order) {
        const Film& next = films[i];
        if (!bands.empty() && haveSameRows(bands.back().first, next)) {
            plan.exact = plan.exact && continuesExactly(bands.back().first, next);
            foldHeader(bands.back().first, next);
        } else {
            plan.exact = plan.exact && isOneRun(next);
            bands.emplace_back(next, names[i]);
        }
    }
    for (std::size_t i = 1; i < bands.size(); ++i) {
        plan.exact = continuesBelow(bands[i - 1].first, bands[i].first, bands[i].second) && plan.exact;
    }
    return plan;
}

void foldFilm(Film& film, const Film& next)
{
    foldMoments(film, next);
    foldHeader(film, next);
}

MergedFilm mergeFilms(const std::vector<Film>& headers, const std::vector<std::string>& names,
                      const std::function<Film(std::size_t)>& filmAt)
{
    const MergePlan plan = planMerge(headers, names);
    std::optional<Film> picture;
    const auto append = [&picture](Film band) {
        if (picture) {
            appendRows(*picture, std::move(band));
        } else {
            picture = std::move(band);
        }
    };
    Film band = filmAt(plan.order[0]);
    for (std::size_t i = 1; i < headers.size(); ++i) {
        Film next = filmAt(plan.order[i]);
        if (haveSameRows(band, next)) {
            foldFilm(band, next);
        } else {
            append(std::exchange(band, std::move(next)));
        }
    }
    append(std::move(band));
    return {*std::move(picture), plan.exact};
}

MergedFilm mergeFilms(const std::vector<fs::path>& files)
{
    std::vector<Film> headers;
    std::vector<std::string> names;
    for (const fs::path& file : files) {
        headers.push_back(readFilmHeader(file));
        names.push_back(file.string());
    }
    return mergeFilms(headers, names, [&](std::size_t i) { return readFilm(files[i]); });
}

}  // namespace glim
