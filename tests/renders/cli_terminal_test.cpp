// A film comes of a render whatever becomes of those who look at it: on a terminal, a narrow one, one that changes its size or hangs up,
// and with readers that are gone or do not read.
#include "host/render/film_file.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <sstream>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr const char* kRedraw = "\r\x1b[K";

// Each bar as it was drawn.
std::vector<std::string> barsOf(const std::string& shown)
{
    std::vector<std::string> bars;
    for (std::size_t at = shown.find(kRedraw); at != std::string::npos; at = shown.find(kRedraw, at)) {
        at += std::string(kRedraw).size();
        const std::string line = shown.substr(at, shown.find('\r', at) - at);
        if (line.starts_with('[') || line.starts_with("picture ")) {
            bars.push_back(line);
        }
    }
    return bars;
}

bool showsBar(const std::string& shown) { return shown.find("samples/pixel") != std::string::npos; }

class TerminalTest : public ::testing::Test {
protected:
    GlimCall call(const std::vector<std::string>& options, const std::string& output = "x.exr") const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "-o", output, "--size", "16x16"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        return call;
    }
    Film film(const char* name = "x.exr") const { return readFilm(folder_ / name); }
    void expectFilmOf(std::uint32_t samples) const
    {
        EXPECT_EQ(film().sampleRanges.front().second, samples);
        EXPECT_TRUE(film().complete);
        EXPECT_EQ(folder_.entries(), 1);
    }

    ScratchFolder folder_;
};

TEST_F(TerminalTest, EveryStyleOfEveryRenderEndsWithItsFilm)
{
    const std::vector<std::vector<std::string>> kinds{{"--spp", "600"},
                                                      {"--target-rmse", "3%"},
                                                      {"--target-relmse", ".02", "--adaptive", "neighbours"},
                                                      {"--target-rmse", "3%", "--denoise", "--denoised"},
                                                      {"--time", "0.3"},
                                                      {"--adaptive", "course", "--tolerance", ".1", "--max-spp", "256"},
                                                      {"--turntable", "3", "--spp", "64"}};
    for (const std::vector<std::string>& kind : kinds) {
        const bool isSequence = kind[0] == "--turntable";
        for (const char* style : {"", "json", "bar", "none"}) {
            if (kind != kinds[0] && (std::string(style) == "bar" || std::string(style) == "none")) {
                continue;
            }
            SCOPED_TRACE(kind[0] + " " + kind[1] + " " + style);
            std::vector<std::string> options = kind;
            if (*style != '\0') {
                options.insert(options.end(), {"--progress", style});
            }
            const GlimRun run = runOnTerminal(call(options, isSequence ? "x#.exr" : "x.exr"), 200);
            EXPECT_EQ(run.exitCode, 0) << run.out << run.signal;
            film(isSequence ? "x2.exr" : "x.exr");
            EXPECT_EQ(showsBar(run.out), *style == '\0' || std::string(style) == "bar") << run.out;
            for (const std::string& bar : barsOf(run.out)) {
                EXPECT_NE(bar.find(" ETA "), std::string::npos) << bar;
                EXPECT_EQ(bar.find("ETA -"), std::string::npos) << bar;
            }
            std::istringstream lines(run.out);
            for (std::string line; std::getline(lines, line);) {
                if (line.starts_with("{\"picture\"")) {
                    const json progress = json::parse(line);
                    EXPECT_GE(progress.at("done"), 0.0);
                    EXPECT_LE(progress.at("done"), 1.0);
                    for (const char* eta : {"etaSeconds", "allEtaSeconds"}) {
                        EXPECT_TRUE(progress.at(eta).is_null() || progress.at(eta) >= 0.0) << line;
                    }
                }
            }
            for (const char* name : {"x.exr", "x0.exr", "x1.exr", "x2.exr"}) {
                std::filesystem::remove(folder_ / name);
            }
        }
    }
}

TEST_F(TerminalTest, APictureHasTheSameBytesWithoutATerminal)
{
    const std::vector<std::string> options{
        "--spp", "16", "--fov", "60", "--zoom", "0.5", "--environment", "1,1,1", "--environment-background", "off"};
    for (const char* ending : {".png", ".webp", ".jpg"}) {
        const std::string shown = std::string("shown") + ending, piped = std::string("piped") + ending;
        EXPECT_EQ(runOnTerminal(call(options, shown)).exitCode, 0);
        EXPECT_EQ(runGlim(call(options, piped)).exitCode, 0);
        EXPECT_NE(readFileBytes(folder_ / shown.c_str()), "");
        EXPECT_EQ(readFileBytes(folder_ / shown.c_str()), readFileBytes(folder_ / piped.c_str())) << ending;
    }
}

// What a command comes to is the same with a terminal and without: the exit code, and what it says at the end.
TEST_F(TerminalTest, CommandsEndAlikeWithoutATerminal)
{
    struct Command {
        std::vector<std::string> arguments;
        int exitCode;
        const char* said;
    };
    const std::string cornell = sceneFile("cornell.gltf");
    ASSERT_EQ(runGlim(call({"--spp", "64"}, "a.exr")).exitCode, 0);
    ASSERT_EQ(runGlim(call({"--spp", "64", "--environment", "1,1,1"}, "b.exr")).exitCode, 0);
    const Command commands[] = {
        {{"rendr", cornell}, 2, "did you mean render?"},
        {{"render", cornell, "--sizes", "8x8", "-o", "x.png"}, 2, "did you mean --size?"},
        {{"render", cornell, "-o", "x.exr", "--target-rmse", "1"}, 2, "%"},
        {{"render", cornell, "-o", "x.bmp"}, 2, ".png"},
        {{"render", cornell, "-o", "x.png", "--size", "8x8", "--time", "200ms"}, 2, "--time"},
        {{"render", cornell, "-o", "x.png", "--size", "8x8", "--time", ".1s"}, 0, "samples per pixel"},
        {{"render", cornell, "-o", "x.png", "--size", "8x8", "--spp", "8"}, 0, "RMSE at most"},
        {{"render", cornell, "-o", "x.png", "--size", "8x8"}, 0, "denoised: measured RMSE"},
        {{"render", cornell, "-o", "x.png", "--size", "8x8", "--fov", "0"}, 2, "0.01 to 179"},
        {{"compare", "a.exr", "b.exr", "--fail"}, 4, "differ"},
        {{"compare", "a.exr", "a.exr", "--max-rmse", "1%"}, 0, ""},
        {{"compare", "a.exr", "b.exr", "--max-rmse", "1%"}, 4, "1 %"},
        {{"--help"}, 0, "render"},
    };
    for (const Command& command : commands) {
        GlimCall call;
        call.arguments = command.arguments;
        call.folder = folder_.path();
        const GlimRun shown = runOnTerminal(call), piped = runGlim(call);
        const std::string both = command.arguments[0] + " ... " + command.arguments.back();
        EXPECT_EQ(shown.exitCode, command.exitCode) << both << "\n" << shown.out;
        EXPECT_EQ(piped.exitCode, command.exitCode) << both << "\n" << piped.err;
        EXPECT_NE(shown.out.find(command.said), std::string::npos) << both << "\n" << shown.out;
        EXPECT_NE((piped.out + piped.err).find(command.said), std::string::npos) << both << "\n" << piped.out << piped.err;
    }
}

TEST_F(TerminalTest, TheBarFitsATerminalThatChangesItsSize)
{
    bool isNarrow = false;
    std::size_t wide = 0;
    const GlimRun run = runOnTerminal(call({"--time", "1"}), 60, [&](int terminal, const std::string& shown) {
        if (!isNarrow && barsOf(shown).size() > 2) {
            winsize size{};
            size.ws_row = 24;
            size.ws_col = 20;
            ioctl(terminal, TIOCSWINSZ, &size);  // the kernel sends SIGWINCH
            isNarrow = true;
            wide = barsOf(shown).size() + 1;  // one may be on its way
        }
        return true;
    });
    EXPECT_EQ(run.exitCode, 0) << run.out;
    const std::vector<std::string> bars = barsOf(run.out);
    ASSERT_GT(bars.size(), wide + 1);
    for (std::size_t i = 0; i < bars.size(); ++i) {
        EXPECT_LE(bars[i].size(), i < wide ? 59U : 19U) << bars[i];
    }
    EXPECT_EQ(bars[0].size(), 59U);
    film();
}

TEST_F(TerminalTest, ATerminalThatHangsUpEndsTheRenderWithItsFilm)
{
    const GlimRun run =
        runOnTerminal(call({"--spp", "2000000000", "--png", "x.png"}), 80, [](int, const std::string& shown) { return !showsBar(shown); });
    EXPECT_EQ(run.exitCode, 128 + SIGHUP);
    EXPECT_GT(film().sampleRanges.front().second, 0U);
    EXPECT_EQ(folder_.entries(), 2);
}

TEST_F(TerminalTest, UnderNohupATerminalThatHangsUpEndsNothing)
{
    const GlimRun run = runOnTerminal(afterCommand("trap '' HUP", call({"--spp", "4096"})), 80,
                                      [](int, const std::string& shown) { return !showsBar(shown); });
    EXPECT_EQ(run.signal, 0);
    EXPECT_EQ(run.exitCode, 1) << "its report could not be written";
    expectFilmOf(4096);
}

TEST_F(TerminalTest, ReadersThatAreGoneEndNothing)
{
    for (const char* redirections : {"2>&1 | true", "2>&1 >/dev/null | head -1", ">&- 2>&- <&-", ">/dev/full 2>/dev/full"}) {
        SCOPED_TRACE(redirections);
        std::filesystem::remove(folder_ / "x.exr");
        GlimCall reader = call({"--spp", "300", "--progress", "json"});
        reader.arguments.insert(reader.arguments.begin(), {"-c", std::string("\"$0\" \"$@\" ") + redirections, reader.program.string()});
        reader.program = "/bin/sh";
        runGlim(reader);
        expectFilmOf(300);
    }
}

// Else messages would go into the next file that is opened.
TEST_F(TerminalTest, StandardStreamsThatAreClosedAreNoFiles)
{
    const char* command = "for i in 0 1 2; do readlink /proc/$PPID/fd/$i; done >streams";
    runGlim(afterCommand("true", call({"--spp", "300", "--checkpoint", "1m", "--on-checkpoint", command}), "<&- >&- 2>&-"));
    EXPECT_EQ(readFileBytes(folder_ / "streams"), "/dev/null\n/dev/null\n/dev/null\n");
}

TEST_F(TerminalTest, ReadersThatDoNotReadAreNotWaitedFor)
{
    const std::filesystem::path pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int end = open(pipe.c_str(), O_RDWR | O_NONBLOCK);
    while (write(end, "full", 4) > 0) {
    }
    runGlim(afterCommand("true", call({"--spp", "256", "--progress", "json"}), "2>pipe"));
    EXPECT_EQ(film().sampleRanges.front().second, 256U);
    runGlim(afterCommand("true", call({"--spp", "600", "--resume"}), "2>pipe"));  // says where it goes on
    close(end);
    std::filesystem::remove(pipe);
    expectFilmOf(600);
}

TEST_F(TerminalTest, AFilmIsWrittenWhileItsTerminalIsStopped)
{
    bool isStopped = false, isWritten = false;
    const GlimRun run = runOnTerminal(call({"--time", "1"}), 80, [&](int terminal, const std::string& shown) {
        if (!isStopped && showsBar(shown)) {
            isStopped = write(terminal, "\x13", 1) == 1;  // Ctrl-S
        } else if (isStopped && !isWritten && std::filesystem::exists(folder_ / "x.exr")) {
            isWritten = write(terminal, "\x11", 1) == 1;  // Ctrl-Q
        }
        return true;
    });
    EXPECT_TRUE(isWritten) << run.out;
    EXPECT_EQ(run.exitCode, 0) << run.out;
    film();
}

TEST_F(TerminalTest, ACommandAfterACheckpointKeepsNoFilmWaiting)
{
    GlimCall slow = call({"--spp", "600", "--checkpoint", "1m", "--on-checkpoint", "while [ ! -e go ]; do sleep .01; done"});
    bool isWhole = false;
    slow.signalWhen = [&](const std::string&) {
        isWhole = isWhole || (std::filesystem::exists(folder_ / "x.exr") && film().sampleRanges.front().second == 600);
        if (isWhole) {
            writeText(folder_ / "go", "");
        }
        return false;
    };
    const GlimRun run = runGlim(slow);
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_TRUE(isWhole) << "while the command ran";
}

TEST_F(TerminalTest, ASignalDuringACommandAfterACheckpointIsNotLost)
{
    GlimCall stopped = call({"--spp", "2000000000", "--checkpoint", "1m", "--on-checkpoint", "touch begun; sleep 1"});
    stopped.signal = SIGINT;
    stopped.signalWhen = [&](const std::string&) { return std::filesystem::exists(folder_ / "begun"); };
    EXPECT_EQ(runGlim(stopped).exitCode, 128 + SIGINT);
    EXPECT_GT(film().sampleRanges.front().second, 0U);
}

}  // namespace
}  // namespace glim::test
