#include "host/cli/compare_report.hpp"

#include "host/json.hpp"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace glim {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};

std::string number(double value, int digits = 5)
{
    if (std::isnan(value)) {
        return "unknown";
    }
    std::ostringstream stream;
    stream << std::setprecision(digits) << value;
    return stream.str();
}

std::ostream& row(const std::string& label) { return std::cout << std::left << std::setw(22) << label; }

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
    return source == IntervalSource::None ? value : value + " [" + number(ratio.low, 6) + ", " + number(ratio.high, 6) + "]";
}

std::string withoutNoise(double value, const std::optional<SquaredErrors>& noise, double SquaredErrors::*member)
{
    return noise ? "   (" + number(value - (*noise).*member) + " without the reference's noise)" : "";
}

void printTrimmed(const std::string& name, const TrimmedErrors& trimmed, double SquaredErrors::*member)
{
    row(name + " trimmed") << number(trimmed.kept.*member) << "   without the " << trimmed.dropped
                           << " worst pixels (.1 %), which contribute " << number(100 * trimmed.share.*member, 3) << " % of it\n";
}

void printErrors(const Comparison& result)
{
    const auto& noise = result.referenceNoise;
    const SquaredErrors& errors = result.errors;
    row("MSE") << number(errors.mse) << withoutNoise(errors.mse, noise, &SquaredErrors::mse) << '\n';
    row("RMSE") << number(std::sqrt(errors.mse)) << '\n';
    row("relMSE") << number(errors.relMse) << withoutNoise(errors.relMse, noise, &SquaredErrors::relMse)
                  << "   eps = .01 mean(r)^2 = " << number(result.epsilon, 3) << '\n';
    row("relMSE absolute") << number(errors.relMseAbsolute) << withoutNoise(errors.relMseAbsolute, noise, &SquaredErrors::relMseAbsolute)
                           << "   eps = .01\n";
    printTrimmed("MSE", result.trimmed, &SquaredErrors::mse);
    printTrimmed("relMSE", result.trimmed, &SquaredErrors::relMse);
    row("MAPE") << number(result.mape) << '\n';
    if (result.noise) {
        row("expected noise of A") << "relMSE " << number(result.noise->relMse) << ", relMSE absolute "
                                   << number(result.noise->relMseAbsolute) << " from its own variance\n";
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
    row("largest difference") << "at (" << worst.x << ", " << worst.y << ") in " << kChannels[worst.channel] << ": A " << worst.value
                              << ", B " << worst.reference << '\n';
    row("pixels") << result.compared << " compared; not finite: " << result.nonFinite << " of A, " << result.nonFiniteInReference
                  << " of B\n";
}

void printTest(const ZTest& test)
{
    row("z of means") << number(test.meanZ[0], 3) << ' ' << number(test.meanZ[1], 3) << ' ' << number(test.meanZ[2], 3) << "   limit "
                      << number(test.meanLimit, 3) << "; would see a bias of " << number(100 * test.detectableBias, 2) << " %\n";
    row("z of 8x8 blocks") << "largest " << number(test.worstZ, 3) << " at (" << test.worstX << ", " << test.worstY << ") in "
                           << kChannels[test.worstChannel] << "   limit " << number(test.blockLimit, 3) << '\n';
    row("mean z^2 of blocks");
    for (std::size_t c = 0; c < 3; ++c) {
        std::cout << number(test.meanSquare[c], 3) << " +- " << number(test.meanSquareMargin[c], 2) << (c < 2 ? ", " : "");
    }
    std::cout << "   expected 1\n";
    row("verdict") << (test.agrees() ? "agree up to noise" : "differ by more than noise") << " (level 1 %)\n";
}

Json toJson(const SquaredErrors& errors)
{
    return {{"mse", errors.mse}, {"relmse", errors.relMse}, {"relmse_absolute", errors.relMseAbsolute}};
}

Json toJson(const MeanRatio& ratio) { return {{"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}}; }

Json toJson(const ZTest& test)
{
    return {{"agree", test.agrees()},
            {"mean_z", test.meanZ},
            {"mean_limit", test.meanLimit},
            {"detectable_bias", test.detectableBias},
            {"worst_block", {{"z", test.worstZ}, {"x", test.worstX}, {"y", test.worstY}, {"channel", kChannels[test.worstChannel]}}},
            {"block_limit", test.blockLimit},
            {"mean_square", test.meanSquare},
            {"mean_square_margin", test.meanSquareMargin}};
}

Json toJson(const Comparison& result, const std::optional<ZTest>& test)
{
    Json json = toJson(result.errors);
    json.set("rmse", std::sqrt(result.errors.mse));
    json.set("mape", result.mape);
    json.set("relmse_epsilon", result.epsilon);
    Json trimmed = toJson(result.trimmed.kept);
    trimmed.set("dropped_pixels", result.trimmed.dropped);
    trimmed.set("dropped_share", toJson(result.trimmed.share));
    json.set("trimmed", trimmed);
    json.set("noise", result.noise ? toJson(*result.noise) : Json());
    json.set("reference_noise", result.referenceNoise ? toJson(*result.referenceNoise) : Json());
    json.set("mean_ratio", {{"all", toJson(result.ratioOfAll)},
                            {"R", toJson(result.ratio[0])},
                            {"G", toJson(result.ratio[1])},
                            {"B", toJson(result.ratio[2])},
                            {"interval", {{"level", 0.95}, {"source", sourceName(result.intervalSource)}}}});
    json.set("max_error", {{"x", result.maxError.x},
                           {"y", result.maxError.y},
                           {"channel", kChannels[result.maxError.channel]},
                           {"value", result.maxError.value},
                           {"reference", result.maxError.reference}});
    json.set("pixels", {{"compared", result.compared},
                        {"non_finite", result.nonFinite},
                        {"non_finite_in_reference", result.nonFiniteInReference},
                        {"without_variance", result.withoutVariance}});
    json.set("z_test", test ? toJson(*test) : Json());
    return json;
}

const char* getName(Relation relation)
{
    switch (relation) {
    case Relation::Identical: return "identical";
    case Relation::SharedSamples: return "shared samples";
    case Relation::Independent: break;
    }
    return "independent";
}

}  // namespace

void printTable(const CompareReport& report)
{
    printErrors(report.result);
    printRatios(report.result);
    if (report.test) {
        printTest(*report.test);
    } else if (report.relation == Relation::Identical) {
        row("verdict") << (!report.sameBits   ? "identical\n"
                           : *report.sameBits ? "the same bits\n"
                                              : "identical colours; other variances or sample counts\n");
    } else if (report.relation == Relation::SharedSamples) {
        row("verdict") << "none: the two share samples, so their noise is not independent\n";
    }
}

void printJson(const CompareReport& report)
{
    Json json = toJson(report.result, report.test);
    json.set("relation", getName(report.relation));
    json.set("sameBits", report.sameBits ? Json(*report.sameBits) : Json());
    std::cout << json.dump(2) << '\n';
}

}  // namespace glim
