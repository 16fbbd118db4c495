#include "tests/support/run_glim.hpp"

#include "places.h"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>
#include <utility>

extern char** environ;

namespace glim::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::minutes(2);
constexpr auto kPollInterval = std::chrono::milliseconds(2);

std::vector<std::string> environmentOf(const GlimCall& call)
{
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (call.environment.count(text.substr(0, text.find('='))) == 0) {
            variables.push_back(text);
        }
    }
    for (const auto& [name, value] : call.environment) {
        if (value) {
            variables.push_back(name + "=" + *value);
        }
    }
    return variables;
}

std::vector<char*> pointersTo(std::vector<std::string>& texts)
{
    std::vector<char*> pointers;
    for (std::string& text : texts) {
        pointers.push_back(text.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

std::vector<std::string> wordsOf(const GlimCall& call)
{
    std::vector<std::string> words{call.program.string()};
    words.insert(words.end(), call.arguments.begin(), call.arguments.end());
    return words;
}

pid_t start(const GlimCall& call, const std::filesystem::path& out, const std::filesystem::path& err)
{
    std::vector<std::string> words = wordsOf(call), variables = environmentOf(call);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addchdir_np(&actions, call.folder.c_str());
    pid_t process = -1;
    const int error = posix_spawn(&process, words[0].c_str(), &actions, nullptr, pointersTo(words).data(), pointersTo(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(error, 0) << call.program;
    return error == 0 ? process : -1;
}

// Returns the status of waitpid.
int await(pid_t process, const GlimCall& call, const std::filesystem::path& err)
{
    const Clock::time_point deadline = Clock::now() + kPatience;
    int status = 0;
    bool signalled = !call.signalWhen;
    while (waitpid(process, &status, WNOHANG) == 0) {
        if (!signalled && call.signalWhen(readFileBytes(err))) {
            kill(process, call.signal);
            signalled = true;
        }
        if (Clock::now() > deadline) {
            ADD_FAILURE() << "glim has not ended in time";
            kill(process, SIGKILL);
            waitpid(process, &status, 0);
            break;
        }
        std::this_thread::sleep_for(kPollInterval);
    }
    return status;
}

void setEnd(GlimRun& run, int status)
{
    run.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    run.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

GlimRun runGlim(const GlimCall& call)
{
    const ScratchFolder folder;
    GlimRun run;
    const pid_t process = start(call, folder / "out", folder / "err");
    if (process < 0) {
        return run;
    }
    const int status = await(process, call, folder / "err");
    setEnd(run, status);
    run.out = readFileBytes(folder / "out");
    run.err = readFileBytes(folder / "err");
    return run;
}

GlimRun runOnTerminal(const GlimCall& call, unsigned short columns, const TerminalWatch& watch)
{
    std::vector<std::string> words = wordsOf(call), variables = environmentOf(call);
    const std::vector<char*> arguments = pointersTo(words), environment = pointersTo(variables);
    GlimRun run;
    winsize size{};
    size.ws_row = 24;
    size.ws_col = columns;
    int terminal = -1;
    const pid_t process = forkpty(&terminal, nullptr, nullptr, &size);
    if (process == 0) {
        if (chdir(call.folder.c_str()) == 0) {
            execve(arguments[0], arguments.data(), environment.data());
        }
        _exit(127);
    }
    EXPECT_GT(process, 0);
    if (process < 0) {
        return run;
    }
    const Clock::time_point deadline = Clock::now() + kPatience;
    // Reading fails once nobody has the terminal open.
    for (char text[4096]; terminal >= 0 && Clock::now() < deadline;) {
        pollfd poll{terminal, POLLIN, 0};
        if (::poll(&poll, 1, 10) > 0) {
            const ssize_t length = read(terminal, text, sizeof text);
            if (length <= 0) {
                break;
            }
            run.out.append(text, static_cast<std::size_t>(length));
        }
        if (watch && !watch(terminal, run.out)) {
            close(std::exchange(terminal, -1));
        }
    }
    setEnd(run, await(process, {}, {}));
    if (terminal >= 0) {
        close(terminal);
    }
    return run;
}

GlimCall afterCommand(const std::string& command, GlimCall call, const std::string& redirections)
{
    const std::string script = command + R"(; exec "$0" "$@" )" + redirections;
    call.arguments.insert(call.arguments.begin(), {"-c", script, call.program.string()});
    call.program = "/bin/sh";
    return call;
}

GlimRun runGlim(const std::vector<std::string>& arguments)
{
    GlimCall call;
    call.arguments = arguments;
    return runGlim(call);
}

std::string sceneFile(const std::string& name) { return (std::filesystem::path(GLIM_SOURCE_DIR) / "scenes" / name).string(); }

std::size_t countLines(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

}  // namespace glim::test
