#include "host/cli/sampling_options.hpp"

#include "host/cli/parse.hpp"

#include <CLI/CLI.hpp>

#include <limits>

namespace glim {
namespace {

void addRoulette(CLI::App& command, RenderSettings& settings)
{
    command
        .add_option_function<std::string>(
            "--roulette",
            [&settings](const std::string& text) {
                if (text == "throughput" || text == "none") {
                    settings.roulette = text == "none" ? Roulette::None : Roulette::Throughput;
                } else {
                    settings.survival = parseSurvival(text);
                    settings.roulette = Roulette::Fixed;
                }
            },
            "How paths end before --bounces: throughput (survive by what they carry), none, or fixed:P (survive with "
            "probability P, 0 < P <= 1, at every bounce but the first; the mean stays right, but the variance is infinite where "
            "albedo^2 >= P: for 0.7 above albedo .837) [throughput]")
        ->type_name("R");
}

}  // namespace

void addSampleOptions(CLI::App& command, RenderSettings& settings, const std::string& sppDefault, const std::string& rangeDefault)
{
    CLI::Option* spp = addNumber<std::uint32_t>(
        command, {"--spp", "N", "Samples per pixel", 1, kMaxSample, sppDefault},
        [&settings](std::uint32_t count) { settings.sampleEnd = count; });
    CLI::Option* time = addNumber<double>(
        command,
        {"--time", "SECONDS", "Sample for this long and until the pass under way ends; with --samples to its end at most",
         1e-3, 1e9, "off"},
        [&settings](double seconds) { settings.seconds = seconds; });
    CLI::Option* samples = command
                               .add_option_function<std::string>(
                                   "--samples",
                                   [&settings](const std::string& text) {
                                       std::tie(settings.sampleBegin, settings.sampleEnd) = parseRange(text);
                                   },
                                   "Absolute sample indices BEGIN to END - 1, for `glim merge`, 0 to " +
                                       std::to_string(kMaxSample) + " [" + rangeDefault + "]")
                               ->type_name("BEGIN:END");
    spp->excludes(time)->excludes(samples);
    addSamplerOptions(command, settings);
}

void addSamplerOptions(CLI::App& command, RenderSettings& settings)
{
    addNumber<std::uint32_t>(
        command, {"--seed", "N", "Same seed, same bits", 0, std::numeric_limits<std::uint32_t>::max(), "0"},
        [&settings](std::uint32_t seed) { settings.seed = seed; });
    addEnum(command, "--sampler", "S", "sobol (Owen-scrambled) or independent [sobol; independent with --adaptive course]",
            {"sobol", "independent"}, settings.sampler);
}

void addLightOptions(CLI::App& command, RenderSettings& settings)
{
    addNumber<std::uint32_t>(
        command, {"--bounces", "N", "Most surface events between camera and light; 0 is emission only", 0, 1000000, "64"},
        [&settings](std::uint32_t bounces) { settings.bounces = bounces; });
    addEnum(command, "--direct", "D",
            "How a hit finds light: mis (one light and the scattered ray, weighted), lights (every light), hemisphere (uniform "
            "directions) or bsdf (the scattered ray alone); point, spot and directional lights are sampled in all [mis]",
            {"mis", "lights", "hemisphere", "bsdf"}, settings.direct);
    addNumber<std::uint32_t>(
        command,
        {"--light-samples", "N",
         "Samples per light and hit with --direct lights (point, spot and directional lights take one), directions per hit with "
         "--direct hemisphere",
         1, 65536, "1"},
        [&settings](std::uint32_t count) { settings.lightSamples = count; });
    addEnum(command, "--paths", "PART",
            "The light to keep: all, or what has met none (emission), one (direct), or two surfaces and more (indirect) [all]",
            {"all", "emission", "direct", "indirect"}, settings.paths);
    addRoulette(command, settings);
    addNumber<float>(command,
                     {"--clamp-indirect", "X",
                      "Scale down light that met two surfaces or more to at most this radiance, W/(sr m^2); a bias, whose "
                      "energy is reported",
                      1e-30F, 1e30F, "off"},
                     [&settings](float limit) { settings.clampIndirect = limit; });
}

void addAdaptiveOptions(CLI::App& command, RenderSettings& settings)
{
    addEnum(command, "--adaptive", "RULE",
            "neighbours: half of the samples everywhere (the first 64 in any case), the others in proportion to the standard "
            "deviation that those have in the 48 pixels around, relative to their radiance (neighbours:absolute: as it is, for "
            "--target-rmse); --spp is the mean over pixels [256]. Either way new samples of one pixel in a hundred tell what bias "
            "there is. course: look at each pixel after every --batch of its n samples, and stop it once "
            "1.96 s / sqrt(n) <= T m, where m and s are mean and standard deviation of their luminance (Berkeley, CS 184). A bias: "
            "pixels stop where they happen to look calm, mostly too dark: by 1.7 % of the light of a room with mirror and glass "
            "(earlier experiments: 1 to 4 %), by less than .3 % in diffuse rooms. Pixels without any variance go on to 1024 samples "
            "unless no surface is in sight; course:literal stops them at once, and may leave them black [off]",
            {"off", "course", "course:literal", "neighbours", "neighbours:absolute"}, settings.adaptive);
    addNumber<float>(command, {"--tolerance", "T", "Of --adaptive course, relative to the mean", 1e-30F, 1e6F, "0.05"},
                     [&settings](float tolerance) { settings.tolerance = tolerance; });
    addNumber<std::uint32_t>(command, {"--batch", "N", "Samples between two looks of --adaptive course", 2, 1048576, "32"},
                             [&settings](std::uint32_t count) { settings.batch = count; });
    addNumber<std::uint32_t>(command, {"--max-spp", "N", "Most samples per pixel of --adaptive course", 2, kMaxSample, "2048"},
                             [&settings](std::uint32_t count) { settings.sampleEnd = count; });
}

void addTracingOptions(CLI::App& command, RenderSettings& settings, SplitRule& split)
{
    addEnum(command, "--accelerator", "A",
            "bvh, or none: every primitive against every ray, 8192 a dispatch [bvh]", {"bvh", "none"}, settings.accelerator);
    addEnum(command, "--schedule", "S",
            "wavefront (a kernel for each step of all paths) or persistent (one kernel that traces path after path to its end; not "
            "with --accelerator none, nor where --direct takes more than one shadow ray per hit): the same bits. auto: the faster one, as "
            "the first long render on the device measured it and the cache folder keeps it (until then persistent on a software "
            "device); a preview's is wavefront, which ends sooner when the view moves [auto]",
            {"auto", "wavefront", "persistent"}, settings.schedule);
    addEnum(command, "--split", "RULE",
            "Where the BVH divides its nodes: sah (surface-area heuristic; of pieces of large triangles, where they make the tree "
            "cheaper by a tenth), mean or median of the centres along the longest axis [sah]",
            {"sah", "mean", "median"}, split);
    addEnum(command, "--intersector", "I",
            "watertight (Woop 2013) or moller-trumbore (the textbook test; leaks at edges) [watertight]",
            {"watertight", "moller-trumbore"}, settings.intersector);
}

}  // namespace glim
