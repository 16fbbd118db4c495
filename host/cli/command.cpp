#include "host/cli/command.hpp"

#include "host/message.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>

namespace glim {
namespace {

// Groups in the order of their first options, one option per line.
class HelpFormatter : public CLI::FormatterBase {
public:
    void hide(const CLI::Option* option) { hidden_.insert(option); }

    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override
    {
        std::vector<const CLI::Option*> options;
        for (const CLI::Option* option : app->get_options()) {
            const bool isVain = hidden_.empty() && option->get_name() == kHelpAll;  // it would print the same
            if (!isVain && (mode == CLI::AppFormatMode::All || hidden_.count(option) == 0)) {
                options.push_back(option);
            }
        }
        // The Help group comes last, though CLI11 defines it first.
        std::stable_partition(options.begin(), options.end(), [](const CLI::Option* o) { return o->get_group() != kHelpGroup; });
        std::string text = app->get_description() + "\n\nUsage: " + name + usageOf(app) + "\n" + listCommands(app) + listOptions(options);
        if (!app->get_footer().empty()) {
            text += "\n" + app->get_footer() + "\n";
        }
        return text;
    }

    static constexpr const char *kHelpGroup = "Help", *kHelpAll = "--help-all";

private:
    static std::string usageOf(const CLI::App* app)
    {
        std::string text = app->get_subcommands({}).empty() ? " [OPTIONS]" : " COMMAND [OPTIONS]";
        for (const CLI::Option* option : app->get_options()) {
            if (option->get_positional()) {
                const std::string dots = option->get_items_expected_max() > 1 ? "..." : "";
                text += option->get_required() ? " " + option->get_name() + dots : " [" + option->get_name() + dots + "]";
            }
        }
        return text;
    }

    static std::string pad(const std::string& text, std::size_t width)
    {
        return text + std::string(std::max(width, text.size() + 2) - text.size(), ' ');
    }

    static std::string listCommands(const CLI::App* app)
    {
        std::string text;
        for (const CLI::App* command : app->get_subcommands({})) {
            text += (text.empty() ? "\nCommands:\n  " : "  ") + pad(command->get_name(), 10) + command->get_description() + "\n";
        }
        return text;
    }

    static std::string nameOf(const CLI::Option* option)
    {
        const std::string unit = option->get_type_size() == 0 ? "" : option->get_type_name();
        return "  " + option->get_name(false, true) + (unit.empty() || option->get_positional() ? "" : " " + unit);
    }

    static constexpr std::size_t kWidestColumn = 27;  // longer names push their description to the right

    static std::string listOptions(const std::vector<const CLI::Option*>& options)
    {
        std::size_t width = 0;
        for (const CLI::Option* option : options) {
            width = std::max(width, std::min(nameOf(option).size() + 2, kWidestColumn));
        }
        std::string text, group;
        for (const CLI::Option* option : options) {
            if (option->get_group() != group) {
                group = option->get_group();
                text.append("\n").append(group).append(":\n");
            }
            text += pad(nameOf(option), width) + option->get_description() + "\n";
        }
        return text;
    }

    std::set<const CLI::Option*> hidden_;
};

// CLI11 would complain about what is missing even if a word that it does not know explains it.
std::string sentenceOf(const CLI::App& app, const std::string& complaint)
{
    const std::vector<std::string> unknown = app.remaining(true);
    return unknown.empty() ? complaint : "\"" + unknown[0] + "\" was not expected: no such command, option or argument";
}

}  // namespace

const Option& Option::require(bool required) const
{
    option_->required(required);
    return *this;
}

const Option& Option::needs(const Option& other) const
{
    option_->needs(other.option_);
    return *this;
}

const Option& Option::excludes(const Option& other) const
{
    option_->excludes(other.option_);
    return *this;
}

void Command::beginGroup(const std::string& title) const { app_->option_defaults()->group(title); }

Option Command::add(const std::string& names, const std::string& unit, const std::string& help,
                    std::function<void(const std::string&)> take) const
{
    CLI::Option* option = app_->add_option_function<std::string>(names, std::move(take), help);
    option->type_name(unit);
    return Option(option);
}

Option Command::addPath(const std::string& names, const std::string& unit, const std::string& help, std::filesystem::path& path) const
{
    return add(names, unit, help, [&path](const std::string& text) { path = text; });
}

Option Command::addPath(const std::string& names, const std::string& unit, const std::string& help,
                        std::optional<std::filesystem::path>& path) const
{
    return add(names, unit, help, [&path](const std::string& text) { path = text; });
}

Option Command::addPaths(const std::string& name, const std::string& unit, const std::string& help,
                         std::vector<std::filesystem::path>& paths) const
{
    CLI::Option* option = app_->add_option_function<std::vector<std::string>>(
        name, [&paths](const std::vector<std::string>& texts) { paths.assign(texts.begin(), texts.end()); }, help);
    option->type_name(unit);
    return Option(option);
}

Option Command::addFlag(const std::string& names, const std::string& help, bool& flag) const
{
    return Option(app_->add_flag(names, flag, help));
}

void Command::hide(const std::vector<std::string>& names) const
{
    for (const std::string& name : names) {
        static_cast<HelpFormatter&>(*app_->get_formatter()).hide(app_->get_option(name));
    }
}

void Command::setFooter(const std::string& text) const { app_->footer(text); }

Option Command::option(const std::string& name) const { return Option(app_->get_option(name)); }

bool Command::isGiven(const std::string& option) const { return app_->count(option) > 0; }

std::string Command::textOf(const std::string& option) const { return app_->get_option(option)->results().front(); }

std::vector<std::string> Command::wordsGiven(const std::vector<std::string>& except) const
{
    std::vector<std::string> words;
    for (const CLI::Option* option : app_->get_options()) {
        const std::string name = option->get_lnames().empty() ? std::string() : "--" + option->get_lnames().front();
        if (option->count() > 0 && !option->get_positional() && std::ranges::find(except, name) == except.end()) {
            words.push_back(option->get_type_size() == 0 ? name : name + "=" + option->results().front());
        }
    }
    return words;
}

void Command::onParsed(std::function<void()> check) const { app_->parse_complete_callback(std::move(check)); }

void Command::onRun(std::function<ExitCode()> run) const
{
    app_->callback([exitCode = exitCode_, run = std::move(run)] { *exitCode = run(); });
}

CommandLine::CommandLine(const std::string& description, const std::string& version, const std::string& footer)
    : app_(std::make_unique<CLI::App>(description, "glim"))
{
    app_->set_version_flag("--version", version, "Print version, commit and build type");
    app_->get_option("--version")->group(HelpFormatter::kHelpGroup);
    app_->get_option("--help")->group(HelpFormatter::kHelpGroup);
    app_->formatter(std::make_shared<HelpFormatter>());
    app_->require_subcommand(1);
    app_->footer(footer);
}

CommandLine::~CommandLine() = default;

Command CommandLine::addCommand(const std::string& name, const std::string& description)
{
    CLI::App* app = app_->add_subcommand(name, description);
    app->set_help_flag("-h,--help", "Print the common options")->group(HelpFormatter::kHelpGroup);
    app->set_help_all_flag(HelpFormatter::kHelpAll, "Print every option")->group(HelpFormatter::kHelpGroup);
    app->formatter(std::make_shared<HelpFormatter>());
    app->footer("");  // not the whole program's
    return {app, &exitCode_};
}

ExitCode CommandLine::run(std::vector<std::string> words)
{
    for (const std::string& word : words) {
        if (word.find('\0') != std::string::npos) {  // a name of a file would end there
            throw UsageError(inQuotes(word) + " has a null character; expected a text without one");
        }
    }
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
        app_->parse(std::move(words));
    } catch (const CLI::Success& asked) {
        app_->exit(asked);
    } catch (const CLI::ParseError& error) {
        throw UsageError(sentenceOf(*app_, error.what()));
    } catch (const UsageError& error) {
        throw UsageError(sentenceOf(*app_, error.what()));
    }
    return exitCode_;
}

}  // namespace glim
