// The command line refuses before it does any work, says why in one sentence, and leaves no file behind.
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

namespace glim::test {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

// One line "glim: ..." on stderr that contains `part`, nothing on stdout.
void expectSentence(const GlimRun& run, int exitCode, const std::string& part)
{
    EXPECT_EQ(run.exitCode, exitCode) << run.err;
    EXPECT_EQ(run.err.rfind("glim: ", 0), 0U) << run.err;
    EXPECT_TRUE(contains(run.err, part)) << run.err << "lacks: " << part;
    EXPECT_EQ(countLines(run.err), 1U) << run.err;
    EXPECT_EQ(run.out, "");
}

// A mistake in the command itself: a second line points to --help.
void expectUsage(const GlimRun& run, const std::string& part)
{
    EXPECT_EQ(run.exitCode, 2) << run.err;
    EXPECT_EQ(run.err.rfind("glim: ", 0), 0U) << run.err;
    EXPECT_TRUE(contains(run.err, part)) << run.err << "lacks: " << part;
    EXPECT_TRUE(contains(run.err, "\nRun with --help")) << run.err;
    EXPECT_EQ(countLines(run.err), 2U) << run.err;
    EXPECT_EQ(run.out, "");
}

TEST(CommandLineTest, VersionNamesCommitAndBuild)
{
    const GlimRun run = runGlim({"--version"});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_EQ(run.out.rfind("glim ", 0), 0U) << run.out;
    EXPECT_TRUE(contains(run.out, "(commit ")) << run.out;
    EXPECT_TRUE(contains(run.out, " build)")) << run.out;
    EXPECT_EQ(countLines(run.out), 1U);
    EXPECT_EQ(run.err, "");
}

const std::vector<std::string> kCommands{"render", "serve", "preview", "view", "inspect", "devices", "compare", "bench", "merge"};

std::vector<std::string> splitLines(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

// The long name of every option that a help text lists, as in "--output".
std::set<std::string> optionsIn(const std::string& help)
{
    static const std::regex kOption(R"(  (?:-\w,)?(--[a-z-]+).*)");
    std::set<std::string> options;
    std::smatch match;
    for (const std::string& line : splitLines(help)) {
        if (std::regex_match(line, match, kOption)) {
            EXPECT_TRUE(options.insert(match[1]).second) << match[1] << " stands twice";
        }
    }
    return options;
}

std::vector<std::string> groupsIn(const std::string& help)
{
    std::vector<std::string> groups;
    for (const std::string& line : splitLines(help)) {
        if (!line.empty() && line[0] != ' ' && line.back() == ':') {
            groups.push_back(line.substr(0, line.size() - 1));
        }
    }
    return groups;
}

std::string helpOf(const std::string& command, const std::string& option)
{
    const GlimRun run = runGlim({command, option});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_EQ(run.err, "");
    return run.out;
}

// Every name that the sources give to an option.
std::set<std::string> optionsInSources()
{
    static const std::regex kName(R"re("(?:-\w,)?(--[a-z-]+)")re");
    std::set<std::string> names;
    for (const char* folder : {"host/cli", "host/job"}) {
        for (const auto& entry : fs::directory_iterator(fs::path(GLIM_SOURCE_DIR) / folder)) {
            if (entry.path().extension() == ".cpp") {
                const std::string text = readFileBytes(entry.path());
                for (std::sregex_iterator i(text.begin(), text.end(), kName), end; i != end; ++i) {
                    names.insert((*i)[1]);
                }
            }
        }
    }
    return names;
}

TEST(CommandLineTest, HelpAllListsEveryOptionOnALineOfItsOwn)
{
    std::set<std::string> listed;
    for (const std::string& command : kCommands) {
        const std::string all = helpOf(command, "--help-all");
        for (const std::string& line : splitLines(all)) {
            EXPECT_LE(line.size(), 110U) << command << ": " << line;
        }
        listed.merge(optionsIn(all));
    }
    listed.merge(optionsIn(runGlim({"--help"}).out));
    EXPECT_EQ(listed, optionsInSources());
    EXPECT_GT(listed.size(), 50U);
}

TEST(CommandLineTest, HelpLeavesTuningAndTheCourseToHelpAll)
{
    const auto countGroups = [](const std::string& command, bool course) {
        std::vector<std::string> groups{"Picture", "Camera", "Sampling and stopping", "Light transport", "Device", "Output", "Help"};
        if (course) {
            groups.insert(groups.begin() + 4, "Course estimators (Berkeley CS 184)");
        }
        if (command == "render") {
            groups.insert(groups.begin() + 2, "Several pictures");
        }
        return groups;
    };
    const std::set<std::string> course{"--direct", "--light-samples", "--roulette", "--tolerance", "--batch", "--max-spp"},
        tuning{"--schedule", "--path-capacity", "--accelerator", "--split", "--intersector"};
    for (const std::string command : {"render", "preview", "bench"}) {
        const std::string help = helpOf(command, "--help"), all = helpOf(command, "--help-all");
        EXPECT_EQ(groupsIn(help), countGroups(command, false)) << command;
        EXPECT_EQ(groupsIn(all), countGroups(command, true)) << command;
        std::set<std::string> shown = optionsIn(help), expected = optionsIn(all);
        for (const auto& hidden : {course, tuning}) {
            for (const std::string& option : hidden) {
                expected.erase(option);
            }
        }
        EXPECT_EQ(shown, expected) << command;
    }
}

TEST(CommandLineTest, HelpNamesCommandsUnitsRangesAndDefaults)
{
    const std::string all = runGlim({"--help"}).out;
    for (const std::string& command : kCommands) {
        EXPECT_TRUE(std::regex_search(all, std::regex("\n  " + command + " +[A-Z]"))) << command;
    }
    const std::string render = helpOf("render", "--help-all");
    for (const char* line : {R"(\nUsage: glim render \[OPTIONS\] SCENE\n)", R"(\n  -o,--output OUT\.exr +[A-Z])",
                             R"(\n  --spp N +Samples per pixel, 1 to 2147483648 \[64;)", R"(\n  --zoom Z .*, 1e-06 to 1e\+06 \[1\]\n)",
                             R"(\n  --clamp-indirect X .*, 1e-30 to 1e\+30 \[off\]\n)"}) {
        EXPECT_TRUE(std::regex_search(render, std::regex(line))) << line << "\n" << render;
    }
}

// What the help has no room for.
TEST(CommandLineTest, TheReadmeExplainsEveryOption)
{
    const std::string text = readFileBytes(fs::path(GLIM_SOURCE_DIR) / "host/cli/README.md");
    for (const std::string& option : optionsInSources()) {
        EXPECT_TRUE(std::regex_search(text, std::regex("`" + option + "[ `,]"))) << option;
    }
}

TEST(CommandLineTest, CommandsAndOptionsThatDoNotExist)
{
    expectUsage(runGlim(Arguments{}), "subcommand is required");
    expectUsage(runGlim({"rendre", "x.gltf"}), "\"rendre\" was not expected");
    expectUsage(runGlim({"render", "--fast"}), "\"--fast\" was not expected");
    expectUsage(runGlim({"render", "x.gltf", "-o", "x.exr", "y.gltf"}), "\"y.gltf\" was not expected");
    expectUsage(runGlim({"render"}), "SCENE is required");
    for (const char* flag : {"--confine=abc", "--denoise=maybe"}) {
        expectUsage(runGlim({"render", "x.gltf", "-o", "x.exr", flag}), std::string(flag).substr(0, std::string(flag).find('=')));
    }
    expectUsage(runGlim({"render", "x.gltf", "-o", "x.exr", "--spp", "4", "--spp", "5"}), "--spp");
    expectUsage(runGlim({"render", "x.gltf"}), "--output is required");
    expectUsage(runGlim({"merge", "x.exr"}), "--output is required");
    expectUsage(runGlim({"compare", "x.exr"}), "reference is required");
}

// Each of `cases` after "render SCENE -o x.exr": the options, and a part of the complaint about them.
void expectUsageBeforeWork(const std::vector<std::pair<Arguments, std::string>>& cases)
{
    const ScratchFolder folder;
    for (const auto& [options, part] : cases) {
        // The scene does not exist: a complaint about it would be work done before the value was looked at.
        Arguments arguments{"render", "no-such-scene.gltf", "-o", (folder / "x.exr").string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectUsage(runGlim(arguments), part);
        EXPECT_EQ(folder.entries(), 0);
    }
}

TEST(CommandLineTest, NonsenseValuesAreUsageErrorsBeforeAnyWork)
{
    const std::string whole = "expected a whole number from ", number = "expected a number from ";
    const std::vector<std::pair<Arguments, std::string>> cases{
        {{"--spp", "0"}, "--spp: \"0\": " + whole + "1 to 2147483648"},
        {{"--spp", "1.5"}, whole},
        {{"--spp", "0x10"}, whole},
        {{"--spp", "2147483649"}, whole},
        {{"--spp", "1", "--spp", "2"}, "--spp"},
        {{"--spp", "4", "--time", "1"}, "--spp excludes --time"},
        {{"--spp", "4", "--samples", "0:4"}, "--spp excludes --samples"},
        {{"--time", "nan"}, "--time: \"nan\": " + number},
        {{"--time", "0"}, number},
        {{"--exposure", "nan"}, "--exposure: \"nan\": " + number + "-100 to 100, or auto"},
        {{"--clamp-indirect", "nan"}, number},
        {{"--clamp-indirect", "0"}, number},
        {{"--seed", "-1"}, "--seed: \"-1\": " + whole + "0 to 4294967295"},
        {{"--seed", "4294967296"}, whole},
        {{"--bounces", "-1"}, whole},
        {{"--scene", "-1"}, whole},
        {{"--size", "0x5"}, "--size: \"0x5\": expected WIDTHxHEIGHT"},
        {{"--size", "64"}, "expected WIDTHxHEIGHT"},
        {{"--size", "70000x1"}, "each 1 to 65535"},
        {{"--samples", "7:5"}, "--samples: \"7:5\": expected BEGIN:END"},
        {{"--samples", "0:2147483649"}, "END <= 2147483648"},
        {{"--environment", "sky.png"}, "--environment: \"sky.png\": expected the name of a .hdr or .exr map"},
        {{"--environment", "1,-1,0"}, "numbers >= 0"},
        {{"--environment", "1,inf,0"}, "numbers >= 0"},
        {{"--environment-rotation", "400"}, number + "-360 to 360"},
        {{"--environment-background", "maybe"}, "expected off or on"},
        {{"--missing-textures", "pink"}, "expected refuse or grey"},
        {{"--sampler", "halton"}, "--sampler: \"halton\": expected sobol or independent"},
        {{"--intersector", "fast"}, "expected watertight or moller-trumbore"},
        {{"--progress", "loud"}, "expected bar or json or none"},
        {{"--png"}, "--png"}};
    expectUsageBeforeWork(cases);
}

// A few: host/render_job_test.cpp has them all.
TEST(CommandLineTest, OptionsThatDoNotGoTogetherAreUsageErrorsBeforeAnyWork)
{
    expectUsageBeforeWork({{{"--direct", "light"}, "--direct: \"light\": expected mis or "},
                           {{"--light-samples", "65537"}, "--light-samples: \"65537\": expected "},
                           {{"--roulette", "fixed:1.2"}, "--roulette: \"fixed:1.2\": expected "},
                           {{"--accelerator", "kd-tree"}, "--accelerator: \"kd-tree\": expected bvh or none"},
                           {{"--adaptive", "on"}, "--adaptive: \"on\": expected off or "},
                           {{"--adaptive", "course", "--tolerance", "0"}, "--tolerance: \"0\": expected a number from "},
                           {{"--adaptive", "course", "--spp", "64"}, "--spp: \"64\": "},
                           {{"--view", "normals"}, "--view: \"normals\": expected shaded or "},
                           {{"--lens-radius", "0.1"}, "--lens-radius requires --focal-distance"},
                           {{"--look-from", "0,0,1"}, "--look-from requires --look-at"},
                           {{"--look-up", "0,0,1"}, "--look-up requires --look-from"},
                           {{"--look-from", "0,0", "--look-at", "0,0,0"}, "--look-from: \"0,0\": expected "},
                           {{"--look-from", "0,0,nan", "--look-at", "0,0,0"}, "--look-from: \"0,0,nan\": expected "}});
}

TEST(CommandLineTest, OutputsThatCannotBeWrittenAreRefusedBeforeAnyWork)
{
    const ScratchFolder folder;
    fs::create_directory(folder / "folder.exr");
    writeText(folder / "file", "");
    const std::string good = (folder / "x.exr").string();
    const std::vector<std::pair<Arguments, std::string>> cases{
        {{"-o", ""}, "empty file name"},
        {{"-o", (folder / "x.png").string()}, "x.png: cannot be written: its name does not end in .exr"},
        {{"-o", (folder / "none/x.exr").string()}, "does not exist"},
        {{"-o", (folder / "file/x.exr").string()}, "is not a folder"},
        {{"-o", (folder / "folder.exr").string()}, "it is a folder"},
        {{"-o", "/proc/x.exr"}, "/proc/x.exr: cannot be written"},  // root may write there by its permission bits
        {{"-o", good, "--png", (folder / "none/x.png").string()}, "does not exist"},
        {{"-o", good, "--rates", (folder / "x.jpg").string()}, "does not end in .png"},
        {{"-o", good, "--rates", (folder / "none/x.png").string()}, "does not exist"},
        {{"-o", good, "--ids", (folder / "x.png").string()}, "does not end in .exr"},
        {{"-o", good, "--ids", (folder / "none/x.exr").string()}, "does not exist"},
        {{"-o", good, "--stats", (folder / "x.txt").string()}, "does not end in .json"},
        {{"-o", good, "--stats", (folder / "none/x.json").string()}, "does not exist"}};
    for (const auto& [options, part] : cases) {
        Arguments arguments{"render", "no-such-scene.gltf"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectSentence(runGlim(arguments), 1, part);
        EXPECT_EQ(folder.entries(), 2);
    }
    expectSentence(runGlim({"merge", "a.exr", "-o", "/proc/x.exr"}), 1, "/proc/x.exr: cannot be written");
    expectSentence(runGlim({"compare", "a.exr", "b.exr", "--diff", "/proc/x.exr"}), 1, "/proc/x.exr: cannot be written");
}

TEST(CommandLineTest, InputsAreNeverOverwritten)
{
    const ScratchFolder folder;
    const fs::path scene = folder / "scene.exr", stats = folder / "scene.json";
    fs::copy_file(sceneFile("cornell.gltf"), scene);
    fs::copy_file(sceneFile("cornell.gltf"), stats);
    fs::create_symlink(scene, folder / "link.exr");
    const std::string bytes = readFileBytes(scene);
    const Arguments small{"--size", "4x4", "--spp", "1"};
    for (const Arguments& options :
         {Arguments{scene.string(), "-o", scene.string()}, Arguments{scene.string(), "-o", (folder / "link.exr").string()},
          Arguments{stats.string(), "-o", (folder / "x.exr").string(), "--stats", stats.string()}}) {
        Arguments arguments{"render"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        arguments.insert(arguments.end(), small.begin(), small.end());
        expectSentence(runGlim(arguments), 1, "it is the input");
    }
    EXPECT_EQ(readFileBytes(scene), bytes);
    EXPECT_EQ(readFileBytes(stats), bytes);
    const std::string film = (folder / "film.exr").string();
    ASSERT_EQ(runGlim({"render", scene.string(), "-o", film, "--size", "4x4", "--spp", "1"}).exitCode, 0);
    expectSentence(runGlim({"compare", film, film, "--diff", film}), 1, "it is the input");
}

TEST(CommandLineTest, RefusedScenesLeaveTheTargetAsItWas)
{
    const ScratchFolder folder;
    const std::string target = (folder / "x.exr").string();
    int files = 0;
    for (const auto& entry : fs::directory_iterator(sceneFile("refused"))) {
        ++files;
        expectSentence(runGlim({"render", entry.path().string(), "-o", target, "--size", "4x4", "--spp", "1"}), 1,
                       entry.path().filename().string() + ": ");
        EXPECT_EQ(folder.entries(), 0) << entry.path();
    }
    EXPECT_GT(files, 0);
    writeText(target, "what was here before");
    for (const std::string& scene : {sceneFile("none.gltf"), sceneFile("refused/not_json.gltf"), sceneFile("")}) {
        expectSentence(runGlim({"render", scene, "-o", target}), 1, scene + ": ");
    }
    EXPECT_EQ(readFileBytes(target), "what was here before");
    EXPECT_EQ(folder.entries(), 1);
    expectSentence(runGlim({"inspect", sceneFile("refused/not_json.gltf")}), 1, "not JSON: syntax error at byte 30.\n");
    expectSentence(runGlim({"inspect", ""}), 1, "A file name is empty; expected that of a .gltf or a .glb file.\n");
}

TEST(CommandLineTest, UnknownNamesAreRefusedWithThoseOfTheScene)
{
    const ScratchFolder folder;
    const Arguments render{"render", sceneFile("cornell.gltf"), "-o", (folder / "x.exr").string()};
    const auto with = [&](const std::string& option, const std::string& value) {
        Arguments arguments = render;
        arguments.insert(arguments.end(), {option, value});
        return runGlim(arguments);
    };
    expectSentence(with("--camera", "rear"), 1, "camera \"rear\": expected one of 0 \"front\"");
    expectSentence(with("--camera", "1"), 1, "camera \"1\": expected one of 0 \"front\"");
    expectSentence(with("--scene", "1"), 1, "scene 1 was asked for; expected one below 1");
    expectSentence(with("--device", "no such device"), 1, "--device no such device: no such device; there are: 0 \"");
    for (const std::string digit : {"", "5", "6", "7", "8", "9"}) {  // most of which are in the name of some device
        expectSentence(with("--device", digit), 1, "--device " + digit + ": no such device");
    }
    expectSentence(with("--size", "65535x65535"), 1, "cornell.gltf: the scene and a picture of 65535x65535 need ");
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace glim::test
