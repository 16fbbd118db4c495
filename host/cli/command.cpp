#include "host/cli/command.hpp"

#include "host/message.hpp"
#include "host/text.hpp"

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
        std::string text = app->get_description() + "\n\nUsage: " + name + getUsage(app) + "\n" + listCommands(app) + listOptions(options);
        if (!app->get_footer().empty()) {
            text += "\n" + app->get_footer() + "\n";
        }
        return text;
    }

    static constexpr const char *kHelpGroup = "Help", *kHelpAll = "--help-all";

private:
    static std::string getUsage(const CLI::App* app)
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

    static std::string getName(const CLI::Option* option)
    {
        if (option->get_positional()) {
            return "  " + option->get_name();
        }
        const std::string unit = option->get_type_size() == 0 ? "" : " " + option->get_type_name();
        const std::string letter = option->get_snames().empty() ? "" : "-" + option->get_snames().front() + ",";
        return "  " + letter + "--" + option->get_lnames().back() + unit;  // other long names are former ones
    }

    static constexpr std::size_t kWidestColumn = 27;  // longer names push their description to the right

    static std::string listOptions(const std::vector<const CLI::Option*>& options)
    {
        std::size_t width = 0;
        for (const CLI::Option* option : options) {
            width = std::max(width, std::min(getName(option).size() + 2, kWidestColumn));
        }
        std::string text, group;
        for (const CLI::Option* option : options) {
            if (option->get_group() != group) {
                group = option->get_group();
                text.append("\n").append(group).append(":\n");
            }
            text += pad(getName(option), width) + option->get_description() + "\n";
        }
        return text;
    }

    std::set<const CLI::Option*> hidden_;
};

std::vector<std::string> listNames(const CLI::App& app, bool areOptions)
{
    std::vector<std::string> names;
    for (const CLI::App* command : areOptions ? std::vector<const CLI::App*>{} : app.get_subcommands({})) {
        names.push_back(command->get_name());
    }
    for (const CLI::Option* option : areOptions ? app.get_options() : std::vector<const CLI::Option*>{}) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back(name);
        }
    }
    return names;
}

// CLI11 would complain about what is missing even if a word that it does not know explains it.
void refuseUnknown(const CLI::App& app)
{
    const std::vector<std::string> unknown = app.remaining(true);
    if (unknown.empty()) {
        return;
    }
    const std::string name = unknown[0].substr(0, unknown[0].find('='));
    const std::vector<CLI::App*> given = app.get_subcommands();
    const bool isOption = name.rfind("--", 0) == 0;
    const std::string ending = lowerCase(std::filesystem::path(name).extension().string());
    std::string meant = nearestOf(name.substr(isOption ? 2 : 0), listNames(isOption && !given.empty() ? *given[0] : app, isOption));
    if (isOption && !meant.empty()) {
        meant.insert(0, "--");
    }
    if (meant.empty() && given.empty() && (ending == ".gltf" || ending == ".glb")) {
        meant = "render " + escaped(name);
    }
    if (meant.empty()) {
        throw UsageError(MessageId::UnknownName, {part::quoted(unknown[0]), " was not expected: no such command, option or argument"});
    }
    throw UsageError(MessageId::UnknownName, {part::quoted(unknown[0]), " was not expected; did you mean ", part::expected(meant), "?"});
}

// CLI11's errors have an option and what is wrong in their sentences alone, as in "--spp: At Most 1 required but received 2", "SCENE is
// required" and "Could not convert: --confine = abc". Options are read by their tables; only flags are converted.
UsageError translate(const CLI::ParseError& error)
{
    const std::string sentence = error.what(), name = sentence.substr(0, sentence.find_first_of(": "));
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        const bool isTwice = sentence.find("At Most") != std::string::npos;
        return isTwice ? UsageError(MessageId::Duplicate, {part::place(name), ": is given twice"})
                       : UsageError(MessageId::Missing, {part::place(name), ": expected ", part::expected("a value")});
    }
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        return name == "A" ? UsageError(MessageId::Missing, {"A ", part::place("command"), " is required"})
                           : UsageError(MessageId::Missing, {part::place(name), " is required"});
    }
    const std::size_t begin = sentence.find("--"), end = sentence.find(" = ");
    if (begin < end && end != std::string::npos) {
        return {MessageId::WrongType,
                {part::place(sentence.substr(begin, end - begin)), ": ", part::quoted(sentence.substr(end + 3)), ": expected ",
                 part::expected("true or false")}};
    }
    return {MessageId::Malformed, {sentence}};
}

// A flag and what it was set to. CLI11's functions for flags end with exceptions of the standard library if the text is no boolean.
struct GivenFlag {
    CLI::Option* option;
    std::string name;
    std::unique_ptr<bool> value = std::make_unique<bool>(false);
};

CLI::Option* addToApp(CLI::App& app, OptionTable& table, const OptionTable::Entry& entry, const std::string& names,
                      std::vector<GivenFlag>& flags)
{
    using Takes = OptionTable::Entry::Takes;
    const auto set = [&table, name = entry.name()](const std::string& text) { table.set(name, OptionValue(text)); };
    if (entry.isFlag()) {
        GivenFlag& flag = flags.emplace_back(GivenFlag{nullptr, entry.name()});
        return flag.option = app.add_flag(names, *flag.value, entry.help);
    }
    if (entry.takes == Takes::One) {
        return app.add_option_function<std::string>(names, set, entry.help);
    }
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        names, [set](const std::vector<std::string>& texts) { std::ranges::for_each(texts, set); }, entry.help);
    option->allow_extra_args(entry.takes == Takes::Several);
    return option;
}

void addOption(CLI::App& app, HelpFormatter& formatter, OptionTable& table, const OptionTable::Entry& entry, std::vector<GivenFlag>& flags)
{
    std::string names;
    for (const std::string& name : entry.isArgument() ? std::vector{entry.name()} : entry.names) {
        names += (names.empty() ? "" : ",") + name;
    }
    CLI::Option* option = addToApp(app, table, entry, names, flags);
    if (!entry.isFlag()) {
        option->type_name(entry.unit);
    }
    option->group(entry.group);
    if (entry.isArgument()) {
        option->required(entry.isRequired);  // the usage says so
    }
    if (entry.isHidden) {
        formatter.hide(option);
    }
}

}  // namespace

ExitCode CommandLine::run(std::vector<std::string> words)
{
    CLI::App app(description_, "glim");
    app.set_version_flag("--version", version_, "Print version, commit and build type");
    app.get_option("--version")->group(HelpFormatter::kHelpGroup);
    app.get_option("--help")->group(HelpFormatter::kHelpGroup);
    app.formatter(std::make_shared<HelpFormatter>());
    app.require_subcommand(1);
    app.footer(footer_);
    ExitCode code = ExitCode::Done;
    for (Command& command : commands_) {
        CLI::App* sub = app.add_subcommand(command.name_, command.description_);
        sub->set_help_flag("-h,--help", "Print the common options")->group(HelpFormatter::kHelpGroup);
        sub->set_help_all_flag(HelpFormatter::kHelpAll, "Print every option")->group(HelpFormatter::kHelpGroup);
        const auto formatter = std::make_shared<HelpFormatter>();
        sub->formatter(formatter);
        sub->footer(command.footer_);
        const auto flags = std::make_shared<std::vector<GivenFlag>>();
        for (const OptionTable::Entry& entry : command.entries()) {
            addOption(*sub, *formatter, command, entry, *flags);
        }
        sub->parse_complete_callback([&command, flags] {
            for (const GivenFlag& flag : *flags) {
                if (flag.option->count() > 0) {
                    command.set(flag.name, OptionValue(*flag.value ? "true" : "false"));
                }
            }
            command.finish();
        });
        sub->callback([&command, &code] { code = command.run_ ? command.run_() : ExitCode::Done; });
    }
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
        app.parse(std::move(words));
    } catch (const CLI::Success& asked) {
        app.exit(asked);
    } catch (const CLI::ParseError& error) {
        refuseUnknown(app);
        throw translate(error);
    } catch (const UsageError&) {
        refuseUnknown(app);
        throw;
    }
    return code;
}

}  // namespace glim
