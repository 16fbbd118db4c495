#include "tests/support/virtual_screen.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>

#include <chrono>
#include <thread>

extern char** environ;

namespace glim::test {
namespace {

// The header of an X window dump (XWDFile.h) as numbers of 32 bits, most significant byte first.
enum XwdField { kHeaderSize = 0, kBitsPerPixel = 11, kBytesPerLine = 12, kColors = 19, kFields = 25 };

std::uint32_t field(const std::string& dump, XwdField place)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value = value << 8 | static_cast<std::uint8_t>(dump[4 * static_cast<std::size_t>(place) + i]);
    }
    return value;
}

// Xvfb writes the number of its display to the pipe when it is ready.
std::string readLine(int pipe)
{
    std::string line;
    for (char c = 0; read(pipe, &c, 1) == 1 && c != '\n';) {
        line += c;
    }
    return line;
}

// Desktops keep the density in this database, and GLFW reads it there.
void setDensity(const std::string& display, int density)
{
    FILE* database = popen(("xrdb -display " + display + " -nocpp -merge -").c_str(), "w");
    if (database != nullptr) {
        std::fprintf(database, "Xft.dpi: %d\n", density);
    }
    EXPECT_TRUE(database != nullptr && pclose(database) == 0) << "xrdb fails; is the package x11-xserver-utils installed?";
}

}  // namespace

VirtualScreen::VirtualScreen(int depth, int density)
{
    int ends[2];
    if (pipe(ends) != 0) {
        ADD_FAILURE() << "no pipe";
        return;
    }
    const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight) + "x" + std::to_string(depth);
    std::vector<std::string> words{"Xvfb",    "-displayfd", std::to_string(ends[1]), "-screen",   "0",
                                   size,      "-fbdir",     folder_.path().string(), "-nolisten", "tcp",
                                   "-noreset"};
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    const int error = posix_spawnp(&process_, "Xvfb", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    const std::string number = error == 0 ? readLine(ends[0]) : "";
    close(ends[0]);
    EXPECT_FALSE(number.empty()) << "Xvfb does not start; is the package xvfb installed?";
    name_ = ":" + number;
    setDensity(name_, density);
}

VirtualScreen::~VirtualScreen()
{
    if (process_ > 0) {
        kill(process_, SIGTERM);
        waitpid(process_, nullptr, 0);
    }
}

std::vector<std::array<int, 3>> VirtualScreen::pixels() const
{
    const std::string dump = readFileBytes(folder_ / "Xvfb_screen0");
    std::vector<std::array<int, 3>> pixels;
    if (dump.size() < 4 * kFields || field(dump, kBitsPerPixel) != 32) {
        ADD_FAILURE() << "the screen cannot be read";
        return pixels;
    }
    const std::size_t colorBytes = 12;
    const std::size_t start = field(dump, kHeaderSize) + colorBytes * field(dump, kColors);
    for (std::size_t y = 0; y < kHeight; ++y) {
        for (std::size_t x = 0; x < kWidth; ++x) {
            const auto* bgr = reinterpret_cast<const std::uint8_t*>(&dump.at(start + y * field(dump, kBytesPerLine) + 4 * x));
            pixels.push_back({bgr[2], bgr[1], bgr[0]});
        }
    }
    return pixels;
}

std::vector<std::array<int, 3>> VirtualScreen::calmPixels() const
{
    std::vector<std::array<int, 3>> before = pixels();
    for (int i = 0; i < 100; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
        std::vector<std::array<int, 3>> now = pixels();
        if (now == before) {
            return now;
        }
        before = std::move(now);
    }
    ADD_FAILURE() << "the screen never came to rest";
    return before;
}

}  // namespace glim::test
