// The command line: commands, their options and their help. Only command.cpp includes CLI11, whose templates took a quarter of the build
// time.
#pragma once

#include "host/error.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace glim {

// A mistake in the command itself, in one sentence without a full stop. `main` exits with ExitCode::Usage.
class UsageError : public std::runtime_error {
public:
    explicit UsageError(const std::string& sentence)
        : std::runtime_error(escaped(sentence))
    {}
    UsageError(const std::string& option, const std::string& why)
        : UsageError(option + ": " + why)
    {}
};

// An option of a Command, which owns it.
class Option {
public:
    explicit Option(CLI::Option* option)
        : option_(option)
    {}

    const Option& require(bool required = true) const;
    const Option& needs(const Option& other) const;
    const Option& excludes(const Option& other) const;

private:
    CLI::Option* option_;
};

// Adds options to a command. The variables they store into must outlive the CommandLine.
class Command {
public:
    Command(CLI::App* app, ExitCode* exitCode)
        : app_(app),
          exitCode_(exitCode)
    {}

    // The help lists the options that are added from now on under this title.
    void beginGroup(const std::string& title) const;

    // `names` as in "-o,--output", or "SCENE" for an argument; `unit` as in "OUT.exr". `take` throws UsageError.
    Option add(const std::string& names, const std::string& unit, const std::string& help,
               std::function<void(const std::string&)> take) const;
    Option addPath(const std::string& names, const std::string& unit, const std::string& help, std::filesystem::path& path) const;
    Option addPath(const std::string& names, const std::string& unit, const std::string& help,
                   std::optional<std::filesystem::path>& path) const;
    // Takes one or more values.
    Option addPaths(const std::string& name, const std::string& unit, const std::string& help,
                    std::vector<std::filesystem::path>& paths) const;
    Option addFlag(const std::string& names, const std::string& help, bool& flag) const;

    // Lists these options under --help-all only.
    void hide(const std::vector<std::string>& names) const;
    void setFooter(const std::string& text) const;

    Option option(const std::string& name) const;
    bool isGiven(const std::string& option) const;
    std::string textOf(const std::string& option) const;  // the value of an option that is given

    // The options that are given, as in "--size=8x8", but for these and for arguments.
    std::vector<std::string> wordsGiven(const std::vector<std::string>& except) const;

    // Called after the last option and before the command; throws UsageError.
    void onParsed(std::function<void()> check) const;
    void onRun(std::function<ExitCode()> run) const;

private:
    CLI::App* app_;
    ExitCode* exitCode_;
};

class CommandLine {
public:
    CommandLine(const std::string& description, const std::string& version, const std::string& footer);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    Command addCommand(const std::string& name, const std::string& description);

    // Runs the command that `words` name, or prints the help or the version that they ask for. Throws UsageError and whatever
    // the command throws.
    ExitCode run(std::vector<std::string> words);

private:
    std::unique_ptr<CLI::App> app_;
    ExitCode exitCode_ = ExitCode::Done;
};

}  // namespace glim
