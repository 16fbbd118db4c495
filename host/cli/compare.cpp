#include "host/cli/compare.hpp"

#include "host/cli/check_target.hpp"
#include "host/cli/compare_report.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"
#include "host/measure/error_picture.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/settings.hpp"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glim {
namespace {

struct CompareOptions {
    std::filesystem::path picture, reference;
    std::optional<std::filesystem::path> variance, difference, differencePng;
    bool json = false;
};

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

Relation relate(const CompareOptions& options, const Image& image, const Image& referenceImage, bool equal)
{
    const auto film = filmOf(options.picture, image), reference = filmOf(options.reference, referenceImage);
    return equal                                                   ? Relation::Identical
           : film && reference && shareSamples(*film, *reference) ? Relation::SharedSamples
                                                                   : Relation::Independent;
}

void checkTargets(const CompareOptions& options)
{
    const std::vector<std::filesystem::path> inputs{options.picture, options.reference, options.variance.value_or("")};
    if (options.difference) {
        checkTarget(*options.difference, ".exr", inputs);
    }
    if (options.differencePng) {
        checkTarget(*options.differencePng, ".png", inputs);
    }
}

void writeDifferences(const CompareOptions& options, const Picture& picture, const Picture& reference, double epsilon)
{
    if (options.difference) {
        writeExr(*options.difference, signedDifference(picture, reference));
        std::cerr << "Wrote A - B to " << options.difference->string() << ".\n";
    }
    if (options.differencePng) {
        const ErrorPicture drawn = drawErrors(picture, reference, epsilon);
        writePng(*options.differencePng, picture.width, picture.height, drawn.pixels);
        std::cerr << "Wrote (x-r) / sqrt(r^2 + eps) to " << options.differencePng->string() << ": blue " << -drawn.scale
                  << " and less (too dark), white 0, red " << drawn.scale << " and more (too bright).\n";
    }
}

void runCompare(const CompareOptions& options)
{
    checkTargets(options);
    const Image image = readExr(options.picture), referenceImage = readExr(options.reference);
    const Picture picture = pictureOf(image, options.picture.string());
    Picture reference = pictureOf(referenceImage, options.reference.string());
    if (options.variance) {
        setVariance(reference, readExr(*options.variance), options.variance->string());
    }
    CompareReport report;
    report.result = compareImages(picture, reference);
    report.relation = relate(options, image, referenceImage, picture.radiance == reference.radiance);
    if (report.relation == Relation::Independent && !picture.variance.empty() && !reference.variance.empty()) {
        report.test = zTest(picture, reference);
    }
    writeDifferences(options, picture, reference, report.result.epsilon);
    if (options.json) {
        printJson(report);
    } else {
        std::cout << "A = " << options.picture.string() << ", B = " << options.reference.string() << " (the reference)\n";
        printTable(report);
    }
}

}  // namespace

void addCompare(CLI::App& app)
{
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "Measure how far a picture is from a reference");
    command->footer("Prints MSE, RMSE, MAPE = mean |x-r| / (|r| + .01 mean(r)), and relMSE = mean (x-r)^2 / (r^2 + eps)\n"
                    "with eps = .01 mean(r)^2 and, as relMSE absolute, eps = .01; means are over pixels and channels.\n"
                    "Trimmed figures leave out the .1 % of pixels with the largest terms, and say what share those have:\n"
                    "they show the rest of a picture with fireflies, but are no measure of its error.\n"
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
    command
        ->add_option("--diff-png", options->differencePng,
                     "Draw (x-r) / sqrt(r^2 + eps), the mean of the channels (.png): blue too dark, white right, red too bright; "
                     "full colour is the error that 95 % of the pixels stay below, and is printed")
        ->type_name("D.png");
    command->add_flag("--json", options->json, "Print JSON instead of a table; unknown numbers are null");
    command->callback([options] { runCompare(*options); });
}

}  // namespace glim
