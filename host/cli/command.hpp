// The command line: commands, their options and their help. Only command.cpp includes CLI11, whose templates took a quarter of the build
// time.
#pragma once

#include "host/job/option_table.hpp"

namespace glim {

// A command and its options.
class Command : public OptionTable {
public:
    Command(std::string name, std::string description)
        : name_(std::move(name)),
          description_(std::move(description))
    {}

    void setFooter(std::string text) { footer_ = std::move(text); }
    void onRun(std::function<ExitCode()> run) { run_ = std::move(run); }

private:
    friend class CommandLine;

    std::string name_, description_, footer_;
    std::function<ExitCode()> run_;
};

class CommandLine {
public:
    CommandLine(std::string description, std::string version, std::string footer)
        : description_(std::move(description)),
          version_(std::move(version)),
          footer_(std::move(footer))
    {}

    // Stays where it is.
    Command& addCommand(const std::string& name, const std::string& description) { return commands_.emplace_back(name, description); }

    // Runs the command that `words` name, or prints the help or the version that they ask for. To be called once. Throws UsageError and
    // whatever the command throws.
    ExitCode run(std::vector<std::string> words);

private:
    std::string description_, version_, footer_;
    std::deque<Command> commands_;
};

}  // namespace glim
