#include "host/job/option_table.hpp"

#include "host/text.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

std::vector<std::string> splitText(const std::string& text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

UsageError noSuchOption(const std::string& name) { return {MessageId::UnknownName, {part::quoted(name), ": there is no such option"}}; }

UsageError aboutFile(const std::string& file, const Message& message)
{
    return UsageError(Message(message, {part::file(file), ": ", message.sentence}));
}

// What each value of the option is set to. null counts as left out.
std::vector<OptionValue> toValues(const OptionTable::Entry& entry, const Json& value)
{
    std::vector<OptionValue> values;
    if (value.isObject() && entry.takes == OptionTable::Entry::Takes::Each) {
        for (const Json::Member& member : value.members()) {
            values.emplace_back(member.name, member.value);
        }
    } else if (value.isArray() && entry.takes != OptionTable::Entry::Takes::One) {
        for (const Json& element : value.elements()) {
            values.emplace_back(element);
        }
    } else if (!value.isNull()) {
        values.emplace_back(value);
    }
    return values;
}

}  // namespace

OptionValue::OptionValue(std::string text)
    : kind_(Kind::Text),
      parts_{std::move(text)}
{}

OptionValue::OptionValue(const char* text)
    : OptionValue(std::string(text))
{}

OptionValue::OptionValue(const Json& json)
{
    const auto take = [this, &json](const Json& value) {
        if (value.isText()) {
            parts_.push_back(value.text());
        } else if (value.isNumber()) {
            const double number = value.number();
            const bool isWhole = std::abs(number) < 0x1p53 && number == std::floor(number);
            parts_.push_back(isWhole ? std::to_string(static_cast<std::int64_t>(number)) : exactText(number));
        } else {
            throw UsageError(MessageId::WrongType, {part::value(json.dump()), ": expected ",
                                                    part::expected("a text, a number, true, false, or a list of texts and numbers")});
        }
    };
    if (json.isBoolean()) {
        kind_ = Kind::Boolean;
        parts_ = {json.boolean() ? "true" : "false"};
    } else if (json.isArray()) {
        kind_ = Kind::List;
        std::ranges::for_each(json.elements(), take);
    } else {
        kind_ = json.isText() ? Kind::Text : Kind::Number;
        take(json);
    }
}

OptionValue::OptionValue(std::string key, const Json& json)
    : OptionValue(json)
{
    key_ = std::move(key);
}

std::optional<bool> OptionValue::boolean() const { return kind_ == Kind::Boolean ? std::optional(parts_.front() == "true") : std::nullopt; }

std::string OptionValue::text() const
{
    std::string text;
    for (const std::string& part : parts_) {
        text += (&part == &parts_.front() ? "" : ",") + part;
    }
    return text;
}

std::vector<std::string> OptionValue::split(char separator) const
{
    return kind_ == Kind::List ? parts_ : splitText(parts_.front(), separator);
}

const Option& Option::require(bool required) const
{
    table_->entries_[index_].isRequired = required;
    return *this;
}

const Option& Option::needs(const Option& other) const
{
    table_->entries_[index_].needs.push_back(other.index_);
    return *this;
}

const Option& Option::excludes(const Option& other) const
{
    table_->entries_[index_].excludes.push_back(other.index_);
    table_->entries_[other.index_].excludes.push_back(index_);
    return *this;
}

const Option& Option::servesAs(const Option& other) const
{
    table_->entries_[other.index_].substitutes.push_back(index_);
    return *this;
}

const Option& Option::holds(OptionKind kind, const std::vector<std::string>& choices) const
{
    table_->entries_[index_].kind = kind;
    table_->entries_[index_].choices = choices;
    return *this;
}

Option OptionTable::add(const std::string& names, const std::string& unit, const std::string& help,
                        std::function<void(const OptionValue&)> take)
{
    Entry& entry = entries_.emplace_back();
    entry.names = splitText(names, ',');
    entry.unit = unit;
    entry.help = help;
    entry.group = group_;
    entry.take = std::move(take);
    return {*this, entries_.size() - 1};
}

Option OptionTable::addText(const std::string& names, const std::string& unit, const std::string& help, std::string& text)
{
    return add(names, unit, help, [&text](const OptionValue& value) { text = value.text(); }).holds(OptionKind::Text);
}

Option OptionTable::addText(const std::string& names, const std::string& unit, const std::string& help, std::optional<std::string>& text)
{
    return add(names, unit, help, [&text](const OptionValue& value) { text = value.text(); }).holds(OptionKind::Text);
}

Option OptionTable::addPath(const std::string& names, const std::string& unit, const std::string& help, std::filesystem::path& path)
{
    return add(names, unit, help, [&path](const OptionValue& value) { path = value.text(); }).holds(OptionKind::Path);
}

Option OptionTable::addPath(const std::string& names, const std::string& unit, const std::string& help,
                            std::optional<std::filesystem::path>& path)
{
    return add(names, unit, help, [&path](const OptionValue& value) { path = value.text(); }).holds(OptionKind::Path);
}

Option OptionTable::addEach(const std::string& names, const std::string& unit, const std::string& help,
                            std::function<void(const OptionValue&)> take)
{
    const Option option = add(names, unit, help, std::move(take));
    entries_.back().takes = Entry::Takes::Each;
    return option;
}

Option OptionTable::addPaths(const std::string& name, const std::string& unit, const std::string& help,
                             std::vector<std::filesystem::path>& paths)
{
    const Option option = add(name, unit, help, [&paths](const OptionValue& value) { paths.emplace_back(value.text()); });
    entries_.back().takes = Entry::Takes::Several;
    return option;
}

Option OptionTable::addFlag(const std::string& names, const std::string& help, bool& flag)
{
    const std::string name = splitText(names, ',').back();
    return add(names, "", help,
               [&flag, name](const OptionValue& value) {
                   if (value.text() != "true" && value.text() != "false") {
                       throw UsageError(MessageId::WrongType, {part::place(name), ": ", part::quoted(value.text()), ": expected ",
                                                               part::expected("true or false")});
                   }
                   flag = value.text() == "true";
               })
        .holds(OptionKind::Flag);
}

void OptionTable::hide(const std::vector<std::string>& names)
{
    for (const std::string& name : names) {
        entries_[indexOf(name)].isHidden = true;
    }
}

std::optional<std::size_t> OptionTable::find(const std::string& name) const
{
    const auto entry =
        std::ranges::find_if(entries_, [&name](const Entry& e) { return std::ranges::find(e.names, name) != e.names.end(); });
    return entry == entries_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(entry - entries_.begin()));
}

std::size_t OptionTable::indexOf(const std::string& name) const
{
    if (const std::optional<std::size_t> index = find(name)) {
        return *index;
    }
    throw noSuchOption(name);
}

bool OptionTable::isGiven(const std::string& name) const
{
    const std::optional<std::size_t> index = find(name);
    return index && !entries_[*index].given.empty();
}

std::vector<std::string> OptionTable::wordsGiven(const std::vector<std::string>& except) const
{
    std::vector<std::string> words;
    for (const Entry& entry : entries_) {
        if (entry.isArgument() || std::ranges::find(except, entry.name()) != except.end()) {
            continue;
        }
        for (const OptionValue& value : entry.given) {
            const std::string key = value.key().empty() ? "" : value.key() + "=";
            words.push_back(entry.isFlag() ? entry.name() : entry.name() + "=" + key + value.text());
        }
    }
    return words;
}

std::size_t OptionTable::findAnyIndex(const std::string& name) const
{
    if (const std::optional<std::size_t> index = find(name)) {
        return *index;
    }
    std::string option = "--" + name;
    std::ranges::replace(option, '_', '-');
    if (const std::optional<std::size_t> index = find(option)) {
        return *index;
    }
    throw noSuchOption(name);
}

void OptionTable::set(const std::string& name, const OptionValue& value)
{
    Entry& entry = entries_[findAnyIndex(name)];
    if (const std::string text = value.key() + value.text(); text.find('\0') != std::string::npos) {  // a name of a file would end there
        throw UsageError(MessageId::Malformed,
                         {part::quoted(text), " has a null character; expected ", part::expected("a text without one")});
    }
    if (entry.takes == Entry::Takes::One && !entry.given.empty()) {
        throw UsageError(MessageId::Duplicate, {part::place(entry.name()), ": is given twice"});
    }
    entry.take(value);
    entry.isSet = true;
    if (!entry.isFlag() || value.text() == "true") {
        entry.given.push_back(value);
    }
}

void OptionTable::set(const std::string& name, const Json& value)
{
    const Entry& entry = entries_[findAnyIndex(name)];
    for (const OptionValue& one : toValues(entry, value)) {
        set(entry.name(), one);
    }
}

void OptionTable::setAll(const Json& options)
{
    std::vector<std::pair<std::size_t, const Json::Member*>> ordered;
    for (const Json::Member& option : options.members()) {
        ordered.emplace_back(findAnyIndex(option.name), &option);
    }
    std::ranges::stable_sort(ordered, {}, [](const auto& option) { return option.first; });
    for (const auto& [index, option] : ordered) {
        set(option->name, option->value);
    }
}

void OptionTable::setByFile(const std::string& file, const std::string& name, const Json& value)
{
    Entry& entry = entries_[findAnyIndex(name)];
    for (const OptionValue& one : toValues(entry, value)) {
        if (entry.takes != Entry::Takes::One) {
            set(entry.name(), one);
        } else if (entry.inFile) {
            throw UsageError(MessageId::Duplicate, {part::place(entry.name()), ": is given twice"});
        } else {
            entry.inFile = {file, one};
        }
    }
}

void OptionTable::takeFromFile()
{
    const auto isOtherwise = [this](std::size_t index) { return !entries_[index].given.empty() && !entries_[index].isByFile; };
    const auto isExcluded = [&](const Entry& entry) { return std::ranges::any_of(entry.excludes, isOtherwise); };
    const auto isLost = [&](std::size_t index) {
        return isExcluded(entries_[index]) && std::ranges::none_of(entries_[index].substitutes, isOtherwise);
    };
    for (Entry& entry : entries_) {
        if (!entry.inFile || entry.isSet || isExcluded(entry) || std::ranges::any_of(entry.needs, isLost)) {
            continue;
        }
        try {
            set(entry.name(), entry.inFile->value);
        } catch (const UsageError& error) {
            throw aboutFile(entry.inFile->file, error.message());
        }
        entry.isByFile = true;
    }
}

void OptionTable::finish()
{
    takeFromFile();
    const auto isMissing = [this](std::size_t index) { return entries_[index].given.empty(); };
    const auto isLacking = [&](std::size_t index) {
        return isMissing(index) && std::ranges::all_of(entries_[index].substitutes, isMissing);
    };
    const auto nameWithSubstitutes = [this](const Entry& entry) {
        std::string names = entry.name();
        for (const std::size_t substitute : entry.substitutes) {
            names += " or " + entries_[substitute].name();
        }
        return names;
    };
    const auto refuse = [](const Entry& entry, MessageId id, std::initializer_list<MessagePart> words) {
        throw entry.isByFile ? aboutFile(entry.inFile->file, Message(id, words)) : UsageError(id, words);
    };
    for (const Entry& entry : entries_) {
        if (entry.isRequired && entry.given.empty()) {
            throw UsageError(MessageId::Missing, {part::place(entry.name()), " is required"});
        }
        if (entry.given.empty()) {
            continue;
        }
        if (const auto lacks = std::ranges::find_if(entry.needs, isLacking); lacks != entry.needs.end()) {
            refuse(entry, MessageId::Requires,
                   {part::place(entry.name()), " requires ", part::expected(nameWithSubstitutes(entries_[*lacks]))});
        }
        if (const auto other = std::ranges::find_if_not(entry.excludes, isMissing); other != entry.excludes.end()) {
            refuse(entry, MessageId::Conflict, {part::place(entry.name()), " excludes ", part::value(entries_[*other].name())});
        }
    }
    if (check_) {
        check_();
    }
}

}  // namespace glim
