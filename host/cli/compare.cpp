#include "host/cli/compare.hpp"

#include "host/cli/check_target.hpp"
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/measure/compare_images.hpp"
#include "host/measure/z_test.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/settings.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

namespace glim {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kChannels[] = {"R", "G", "B"};

struct CompareOptions {
    std::filesystem::path picture, reference;
    std::optional<std::filesystem::path> variance, difference;
    bool json = false;
};

// Whether a test of noise makes sense, which supposes that the two noises have nothing to do with each other.
enum class Relation { Independent, SharedSamples, Identical };

std::string number(double value, int digits = 5)
{
    if (std::isnan(value)) {
        return "unknown";
    }
    std::ostringstream stream;
    stream << std::setprecision(digits) << value;
    return stream.str();
}

std::ostream& row(const std::string& label)
{
    return std::cout << std::left << std::setw(22) << label;
}

const char* sourceName(IntervalSource source)
{
    switch (source) {
    case IntervalSource::Variance: return "variance";
    case IntervalSource::Blocks: return "blocks";
    case IntervalSource::None: break;
    }
    return "none";
}

std::string ratioText(const MeanRatio& ratio, IntervalSource source)
{
    const std::string value = number(ratio.value, 6);
    return source == IntervalSource::None
               ? value
               : value + " [" + number(ratio.low, 6) + ", " + number(ratio.high, 6) + "]";
}

std::string withoutNoise(double value, const std::optional<SquaredErrors>& noise, double SquaredErrors::*member)
{
    return noise ? "   (" + number(value - (*noise).*member) + " without the reference's noise)" : "";
}

void printErrors(const Comparison& result)
{
    const auto& noise = result.referenceNoise;
    const SquaredErrors& errors = result.errors;
    row("MSE") << number(errors.mse) << withoutNoise(errors.mse, noise, &SquaredErrors::mse) << '\n';
    row("RMSE") << number(std::sqrt(errors.mse)) << '\n';
    row("relMSE") << number(errors.relMse) << withoutNoise(errors.relMse, noise, &SquaredErrors::relMse)
                  << "   eps = .01 mean(r)^2 = " << number(result.epsilon, 3) << '\n';
    row("relMSE absolute") << number(errors.relMseAbsolute)
                           << withoutNoise(errors.relMseAbsolute, noise, &SquaredErrors::relMseAbsolute)
                           << "   eps = .01\n";
    row("MAPE") << number(result.mape) << '\n';
    if (result.noise) {
        row("expected from A") << "relMSE " << number(result.noise->relMse) << ", relMSE absolute "
                               << number(result.noise->relMseAbsolute) << " by its own variance\n";
    }
}

void printRatios(const Comparison& result)
{
    for (std::size_t c = 0; c < 3; ++c) {
        row(std::string("mean ratio ") + kChannels[c]) << ratioText(result.ratio[c], result.intervalSource) << '\n';
    }
    row("mean ratio") << ratioText(result.ratioOfAll, result.intervalSource);
    switch (result.intervalSource) {
    case IntervalSource::Variance: std::cout << "   95 % intervals from the pixels' variances\n"; break;
    case IntervalSource::Blocks: std::cout << "   95 % intervals from the scatter of 8x8 blocks\n"; break;
    case IntervalSource::None: std::cout << "   no intervals: too few pixels and no variance\n"; break;
    }
    const MaxError& worst = result.maxError;
    row("largest difference") << "at (" << worst.x << ", " << worst.y << ") in " << kChannels[worst.channel] << ": "
                              << worst.value << " for " << worst.reference << '\n';
    row("pixels") << result.compared << " compared; not finite: " << result.nonFinite << " of A, "
                  << result.nonFiniteInReference << " of B\n";
}

void printTest(const ZTest& test)
{
    row("z of means") << number(test.meanZ[0], 3) << ' ' << number(test.meanZ[1], 3) << ' ' << number(test.meanZ[2], 3)
                      << "   limit " << number(test.meanLimit, 3) << "; would see a bias of "
                      << number(100 * test.detectableBias, 2) << " %\n";
    row("z of 8x8 blocks") << "largest " << number(test.worstZ, 3) << " at (" << test.worstX << ", " << test.worstY
                           << ") in " << kChannels[test.worstChannel] << "   limit " << number(test.blockLimit, 3) << '\n';
    row("mean z^2 of blocks");
    for (std::size_t c = 0; c < 3; ++c) {
        std::cout << number(test.meanSquare[c], 3) << " +- " << number(test.meanSquareReach[c], 2) << (c < 2 ? ", " : "");
    }
    std::cout << "   expected 1\n";
    row("verdict") << (test.agrees() ? "agree up to noise" : "differ by more than noise") << " (level 1 %)\n";
}

Json jsonOf(const SquaredErrors& errors)
{
    return {{"mse", errors.mse}, {"relmse", errors.relMse}, {"relmse_absolute", errors.relMseAbsolute}};
}

Json jsonOf(const MeanRatio& ratio)
{
    return {{"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}};
}

Json jsonOf(const ZTest& test)
{
    return {{"agree", test.agrees()},
            {"mean_z", test.meanZ},
            {"mean_limit", test.meanLimit},
            {"detectable_bias", test.detectableBias},
            {"worst_block", {{"z", test.worstZ}, {"x", test.worstX}, {"y", test.worstY},
                             {"channel", kChannels[test.worstChannel]}}},
            {"block_limit", test.blockLimit},
            {"mean_square", test.meanSquare},
            {"mean_square_reach", test.meanSquareReach}};
}

Json jsonOf(const Comparison& result, const std::optional<ZTest>& test)
{
    Json json = jsonOf(result.errors);
    json["rmse"] = std::sqrt(result.errors.mse);
    json["mape"] = result.mape;
    json["relmse_epsilon"] = result.epsilon;
    json["noise"] = result.noise ? jsonOf(*result.noise) : Json();
    json["reference_noise"] = result.referenceNoise ? jsonOf(*result.referenceNoise) : Json();
    json["mean_ratio"] = {{"all", jsonOf(result.ratioOfAll)},
                          {"R", jsonOf(result.ratio[0])},
                          {"G", jsonOf(result.ratio[1])},
                          {"B", jsonOf(result.ratio[2])},
                          {"interval", {{"level", 0.95}, {"source", sourceName(result.intervalSource)}}}};
    json["max_error"] = {{"x", result.maxError.x},
                         {"y", result.maxError.y},
                         {"channel", kChannels[result.maxError.channel]},
                         {"value", result.maxError.value},
                         {"reference", result.maxError.reference}};
    json["pixels"] = {{"compared", result.compared},
                      {"non_finite", result.nonFinite},
                      {"non_finite_in_reference", result.nonFiniteInReference}};
    json["z_test"] = test ? jsonOf(*test) : Json();
    return json;
}

const char* nameOf(Relation relation)
{
    switch (relation) {
    case Relation::Identical: return "identical";
    case Relation::SharedSamples: return "shared samples";
    case Relation::Independent: break;
    }
    return "independent";
}

void report(const CompareOptions& options, const Comparison& result, Relation relation, const std::optional<ZTest>& test)
{
    if (options.json) {
        Json json = jsonOf(result, test);
        json["relation"] = nameOf(relation);
        std::cout << json.dump(2) << '\n';
        return;
    }
    std::cout << "A = " << options.picture.string() << ", B = " << options.reference.string() << " (the reference)\n";
    printErrors(result);
    printRatios(result);
    if (test) {
        printTest(*test);
    } else if (relation == Relation::Identical) {
        row("verdict") << "identical\n";
    } else if (relation == Relation::SharedSamples) {
        row("verdict") << "none: the two share samples, so their noise tells nothing\n";
    }
}

// The film's header if glim wrote the picture.
std::optional<Film> filmOf(const std::filesystem::path& path, const Image& image)
{
    if (image.attributes.count("glim:film") == 0) {
        return std::nullopt;
    }
    const Film film = readFilmHeader(path);
    if (!film.complete) {
        std::cerr << "glim: " << path.string()
                  << " is of a render that was ended early: some pixels have fewer samples or none.\n";
    }
    return film;
}

void runCompare(const CompareOptions& options)
{
    if (options.difference) {
        checkTarget(*options.difference, ".exr", {options.picture, options.reference, options.variance.value_or("")});
    }
    const Image image = readExr(options.picture), referenceImage = readExr(options.reference);
    const Picture picture = pictureOf(image, options.picture.string());
    Picture reference = pictureOf(referenceImage, options.reference.string());
    if (options.variance) {
        setVariance(reference, readExr(*options.variance), options.variance->string());
    }
    const Comparison result = compareImages(picture, reference);
    const auto film = filmOf(options.picture, image), referenceFilm = filmOf(options.reference, referenceImage);
    const Relation relation = picture.radiance == reference.radiance ? Relation::Identical
                              : film && referenceFilm && shareSamples(*film, *referenceFilm) ? Relation::SharedSamples
                                                                                             : Relation::Independent;
    std::optional<ZTest> test;
    if (relation == Relation::Independent && !picture.variance.empty() && !reference.variance.empty()) {
        test = zTest(picture, reference);
    }
    if (options.difference) {
        writeExr(*options.difference, signedDifference(picture, reference));
        std::cerr << "Wrote A - B to " << options.difference->string() << ".\n";
    }
    report(options, result, relation, test);
}

}  // namespace

void addCompare(CLI::App& app)
{
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "Measure how far a picture is from a reference");
    command->footer("Prints MSE, RMSE, MAPE = mean |x-r| / (|r| + .01 mean(r)), and relMSE = mean (x-r)^2 / (r^2 + eps)\n"
                    "with eps = .01 mean(r)^2 and, as relMSE absolute, eps = .01; means are over pixels and channels.\n"
                    "The ratio mean(x) / mean(r) has a 95 % interval, from the variances if both are known, otherwise\n"
                    "from the scatter of 8x8 blocks. With both variances, z-tests say whether the pictures agree.\n"
                    "They take blocks of 8x8 for normal, which caustics and other rare bright light are only at many samples.\n"
                    "Variance layers in films written by glim are used without asking.");
    command->add_option("picture", options->picture, "The picture x: any OpenEXR file with R, G, B")
        ->required()
        ->type_name("A.exr");
    command->add_option("reference", options->reference, "The reference r, of the same size")
        ->required()
        ->type_name("B.exr");
    command
        ->add_option("--variance", options->variance,
                     "Variance of the reference's pixels, each a mean, in R, G, B; goes before one in B.exr")
        ->type_name("V.exr");
    command->add_option("--diff", options->difference, "Write the signed difference A - B (.exr)")->type_name("D.exr");
    command->add_flag("--json", options->json, "Print JSON instead of a table; unknown numbers are null");
    command->callback([options] { runCompare(*options); });
}

}  // namespace glim
