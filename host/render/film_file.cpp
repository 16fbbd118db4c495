#include "host/render/film_file.hpp"

#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/check_guide.hpp"
#include "host/render/film_layers.hpp"
#include "host/render/film_place.hpp"
#include "host/text.hpp"
#include "version.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <type_traits>

namespace fs = std::filesystem;

namespace glim {
namespace {

// Of the layers and attributes below; an older reader would misread a film with light paths, whose R, G, B are no moments. Films up to
// glim 0.2 have no seal over their header; later ones are nothing without.
constexpr double kUnsealed = 1, kUnsealedWithSplats = 2, kFormat = 3, kFormatWithSplats = 4;

double formatOf(const Film& film) { return film.splats.empty() ? kFormat : kFormatWithSplats; }
bool hasSplats(double format) { return format == kUnsealedWithSplats || format == kFormatWithSplats; }

constexpr std::uint32_t kBandRows = 256;  // written at once: 16 blocks of OpenEXR, for as many cores

constexpr const char* kBackground = "glim:background";
constexpr const char *kProgress = "glim:progress", *kProgressDigest = "glim:progressDigest";  // of checkpoints
constexpr const char* kHalvesDigest = "glim:halvesDigest";                                    // of those with halves
constexpr const char *kGuide = "glim:guide", *kGuideTexels = "glim:guideTexels", *kNoGuide = "none";
constexpr const char *kHalves[] = {"firstHalf.", "secondHalf."}, *kBefore = "before.";

bool hasErrors(const Film& film)
{
    return std::ranges::any_of(film.pixels, [](const PixelMoments& pixel) { return pixel.blocks >= 2; });
}

bool isEmpty(const std::vector<PixelMoments>& pixels)
{
    return std::ranges::all_of(pixels, [](const PixelMoments& pixel) { return pixel.count == 0; });
}

template <class Moments>
bool areSame(const std::vector<Moments>& a, const std::vector<Moments>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

// What a checkpoint has folded is the film itself, nothing, or in layers of its own.
constexpr const char *kAll = "all", *kNothing = "nothing", *kApart = "apart";

const char* placeOfFolded(const Film& film, const Checkpoint& checkpoint)
{
    const bool same = areSame(film.pixels, checkpoint.film.pixels) && areSame(film.splats, checkpoint.film.splats) &&
                      areSame(film.catcher, checkpoint.film.catcher) && areSame(film.groups.values, checkpoint.film.groups.values) &&
                      areSame(film.splatGroups.values, checkpoint.film.splatGroups.values);
    return same ? kAll : isEmpty(checkpoint.film.pixels) ? kNothing : kApart;
}

std::string progressText(const Checkpoint& checkpoint, const std::string& folded)
{
    std::ostringstream text;
    const SampleProgress& progress = checkpoint.progress;
    text << folded << ' ' << progress.sample << ' ' << progress.pixelsAhead << ' ' << progress.lightSample;
    if (const auto& adaptive = progress.adaptive) {
        text << ' ' << adaptive->mean << ' ' << adaptive->roundEnd << ' ' << adaptive->commonEnd << ' ' << adaptive->chosenBegin << ' '
             << (adaptive->choosing ? 1 + static_cast<int>(adaptive->second) : 0);
    }
    return text.str();
}

void addCheckpoint(const Checkpoint& checkpoint, const char* folded, const Run& run, Image& image)
{
    const std::vector<std::string> groups = getLightGroups(checkpoint.film);
    if (folded == kApart) {
        addMoments(checkpoint.film, groups, run, image, "folded.");
    }
    addMoments(checkpoint.page, groups, run, image, "page.");
    addMoments(checkpoint.common, groups, run, image, "common.");
    for (std::size_t i = 0; i < 2; ++i) {
        addMoments(checkpoint.halves[i], {}, run, image, kHalves[i]);
    }
    addMoments(checkpoint.before, {}, run, image, kBefore);
    if (const auto& adaptive = checkpoint.progress.adaptive) {
        const auto copy = [&run](const std::vector<std::uint32_t>& counts) {
            const std::span<const std::uint32_t> part = run.of(counts);
            return std::vector(part.begin(), part.end());
        };
        image.counts["chosen.X"] = copy(adaptive->chosen);
        image.counts["blocksLeft.X"] = copy(adaptive->blocksLeft);
        if (!adaptive->blocksLater.empty()) {
            image.counts["blocksLater.X"] = copy(adaptive->blocksLater);
        }
    }
}

void addGuide(const LearnedGuide& learned, Image& image)
{
    const std::string gain = learned.gain ? " gain=" + exactText(*learned.gain) : "";
    if (!learned.guide) {
        image.attributes[kGuide] = kNoGuide + gain;
        return;
    }
    const Guide& guide = *learned.guide;
    image.attributes[kGuide] =
        "cells=" + std::to_string(guide.cells) + " paths=" + std::to_string(guide.paths) + " seconds=" + exactText(guide.seconds) + gain;
    // As they are: zstd would halve them, which is little of a film's file.
    const std::span<const std::byte> bytes = std::as_bytes(std::span(guide.texels));
    image.attributes[kGuideTexels] = OpaqueBytes(bytes.begin(), bytes.end());
}

void addColors(std::span<const glm::vec3> colors, const std::string& layer, Image& image)
{
    for (int c = 0; c < 3; ++c) {
        std::vector<float>& channel = image.channels[layer + "RGB"[c]];
        channel.clear();
        for (const glm::vec3& color : colors) {
            channel.push_back(color[c]);
        }
    }
}

void addDenoised(const DenoisedLayers& denoised, const Run& run, Image& image)
{
    addColors(denoised.radiance.subspan(run.begin, run.count), "denoised.", image);
    addColors(denoised.error.subspan(run.begin, run.count), "denoisedError.", image);
}

Image headerOf(const Film& film, const FilmDigests& digests)
{
    Image image;
    image.attributes = {{"software", "glim " GLIM_VERSION},
                        {"glim:film", formatOf(film)},
                        {"glim:sceneFile", film.sceneFile},
                        {"glim:scene", film.identity.scene},
                        {"glim:settings", film.identity.settings},
                        {"glim:seed", static_cast<double>(film.identity.seed)},
                        {"glim:samples", sampleRangesText(film)},
                        {"glim:complete", film.complete ? 1.0 : 0.0},
                        {"glim:seconds", film.seconds},
                        {"glim:device", film.device},
                        {"glim:kernels", film.identity.kernels},
                        {"glim:arithmetic", film.arithmetic},
                        {"glim:digest", digests.film},
                        {"glim:pixels", digests.pixels},
                        {kHeaderDigest, ""}};  // which ExrWriter computes
    if (!film.showsBackground) {
        image.attributes[kBackground] = "off";
    }
    describePlace(image, film);
    return image;
}

// In bands of rows: all planes at once would take as much memory as the film again, and more time.
std::optional<FilmDigests> write(
    const fs::path& path, const Film& film, const FilmAdditions& additions,
    const std::function<bool()>& shouldContinue = [] { return true; })
{
    const Checkpoint* checkpoint = additions.checkpoint;
    const char* folded = checkpoint == nullptr ? kNothing : placeOfFolded(film, *checkpoint);
    const bool errors = hasErrors(film);
    const auto addRows = [&](Image& image, std::size_t first, std::size_t count) {
        const Run run{first * film.width, count * film.width};
        addFilm(film, run, errors, image);
        if (checkpoint != nullptr) {
            addCheckpoint(*checkpoint, folded, run, image);
        }
        if (additions.denoised != nullptr) {
            addDenoised(*additions.denoised, run, image);
        }
    };
    const FilmDigests digests = computeDigests(film);
    Image header = headerOf(film, digests);
    if (additions.denoised != nullptr) {
        header.attributes["glim:denoiser"] = additions.denoised->denoiser;
    }
    if (checkpoint != nullptr) {
        header.attributes[kProgressDigest] = computeDigest(*checkpoint);
        header.attributes[kProgress] = progressText(*checkpoint, folded);
        if (checkpoint->hasHalves()) {
            header.attributes[kHalvesDigest] = computeHalvesDigest(*checkpoint);
        }
        if (checkpoint->guide) {
            addGuide(*checkpoint->guide, header);
        }
    }
    addRows(header, 0, 0);
    ExrWriter writer(path, header);
    Image band;
    band.width = film.width;
    for (std::uint32_t first = 0; first < film.height; first += band.height) {
        if (!shouldContinue()) {
            return std::nullopt;
        }
        band.height = std::min(kBandRows, film.height - first);
        addRows(band, first, band.height);
        writer.write(band);
    }
    writer.commit();
    return digests;
}

template <class Value>
Value attribute(const fs::path& path, const Image& image, const std::string& name)
{
    const auto entry = image.attributes.find(name);
    if (entry == image.attributes.end() || !std::holds_alternative<Value>(entry->second)) {
        throw InputError(MessageId::UnknownFormat, {part::file(path), ": is not a film written by glim: it has no attribute ",
                                                    part::place(name), " of the expected type."});
    }
    return std::get<Value>(entry->second);
}

// Films of earlier builds lack some.
std::string textIfPresent(const Image& image, const std::string& name)
{
    const auto entry = image.attributes.find(name);
    const auto* text = entry == image.attributes.end() ? nullptr : std::get_if<std::string>(&entry->second);
    return text == nullptr ? std::string() : *text;
}

void checkDigest(const fs::path& path, const std::string& what, const std::string& digest, const std::string& expected)
{
    if (digest != expected) {
        throw InputError(MessageId::FileDamaged, {part::file(path), ": is damaged: the SHA-256 of its ", part::place(what), " is ",
                                                  part::value(digest), ", expected ", part::expected(expected), "."});
    }
}

// Returns ascending disjoint ranges, or nothing.
std::optional<decltype(Film::sampleRanges)> parseRanges(const std::string& text)
{
    decltype(Film::sampleRanges) ranges;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) {
        std::istringstream range(word);
        std::uint32_t begin = 0, end = 0;
        char colon = '\0';
        if (!(range >> begin >> colon >> end) || colon != ':' || !range.eof() || begin >= end ||
            (!ranges.empty() && begin < ranges.back().second)) {
            return std::nullopt;
        }
        ranges.emplace_back(begin, end);
    }
    return ranges;
}

Film filmOfHeader(const fs::path& path, const Image& image)
{
    const double format = attribute<double>(path, image, "glim:film");
    if (!(format >= kUnsealed && format <= kFormatWithSplats && format == std::floor(format))) {
        throw InputError(MessageId::UnknownFormat,
                         {part::file(path), ": is a film of format ", part::value(exactText(format)), ", expected ",
                          part::expected("format " + exactText(kUnsealed) + " to " + exactText(kFormatWithSplats)), "."});
    }
    const double seed = attribute<double>(path, image, "glim:seed");
    if (!(seed >= 0 && seed <= std::numeric_limits<std::uint32_t>::max() && seed == std::floor(seed))) {
        throw InputError(MessageId::OutOfRange, {part::file(path), ": its ", part::place("seed"), " is ", part::value(std::to_string(seed)),
                                                 ", expected ", part::expected("a 32-bit whole number"), "."});
    }
    const auto samples = attribute<std::string>(path, image, "glim:samples");
    const auto ranges = parseRanges(samples);
    if (!ranges || ranges->empty()) {
        throw InputError(MessageId::Malformed, {part::file(path), ": its ", part::place("sample ranges"), " are ", part::quoted(samples),
                                                ", expected ", part::expected("ascending disjoint ranges such as \"0:256 512:768\""), "."});
    }
    Film film;
    takePlace(path, image, film);
    film.sampleRanges = *ranges;
    film.identity.scene = attribute<std::string>(path, image, "glim:scene");
    film.identity.settings = attribute<std::string>(path, image, "glim:settings");
    film.identity.seed = static_cast<std::uint32_t>(seed);
    film.complete = attribute<double>(path, image, "glim:complete") != 0.0;
    film.seconds = attribute<double>(path, image, "glim:seconds");
    film.device = attribute<std::string>(path, image, "glim:device");
    film.sceneFile = attribute<std::string>(path, image, "glim:sceneFile");
    film.identity.kernels = textIfPresent(image, "glim:kernels");
    film.arithmetic = textIfPresent(image, "glim:arithmetic");
    film.showsBackground = textIfPresent(image, kBackground) != "off";
    return film;
}

Film filmOfImage(const fs::path& path, const Image& image)
{
    Film film = filmOfHeader(path, image);
    takeFilm(path, image, hasSplats(attribute<double>(path, image, "glim:film")), film);
    if (const std::string digest = textIfPresent(image, "glim:digest"); !digest.empty()) {
        checkDigest(path, "samples", computeDigest(film), digest);
    }
    return film;
}

// A number of "cells=812 paths=131072"; nothing if it lacks it.
template <class Number>
std::optional<Number> findNumber(const std::string& text, const std::string& name)
{
    const std::string word = findSetting(text, name);
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

std::vector<uvec4> takeTexels(const fs::path& path, const Image& image, const std::string& digest)
{
    const auto bytes = attribute<OpaqueBytes>(path, image, kGuideTexels);
    std::vector<uvec4> texels(bytes.size() / sizeof(uvec4));
    std::memcpy(texels.data(), bytes.data(), texels.size() * sizeof(uvec4));
    checkDigest(path, "guide", digestOf(texels), digest);
    if (!hasSoundTrees(texels)) {
        throw InputError(MessageId::FileDamaged, {part::file(path), ": is damaged: its ", part::place("guide"),
                                                  " has trees that leave its ", part::value(counted(texels.size(), "texel")), " or meet."});
    }
    return texels;
}

// Of a film with these settings.
std::optional<LearnedGuide> takeGuide(const fs::path& path, const Image& image, const std::string& settings)
{
    const std::string text = textIfPresent(image, kGuide), digest = findSetting(settings, "guide");
    if (text.empty()) {
        return std::nullopt;
    }
    LearnedGuide learned{nullptr, findNumber<double>(text, "gain")};
    const auto cells = findNumber<std::uint32_t>(text, "cells");
    const auto paths = findNumber<std::uint64_t>(text, "paths");
    const auto seconds = findNumber<double>(text, "seconds");
    if (!digest.empty() && cells && paths && seconds) {
        learned.guide = std::make_shared<const Guide>(Guide{takeTexels(path, image, digest), digest, *cells, *paths, *seconds});
    } else if (!digest.empty() || !text.starts_with(kNoGuide)) {
        throw InputError(MessageId::FileDamaged,
                         {part::file(path), ": is damaged: its ", part::place("guide"), " is ", part::quoted(text), "."});
    }
    return learned;
}

Checkpoint readCheckpoint(const fs::path& path, const Image& image, const Film& film)
{
    Checkpoint checkpoint;
    SampleProgress& progress = checkpoint.progress;
    checkpoint.film = film;
    const std::size_t pixels = checkpoint.film.pixels.size();
    const std::vector<std::string> groups = getLightGroups(film);
    const auto text = attribute<std::string>(path, image, kProgress);
    std::istringstream stream(text);
    std::string folded;
    stream >> folded >> progress.sample >> progress.pixelsAhead >> progress.lightSample;
    if (AdaptiveProgress a; !stream.fail() && !stream.eof()) {
        int choosing = 0;
        stream >> a.mean >> a.roundEnd >> a.commonEnd >> a.chosenBegin >> choosing;
        a.choosing = choosing > 0;
        a.second = choosing > 1;
        progress.adaptive = a;
    }
    if (stream.fail() || !stream.eof() || progress.pixelsAhead >= pixels || (folded != kAll && folded != kNothing && folded != kApart)) {
        throw InputError(MessageId::FileDamaged,
                         {part::file(path), ": is damaged: its ", part::place("progress"), " is ", part::quoted(text), "."});
    }
    if (folded != kAll) {
        FilmMoments& moments = checkpoint.film;
        moments.pixels.assign(pixels, PixelMoments{});
        moments.splats.clear();
        std::ranges::fill(moments.catcher, CatcherMoments{});
        std::ranges::fill(moments.groups.values, glm::vec3(0.0F));
        moments.splatGroups = {};
        takeMoments(path, image, groups, moments, "folded.");
        takeMoments(path, image, groups, checkpoint.page, "page.");
    }
    if (auto& adaptive = progress.adaptive) {
        checkpoint.common.groups = GroupMoments(static_cast<std::uint32_t>(groups.size()), pixels);
        takeMoments(path, image, groups, checkpoint.common, "common.");
        checkpoint.common.pixels.resize(pixels);
        adaptive->chosen.resize(pixels);
        adaptive->blocksLeft.resize(pixels);
        takeCounts(path, image, "chosen.X", adaptive->chosen);
        takeCounts(path, image, "blocksLeft.X", adaptive->blocksLeft);
        if (image.counts.contains("blocksLater.X")) {
            adaptive->blocksLater.resize(pixels);
            takeCounts(path, image, "blocksLater.X", adaptive->blocksLater);
        }
    }
    checkDigest(path, "checkpoint", computeDigest(checkpoint), attribute<std::string>(path, image, kProgressDigest));
    if (const std::string digest = textIfPresent(image, kHalvesDigest); !digest.empty()) {
        for (std::size_t i = 0; i < 2; ++i) {
            takeMoments(path, image, {}, checkpoint.halves[i], kHalves[i]);
        }
        takeMoments(path, image, {}, checkpoint.before, kBefore);
        checkDigest(path, "halves", computeHalvesDigest(checkpoint), digest);
    }
    checkpoint.guide = takeGuide(path, image, film.identity.settings);
    return checkpoint;
}

// Refuses a damaged header before what it says is taken for anything else.
Image readSealed(const fs::path& path, Image (*read)(const fs::path&))
{
    Image image = read(path);
    const auto format = image.attributes.find("glim:film");
    const double* number = format == image.attributes.end() ? nullptr : std::get_if<double>(&format->second);
    checkHeaderDigest(path, number != nullptr && *number >= kFormat);
    return image;
}

}  // namespace

std::string sampleRangesText(const Film& film)
{
    std::ostringstream text;
    const char* separator = "";
    for (const auto& [begin, end] : film.sampleRanges) {
        text << separator << begin << ':' << end;
        separator = " ";
    }
    return text.str();
}

FilmDigests writeFilm(const fs::path& path, const Film& film, const FilmAdditions& additions)
{
    return write(path, film, additions).value();
}

std::optional<std::vector<glm::vec3>> readDenoised(const fs::path& path)
{
    const Image image = readExr(path);
    std::vector<glm::vec3> radiance(std::size_t{image.width} * image.height);
    for (int c = 0; c < 3; ++c) {
        const auto channel = image.channels.find(std::string("denoised.") + "RGB"[c]);
        if (channel == image.channels.end()) {
            return std::nullopt;
        }
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            radiance[i][c] = channel->second[i];
        }
    }
    return radiance;
}

std::optional<FilmDigests> writeFilm(const fs::path& path, const Film& film, const Checkpoint& checkpoint,
                                     const std::function<bool()>& shouldContinue)
{
    return write(path, film, {.checkpoint = &checkpoint}, shouldContinue);
}

Film readFilm(const fs::path& path) { return filmOfImage(path, readSealed(path, readExr)); }

Film readFilm(const fs::path& path, const Image& image) { return filmOfImage(path, image); }

StoredFilm readStoredFilm(const fs::path& path)
{
    const Image image = readSealed(path, readExr);
    StoredFilm stored{filmOfImage(path, image), std::nullopt};
    if (image.attributes.contains(kProgress)) {
        stored.checkpoint = readCheckpoint(path, image, stored.film);
    }
    return stored;
}

std::optional<LearnedGuide> readGuide(const fs::path& path)
{
    const Image image = readSealed(path, readExrHeader);
    return takeGuide(path, image, textIfPresent(image, "glim:settings"));
}

Film readFilmHeader(const fs::path& path) { return filmOfHeader(path, readSealed(path, readExrHeader)); }

Film readFilmHeader(const fs::path& path, const Image& image) { return filmOfHeader(path, image); }

}  // namespace glim
