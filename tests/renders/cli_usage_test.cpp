// The command line refuses before it does any work, says why in one sentence, and leaves no file behind.
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

namespace glim::test {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

using Id = MessageId;

constexpr int kBadInput = 1, kUsage = 2;  // exit codes

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
    const auto expect = [](const Arguments& arguments, MessageId id, const Parts& parts) {
        expectRefused(runForMessages(arguments), kUsage, id, parts);
    };
    expect({}, Id::Missing, {.place = "command"});
    expect({"render", "--fast"}, Id::UnknownName, {.value = "--fast"});
    expect({"render", "x.gltf", "-o", "x.exr", "y.gltf"}, Id::UnknownName, {.value = "y.gltf"});
    expect({"render"}, Id::Missing, {.place = "SCENE"});
    expect({"render", "x.gltf", "-o", "x.exr", "--confine=abc"}, Id::WrongType, {.place = "--confine", .value = "abc"});
    expect({"render", "x.gltf", "-o", "x.exr", "--denoise=maybe"}, Id::WrongType, {.place = "--denoise", .value = "maybe"});
    expect({"render", "x.gltf", "-o", "x.exr", "--spp", "4", "--spp", "5"}, Id::Duplicate, {.place = "--spp"});
    expect({"render", "x.gltf"}, Id::Missing, {.place = "--output"});
    for (const char* name : {"", "x", "x.tif", ".exr"}) {
        expect({"render", "x.gltf", "-o", name}, Id::UnknownFormat,
               {.place = "--output", .value = name, .expected = ".exr, or a picture's"});
        expect({"merge", "a.exr", "-o", name}, Id::UnknownFormat, {.place = "--output", .value = name});
    }
    const std::string scene = sceneFile("cornell.gltf");
    expect({"render", scene, "-o", "x.exr", "--rates", "x.jpg"}, Id::UnknownFormat, {.file = "x.jpg", .expected = ".png"});
    expect({"render", scene, "-o", "x.exr", "--ids", "x.png"}, Id::UnknownFormat, {.file = "x.png", .expected = ".exr"});
    expect({"render", scene, "-o", "x.exr", "--stats", "x.txt"}, Id::UnknownFormat, {.file = "x.txt", .expected = ".json"});
    expect({"compare", "a.exr", "b.exr", "--diff", "x.png"}, Id::UnknownFormat, {.file = "x.png", .expected = ".exr"});
    expect({"merge", "x.exr"}, Id::Missing, {.place = "--output"});
    expect({"compare", "x.exr"}, Id::Missing, {.place = "reference"});
}

TEST(CommandLineTest, AMistypedWordGetsTheOneThatWasMeant)
{
    const auto expectMeant = [](const Arguments& arguments, const std::string& value, const std::string& meant) {
        expectRefused(runForMessages(arguments), kUsage, Id::UnknownName, {.value = value, .expected = meant});
    };
    expectMeant({"rendre", "x.gltf"}, "rendre", "render");
    expectMeant({"inpsect", "x.gltf"}, "inpsect", "inspect");
    expectMeant({"Model.GLB", "-o", "x.exr"}, "Model.GLB", "render Model.GLB");
    expectMeant({"render", "x.gltf", "--ssp", "4"}, "--ssp", "--spp");
    expectMeant({"render", "x.gltf", "--out=x.exr"}, "--out=x.exr", "--output");
    expectMeant({"render", "x.gltf", "--enviroment", "studio"}, "--enviroment", "--environment");
    expectMeant({"merge", "x.exr", "--imgae", "x.png"}, "--imgae", "--image");
    for (const char* far : {"--fast", "--e", "--s"}) {
        const GlimRun run = runGlim({"render", "x.gltf", far});
        EXPECT_EQ(run.exitCode, kUsage);
        EXPECT_FALSE(contains(run.err, "did you mean")) << run.err;
    }
    EXPECT_EQ(runGlim({"render", "x.gltf", "--ssp=4"}).err,
              "glim: \"--ssp=4\" was not expected; did you mean --spp?\nRun with --help for more information.\n");
}

TEST(CommandLineTest, PeopleReadALineAndWhereToFindHelp)
{
    const GlimRun usage = runGlim({"render", "x.gltf", "-o", "x.exr", "--spp", "0"});
    EXPECT_EQ(usage.exitCode, kUsage);
    EXPECT_EQ(usage.err, "glim: --spp: \"0\": expected a whole number from 1 to 2147483648\nRun with --help for more information.\n");
    EXPECT_EQ(usage.out, "");
    const GlimRun input = runGlim({"inspect", sceneFile("refused/not_json.gltf")});
    EXPECT_EQ(input.exitCode, kBadInput);
    EXPECT_EQ(input.err, "glim: " + sceneFile("refused/not_json.gltf") + ": not JSON: syntax error at byte 30.\n");
    EXPECT_EQ(input.out, "");
}

struct Refused {
    Arguments options;
    MessageId id;
    Parts parts;
};

// Each of `cases` after "render SCENE -o x.exr".
void expectUsageBeforeWork(const std::vector<Refused>& cases)
{
    const ScratchFolder folder;
    for (const auto& [options, id, parts] : cases) {
        SCOPED_TRACE(options.back());
        // The scene does not exist: a complaint about it would be work done before the value was looked at.
        Arguments arguments{"render", "no-such-scene.gltf", "-o", (folder / "x.exr").string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectRefused(runForMessages(arguments), kUsage, id, parts);
        EXPECT_EQ(folder.entries(), 0);
    }
}

// The last two of `options` are the option that is refused and its value.
Refused refusedFor(MessageId id, const Arguments& options, const std::string& expected = "")
{
    return {options, id, {.place = *(options.end() - 2), .value = options.back(), .expected = expected}};
}

TEST(CommandLineTest, NonsenseValuesAreUsageErrorsBeforeAnyWork)
{
    const auto bad = [](MessageId id, const std::string& option, const std::string& value, const std::string& expected = "") {
        return refusedFor(id, {option, value}, expected);
    };
    expectUsageBeforeWork({bad(Id::OutOfRange, "--spp", "0", "1 to 2147483648"),
                           bad(Id::Malformed, "--spp", "1.5"),
                           bad(Id::Malformed, "--spp", "0x10"),
                           bad(Id::OutOfRange, "--spp", "2147483649"),
                           {{"--spp", "1", "--spp", "2"}, Id::Duplicate, {.place = "--spp"}},
                           {{"--spp", "4", "--time", "1"}, Id::Conflict, {.place = "--spp", .value = "--time"}},
                           {{"--spp", "4", "--samples", "0:4"}, Id::Conflict, {.place = "--spp", .value = "--samples"}},
                           bad(Id::OutOfRange, "--time", "nan"),
                           bad(Id::OutOfRange, "--time", "0"),
                           bad(Id::OutOfRange, "--time", "-5m"),
                           bad(Id::OutOfRange, "--time", "1e30h"),
                           bad(Id::Malformed, "--time", "5 min", "90, 5m or 1h"),
                           bad(Id::Malformed, "--target-rmse", "1", "1%, with its sign"),
                           bad(Id::OutOfRange, "--target-rmse", "0%", "as in 1%"),
                           bad(Id::OutOfRange, "--exposure", "nan", "-100 to 100, or auto"),
                           bad(Id::OutOfRange, "--clamp-indirect", "nan"),
                           bad(Id::OutOfRange, "--clamp-indirect", "0"),
                           bad(Id::OutOfRange, "--seed", "-1", "0 to 4294967295"),
                           bad(Id::OutOfRange, "--seed", "4294967296"),
                           bad(Id::OutOfRange, "--bounces", "-1"),
                           bad(Id::OutOfRange, "--scene", "-1"),
                           bad(Id::OutOfRange, "--size", "0x5", "WIDTHxHEIGHT"),
                           bad(Id::Malformed, "--size", "64", "WIDTHxHEIGHT"),
                           bad(Id::OutOfRange, "--size", "70000x1", "1 to 65535"),
                           bad(Id::OutOfRange, "--samples", "7:5", "BEGIN < END"),
                           bad(Id::OutOfRange, "--samples", "0:2147483649", "END <= 2147483648"),
                           bad(Id::Malformed, "--environment", "sky.png", ".hdr or .exr"),
                           bad(Id::OutOfRange, "--environment", "1,-1,0", ">= 0"),
                           bad(Id::Malformed, "--environment", "1,inf,0", ">= 0"),
                           bad(Id::OutOfRange, "--environment-rotation", "400", "-360 to 360"),
                           bad(Id::UnknownName, "--environment-background", "maybe", "off or on"),
                           bad(Id::UnknownName, "--missing-textures", "pink", "refuse or grey"),
                           bad(Id::UnknownName, "--sampler", "halton", "sobol or independent"),
                           bad(Id::UnknownName, "--intersector", "fast", "watertight or moller-trumbore"),
                           bad(Id::UnknownName, "--progress", "loud", "bar or json or none"),
                           {{"--png"}, Id::Missing, {.place = "--png"}}});
}

// A few: host/render_job_test.cpp has them all.
TEST(CommandLineTest, OptionsThatDoNotGoTogetherAreUsageErrorsBeforeAnyWork)
{
    expectUsageBeforeWork({refusedFor(Id::UnknownName, {"--direct", "light"}, "mis or "),
                           refusedFor(Id::OutOfRange, {"--light-samples", "65537"}),
                           refusedFor(Id::OutOfRange, {"--roulette", "fixed:1.2"}),
                           refusedFor(Id::UnknownName, {"--accelerator", "kd-tree"}, "bvh or none"),
                           refusedFor(Id::UnknownName, {"--adaptive", "on"}, "off or "),
                           refusedFor(Id::OutOfRange, {"--adaptive", "course", "--tolerance", "0"}),
                           refusedFor(Id::Conflict, {"--adaptive", "course", "--spp", "64"}, "--max-spp"),
                           refusedFor(Id::UnknownName, {"--view", "normals"}, "shaded or "),
                           {{"--lens-radius", "0.1"}, Id::Requires, {.place = "--lens-radius", .expected = "--focal-distance"}},
                           {{"--look-from", "0,0,1"}, Id::Requires, {.place = "--look-from", .expected = "--look-at"}},
                           {{"--look-up", "0,0,1"}, Id::Requires, {.place = "--look-up", .expected = "--look-from"}},
                           refusedFor(Id::Malformed, {"--look-at", "0,0,0", "--look-from", "0,0"}),
                           refusedFor(Id::Malformed, {"--look-at", "0,0,0", "--look-from", "0,0,nan"})});
}

TEST(CommandLineTest, OutputsThatCannotBeWrittenAreRefusedBeforeAnyWork)
{
    const ScratchFolder folder;
    fs::create_directory(folder / "folder.exr");
    writeText(folder / "file", "");
    const std::string good = (folder / "x.exr").string();
    // The last of the options is the file that is refused.
    const auto bad = [](MessageId id, const Arguments& options, const std::string& expected = "") {
        return Refused{options, id, {.file = options.back(), .expected = expected}};
    };
    const std::vector<Refused> cases{bad(Id::FileMissing, {"-o", (folder / "none/x.exr").string()}),
                                     bad(Id::WrongType, {"-o", (folder / "file/x.exr").string()}, "a folder"),
                                     bad(Id::WrongType, {"-o", (folder / "folder.exr").string()}),
                                     bad(Id::FileUnwritable, {"-o", "/proc/x.exr"}),  // root may write there by its permission bits
                                     bad(Id::FileMissing, {"-o", good, "--png", (folder / "none/x.png").string()}),
                                     bad(Id::FileMissing, {"-o", good, "--rates", (folder / "none/x.png").string()}),
                                     bad(Id::FileMissing, {"-o", good, "--ids", (folder / "none/x.exr").string()}),
                                     bad(Id::FileMissing, {"-o", good, "--stats", (folder / "none/x.json").string()})};
    for (const auto& [options, id, parts] : cases) {
        SCOPED_TRACE(options.back());
        Arguments arguments{"render", "no-such-scene.gltf"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expectRefused(runForMessages(arguments), kBadInput, id, parts);
        EXPECT_EQ(folder.entries(), 2);
    }
    const Parts unwritable{.file = "/proc/x.exr"};
    expectRefused(runForMessages({"merge", "a.exr", "-o", "/proc/x.exr"}), kBadInput, Id::FileUnwritable, unwritable);
    expectRefused(runForMessages({"compare", "a.exr", "b.exr", "--diff", "/proc/x.exr"}), kBadInput, Id::FileUnwritable, unwritable);
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
        expectRefused(runForMessages(arguments), kBadInput, Id::Conflict, {.file = options.back(), .value = options.front()});
    }
    EXPECT_EQ(readFileBytes(scene), bytes);
    EXPECT_EQ(readFileBytes(stats), bytes);
    const std::string film = (folder / "film.exr").string();
    ASSERT_EQ(runGlim({"render", scene.string(), "-o", film, "--size", "4x4", "--spp", "1"}).exitCode, 0);
    expectRefused(runForMessages({"compare", film, film, "--diff", film}), kBadInput, Id::Conflict, {.file = film, .value = film});
}

TEST(CommandLineTest, RefusedScenesLeaveTheTargetAsItWas)
{
    const ScratchFolder folder;
    const std::string target = (folder / "x.exr").string();
    int files = 0;
    for (const auto& entry : fs::directory_iterator(sceneFile("refused"))) {
        ++files;
        const GlimRun run = runGlim({"render", entry.path().string(), "-o", target, "--size", "4x4", "--spp", "1"});
        EXPECT_EQ(run.exitCode, kBadInput) << run.err;
        EXPECT_TRUE(run.err.starts_with("glim: " + entry.path().string() + ": ")) << run.err;
        EXPECT_EQ(countLines(run.err), 1U) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(folder.entries(), 0) << entry.path();
    }
    EXPECT_GT(files, 0);
    writeText(target, "what was here before");
    for (const auto& [scene, id] : {std::pair(sceneFile("none.gltf"), Id::FileMissing),
                                    {sceneFile("refused/not_json.gltf"), Id::Malformed},
                                    {sceneFile(""), Id::WrongType}}) {
        expectRefused(runForMessages({"render", scene, "-o", target}), kBadInput, id, {.file = scene});
    }
    EXPECT_EQ(readFileBytes(target), "what was here before");
    EXPECT_EQ(folder.entries(), 1);
    expectRefused(runForMessages({"inspect", sceneFile("refused/not_json.gltf")}), kBadInput, Id::Malformed, {.value = "30"});
    expectRefused(runForMessages({"inspect", ""}), kBadInput, Id::Missing, {.expected = ".gltf"});
}

TEST(CommandLineTest, UnknownNamesAreRefusedWithThoseOfTheScene)
{
    const ScratchFolder folder;
    const Arguments render{"render", sceneFile("cornell.gltf"), "-o", (folder / "x.exr").string()};
    const auto expect = [&](const std::string& option, const std::string& value, MessageId id, const Parts& parts) {
        Arguments arguments = render;
        arguments.insert(arguments.end(), {option, value});
        expectRefused(runForMessages(arguments), kBadInput, id, parts);
    };
    expect("--camera", "rear", Id::UnknownName, {"cornell.gltf", "camera", "rear", "0 \"front\""});
    expect("--camera", "1", Id::UnknownName, {"cornell.gltf", "camera", "1", "0 \"front\""});
    expect("--scene", "1", Id::DanglingIndex, {"cornell.gltf", "scene", "1", "below 1"});
    expect("--device", "no such device", Id::UnknownName, {.place = "--device", .value = "no such device", .expected = "0 \""});
    for (const std::string digit : {"", "5", "6", "7", "8", "9"}) {  // most of which are in the name of some device
        expect("--device", digit, Id::UnknownName, {.place = "--device", .value = digit});
    }
    expect("--size", "65535x65535", Id::OutOfMemory, {.file = "cornell.gltf"});
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace glim::test
