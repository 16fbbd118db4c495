// The options of a job or of a command: names, help, where values go, and which options can be combined. A command line sets options as
// text; programs set them as values. This is glim's own code, since CLI11 has only text; CLI11 parses the command line
// (host/cli/command.cpp).
#pragma once

#include "host/error.hpp"
#include "host/json.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glim {

// The value of an option: text from a command line; text, a number, a boolean or a list of texts and numbers from a program.
class OptionValue {
public:
    OptionValue(std::string text);
    OptionValue(const char* text);
    // Throws UsageError for null, objects and lists of lists.
    explicit OptionValue(const Json& json);
    // What a member of an object says: a name and a value.
    OptionValue(std::string key, const Json& json);

    bool isNumber() const { return kind_ == Kind::Number; }
    bool isList() const { return kind_ == Kind::List; }
    // Nothing if the value is no boolean.
    std::optional<bool> boolean() const;
    // The value as a command line has it; a list has commas.
    std::string text() const;
    // Empty unless it is a member's.
    const std::string& key() const { return key_; }
    // The elements of a list, or the parts of a text between separators.
    std::vector<std::string> split(char separator) const;

private:
    enum class Kind { Text, Number, Boolean, List };

    Kind kind_;
    std::string key_;
    std::vector<std::string> parts_;  // one unless it is a list
};

class OptionTable;

// What values of an option are. Other: what its unit says.
enum class OptionKind { Other, Flag, Text, Path, Whole, Number, Choice };

// An option of a table.
class Option {
public:
    Option(OptionTable& table, std::size_t index)
        : table_(&table),
          index_(index)
    {}

    const Option& require(bool required = true) const;
    const Option& needs(const Option& other) const;
    const Option& excludes(const Option& other) const;
    // Whatever needs `other` may have this one instead.
    const Option& servesAs(const Option& other) const;
    // `choices`: the words of a Choice.
    const Option& holds(OptionKind kind, const std::vector<std::string>& choices = {}) const;

private:
    friend class OptionTable;

    OptionTable* table_;
    std::size_t index_;
};

class OptionTable {
public:
    struct Entry {
        std::vector<std::string> names;  // "-o", "--output"; without dashes: an argument. The help has the last of several long ones
        std::string unit, help, group;   // `unit` as in "OUT.exr"; none: a flag
        std::function<void(const OptionValue&)> take;
        OptionKind kind = OptionKind::Other;
        std::vector<std::string> choices;
        enum class Takes { One, Each, Several } takes = Takes::One;  // Each: one each time it is given; Several: all that follow
        bool isHidden = false, isRequired = false;
        std::vector<std::size_t> needs, excludes, substitutes;
        std::vector<OptionValue> given;
        struct InFile {
            std::string file;
            OptionValue value;
        };
        std::optional<InFile> inFile;          // what a file says of an option that takes one value
        bool isSet = false, isByFile = false;  // isByFile: what is given is what the file says

        bool isFlag() const { return unit.empty(); }
        bool isArgument() const { return names.back().front() != '-'; }
        const std::string& name() const { return names.back(); }
    };

    OptionTable() = default;
    OptionTable(const OptionTable&) = delete;
    OptionTable& operator=(const OptionTable&) = delete;

    // The help lists the options that are added from now on under this title.
    void beginGroup(const std::string& title) { group_ = title; }

    // `names` as in "-o,--output", or "SCENE" for an argument. `take` throws UsageError. What it stores into must outlive the table.
    Option add(const std::string& names, const std::string& unit, const std::string& help, std::function<void(const OptionValue&)> take);
    Option addText(const std::string& names, const std::string& unit, const std::string& help, std::string& text);
    Option addText(const std::string& names, const std::string& unit, const std::string& help, std::optional<std::string>& text);
    Option addPath(const std::string& names, const std::string& unit, const std::string& help, std::filesystem::path& path);
    Option addPath(const std::string& names, const std::string& unit, const std::string& help, std::optional<std::filesystem::path>& path);
    // May be given several times. Programs give an object, of which each member is one.
    Option addEach(const std::string& names, const std::string& unit, const std::string& help,
                   std::function<void(const OptionValue&)> take);
    // Takes one or more values.
    Option addPaths(const std::string& name, const std::string& unit, const std::string& help, std::vector<std::filesystem::path>& paths);
    Option addFlag(const std::string& names, const std::string& help, bool& flag);

    // Only --help-all lists these.
    void hide(const std::vector<std::string>& names);

    Option option(const std::string& name) { return {*this, indexOf(name)}; }
    bool isGiven(const std::string& name) const;  // false too if the table has no such option
    bool isByFile(const std::string& name) const { return entries_[indexOf(name)].isByFile; }
    std::string toText(const std::string& name) const { return entries_[indexOf(name)].given.front().text(); }  // if it is given

    const std::vector<OptionValue>& valuesOf(const std::string& name) const { return entries_[indexOf(name)].given; }

    // The options that are given, as in "--size=8x8", without arguments and without those named in `except`.
    std::vector<std::string> wordsGiven(const std::vector<std::string>& except) const;

    // Called by finish() after its own checks; throws UsageError.
    void onFinished(std::function<void()> check) { check_ = std::move(check); }

    // `name` as in "--look-from", "look-from" or "look_from". Throws UsageError if there is no such option, and what `take` throws.
    void set(const std::string& name, const OptionValue& value);
    // null counts as left out; members of objects are set one by one, where an option may be given several times.
    void set(const std::string& name, const Json& value);
    // Each member of an object, in the order of the table, as a command line does.
    void setAll(const Json& options);
    // What a file says. Options that take one value are taken by finish(), unless they are set otherwise, or excluded by an option that is,
    // or need one that is; the file's name begins what finish() refuses of them. Values of the others precede those that are set later.
    void setByFile(const std::string& file, const std::string& name, const Json& value);
    // To be called once after all options are set. Throws UsageError if some do not go together, or if a required one is missing.
    void finish();

    const Entry& entry(const std::string& name) const { return entries_[findAnyIndex(name)]; }  // `name` as of set()

    const std::deque<Entry>& entries() const { return entries_; }

private:
    friend class Option;

    std::optional<std::size_t> find(const std::string& name) const;
    std::size_t indexOf(const std::string& name) const;       // throws UsageError
    std::size_t findAnyIndex(const std::string& name) const;  // the same; the name may be as programs have it
    void takeFromFile();

    std::deque<Entry> entries_;
    std::string group_;
    std::function<void()> check_;
};

}  // namespace glim
