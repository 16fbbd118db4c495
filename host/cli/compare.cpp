#include "host/cli/commands.hpp"
#include "host/cli/compare_report.hpp"
#include "host/image/exr.hpp"
#include "host/image/png.hpp"
#include "host/job/output_file.hpp"
#include "host/job/parse.hpp"
#include "host/measure/error_picture.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/settings.hpp"
#include "host/text.hpp"

#include <cmath>
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
    bool json = false, failsByNoise = false;
    std::optional<double> maxRmse;  // as a share of the reference's mean
};

// The film's header if glim wrote the picture.
std::optional<Film> makeFilm(const std::filesystem::path& path, const Image& image)
{
    if (image.attributes.count("glim:film") == 0) {
        return std::nullopt;
    }
    const Film film = readFilmHeader(path, image);
    if (!film.complete) {
        say(MessageId::IncompleteFilm,
            {part::file(path), " comes from a render that was stopped early: some pixels have fewer samples or none."});
    }
    return film;
}

Relation relate(const CompareOptions& options, const Image& image, const Image& referenceImage, bool equal)
{
    const auto film = makeFilm(options.picture, image), reference = makeFilm(options.reference, referenceImage);
    return equal                                                  ? Relation::Identical
           : film && reference && shareSamples(*film, *reference) ? Relation::SharedSamples
                                                                  : Relation::Independent;
}

// By the digests of their pixels; none unless glim wrote both.
std::optional<bool> haveSameBits(const Image& a, const Image& b)
{
    const auto mine = a.attributes.find("glim:pixels"), other = b.attributes.find("glim:pixels");
    return mine == a.attributes.end() || other == b.attributes.end() ? std::optional<bool>() : mine->second == other->second;
}

void checkCompareTargets(const CompareOptions& options)
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
        std::cerr << "Wrote picture - reference to " << escaped(options.difference->string()) << ".\n";
    }
    if (options.differencePng) {
        const ErrorPicture drawn = drawErrors(picture, reference, epsilon);
        writePng(*options.differencePng, picture.width, picture.height, drawn.pixels);
        std::cerr << "Wrote (x-r) / sqrt(r^2 + eps) to " << escaped(options.differencePng->string()) << ": blue " << -drawn.scale
                  << " and less (too dark), white 0, red " << drawn.scale << " and more (too bright).\n";
    }
}

std::string percent(double share) { return format("%.4g%%", 100.0 * share); }

// Says why the pictures fail, if they do.
ExitCode judge(const CompareOptions& options, const CompareReport& report, const Picture& reference)
{
    const MessagePart a = part::file(options.picture.string());
    bool passes = true;
    const auto fail = [&passes](std::initializer_list<MessagePart> why) {
        say(Severity::Error, Message(MessageId::PicturesDiffer, why));
        passes = false;
    };
    if (report.result.nonFinite > 0) {
        fail({a, ": ", part::value(std::to_string(report.result.nonFinite)), " pixels are not ", part::expected("finite"), "."});
    }
    if (options.failsByNoise && report.test && !report.test->agrees()) {
        fail({a, " and ", options.reference.string(), " differ by more than noise (level 1 %)."});
    }
    const double rmse = std::sqrt(report.result.errors.mse) / meanRadiance(reference);
    if (options.maxRmse && !(rmse <= *options.maxRmse) && report.result.errors.mse > 0.0) {
        fail({a, ": its RMSE is ", part::value(percent(rmse)), " of the mean of ", options.reference.string(), ", expected ",
              part::expected("at most " + percent(*options.maxRmse)), "."});
    }
    return passes ? ExitCode::Done : ExitCode::Differs;
}

// Without a test, --fail would let every picture pass.
void checkTested(const CompareOptions& options, const CompareReport& report)
{
    if (!options.failsByNoise || report.test || report.relation == Relation::Identical) {
        return;
    }
    const bool isShared = report.relation == Relation::SharedSamples;
    throw InputError(MessageId::Requires,
                     {part::file(options.picture.string()), ": ", part::place("--fail"), " cannot tell noise from other differences: ",
                      isShared ? "both films have the same samples; expected " : "a picture has no variance; expected ",
                      part::expected(isShared ? "another --seed" : "films of 33 samples or more, --variance or --max-rmse"), "."});
}

ExitCode runCompare(const CompareOptions& options)
{
    checkCompareTargets(options);
    const Image image = readExr(options.picture), referenceImage = readExr(options.reference);
    const Picture picture = makePicture(image, options.picture.string());
    Picture reference = makePicture(referenceImage, options.reference.string());
    if (options.variance) {
        setVariance(reference, readExr(*options.variance), options.variance->string());
    }
    CompareReport report;
    report.result = compareImages(picture, reference);
    report.relation = relate(options, image, referenceImage, picture.radiance == reference.radiance);
    report.sameBits = haveSameBits(image, referenceImage);
    if (report.relation == Relation::Independent && !picture.variance.empty() && !reference.variance.empty()) {
        report.test = zTest(picture, reference);
    }
    checkTested(options, report);
    writeDifferences(options, picture, reference, report.result.epsilon);
    if (options.json) {
        printJson(report);
    } else {
        std::cout << "A = " << escaped(options.picture.string()) << ", B = " << escaped(options.reference.string()) << " (the reference)\n";
        printTable(report);
    }
    return options.failsByNoise || options.maxRmse ? judge(options, report, reference) : ExitCode::Done;
}

}  // namespace

void addCompare(CommandLine& line)
{
    auto options = std::make_shared<CompareOptions>();
    Command& command = line.addCommand("compare", "Measure how far a picture is from a reference");
    command.beginGroup("Picture");
    command.addPath("picture", "A.exr", "Picture: any OpenEXR file with R, G, B", options->picture).require();
    command.addPath("reference", "B.exr", "Reference, of the same size", options->reference).require();
    command.addPath("--variance", "V.exr", "Variance of the reference's pixels [the reference's layer]", options->variance);
    command.beginGroup("Output");
    command.addPath("--diff", "D.exr", "Write the difference picture - reference", options->difference);
    command.addPath("--diff-png", "D.png", "Draw the relative error: blue too dark, red too bright", options->differencePng);
    command.addFlag("--fail", "Exit with 4 if the pictures differ by more than noise", options->failsByNoise);
    command.add("--max-rmse", "P%", "Exit with 4 if the RMSE is more than this share of the reference's mean [off]",
                [options](const OptionValue& value) { options->maxRmse = parsePercent("--max-rmse", value); });
    command.addFlag("--json", "Print JSON instead of a table; unknown numbers are null", options->json);
    command.setFooter(
        "Prints MSE, RMSE, relMSE, MAPE and the ratio of the means, with intervals. If both variances are known,\n"
        "z-tests say whether the pictures agree up to noise. host/cli/README.md defines the figures.");
    command.onRun([options] { return runCompare(*options); });
}

}  // namespace glim
