#include "host/json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace glim {

struct JsonConversion {
    using Other = nlohmann::ordered_json;

    static Other to(std::nullptr_t) { return nullptr; }
    static Other to(const Json::Array& array)
    {
        Other other = Other::array();
        for (const Json& element : array) {
            other.push_back(to(element));
        }
        return other;
    }
    static Other to(const Json::Object& object)
    {
        Other other = Other::object();
        for (const Json::Member& member : object) {
            other[member.name] = to(member.value);
        }
        return other;
    }
    template <class Leaf>
    static Other to(const Leaf& leaf)
    {
        return leaf;
    }
    static Other to(const Json& json)
    {
        return std::visit([](const auto& value) { return to(value); }, json.value_);
    }

    static Json from(const Other& other)
    {
        switch (other.type()) {
        case Other::value_t::boolean: return other.get<bool>();
        case Other::value_t::number_integer: return other.get<std::int64_t>();
        case Other::value_t::number_unsigned: return other.get<std::uint64_t>();
        case Other::value_t::number_float: return other.get<double>();
        case Other::value_t::string: return other.get<std::string>();
        case Other::value_t::array: {
            Json json = Json::array();
            for (const Other& element : other) {
                json.append(from(element));
            }
            return json;
        }
        case Other::value_t::object: {
            Json json = Json::object();
            for (const auto& [name, value] : other.items()) {
                json.set(name, from(value));
            }
            return json;
        }
        default: return nullptr;
        }
    }
};

Json::Json()
    : value_(nullptr)
{}
Json::Json(std::nullptr_t)
    : value_(nullptr)
{}
Json::Json(const char* text)
    : value_(std::string(text))
{}
Json::Json(std::string text)
    : value_(std::move(text))
{}
Json::Json(std::initializer_list<Member> members)
    : value_(Object(members))
{}
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json Json::array(std::initializer_list<Json> elements)
{
    Json json;
    json.value_ = Array(elements);
    return json;
}

Json Json::object()
{
    Json json;
    json.value_ = Object();
    return json;
}

std::optional<Json> Json::parse(const std::string& text)
{
    constexpr int kMaxLevels = 256;  // conversion and destructors recurse
    bool deep = false;
    const auto look = [&deep](int depth, JsonConversion::Other::parse_event_t /*event*/, const JsonConversion::Other& /*value*/) {
        deep = deep || depth > kMaxLevels;
        return !deep;
    };
    const JsonConversion::Other other = JsonConversion::Other::parse(text, look, false);
    return deep || other.is_discarded() ? std::nullopt : std::optional<Json>(JsonConversion::from(other));
}

void Json::append(Json element) { std::get<Array>(value_).push_back(std::move(element)); }

void Json::set(const std::string& name, Json value)
{
    Object& object = std::get<Object>(value_);
    const auto found = std::find_if(object.begin(), object.end(), [&](const Member& member) { return member.name == name; });
    if (found != object.end()) {
        found->value = std::move(value);
    } else {
        object.push_back({name, std::move(value)});
    }
}

void Json::update(const Json& object)
{
    for (const Member& member : std::get<Object>(object.value_)) {
        set(member.name, member.value);
    }
}

std::string Json::dump(int indent) const
{
    return JsonConversion::to(*this).dump(indent, ' ', false, JsonConversion::Other::error_handler_t::replace);
}

bool Json::isObject() const { return std::holds_alternative<Object>(value_); }
bool Json::isArray() const { return std::holds_alternative<Array>(value_); }
bool Json::isText() const { return std::holds_alternative<std::string>(value_); }
bool Json::isBoolean() const { return std::holds_alternative<bool>(value_); }
bool Json::isNull() const { return std::holds_alternative<std::nullptr_t>(value_); }
bool Json::isNumber() const { return !isObject() && !isArray() && !isText() && !isBoolean() && !isNull(); }

bool Json::is(const std::string& text) const
{
    const std::string* own = std::get_if<std::string>(&value_);
    return own != nullptr && *own == text;
}

const Json* Json::find(const std::string& name) const
{
    const Object* object = std::get_if<Object>(&value_);
    if (object == nullptr) {
        return nullptr;
    }
    const auto found = std::find_if(object->begin(), object->end(), [&](const Member& member) { return member.name == name; });
    return found != object->end() ? &found->value : nullptr;
}

const Json& Json::at(const std::string& name) const
{
    if (const Json* found = find(name)) {
        return *found;
    }
    throw JsonError("there is no member \"" + name + "\"");
}

const Json& Json::at(std::size_t index) const
{
    if (index >= elements().size()) {
        throw JsonError("there is no element " + std::to_string(index));
    }
    return elements()[index];
}

const std::vector<Json::Member>& Json::members() const
{
    if (const Object* object = std::get_if<Object>(&value_)) {
        return *object;
    }
    throw JsonError(dump() + " is not an object");
}

const std::vector<Json>& Json::elements() const
{
    if (const Array* array = std::get_if<Array>(&value_)) {
        return *array;
    }
    throw JsonError(dump() + " is not an array");
}

const std::string& Json::text() const
{
    if (const std::string* text = std::get_if<std::string>(&value_)) {
        return *text;
    }
    throw JsonError(dump() + " is not a string");
}

double Json::number() const
{
    if (const double* number = std::get_if<double>(&value_)) {
        return *number;
    }
    if (const std::int64_t* number = std::get_if<std::int64_t>(&value_)) {
        return static_cast<double>(*number);
    }
    if (const std::uint64_t* number = std::get_if<std::uint64_t>(&value_)) {
        return static_cast<double>(*number);
    }
    throw JsonError(dump() + " is not a number");
}

std::uint32_t Json::count() const
{
    std::optional<std::uint64_t> whole;
    if (const std::uint64_t* number = std::get_if<std::uint64_t>(&value_)) {
        whole = *number;
    } else if (const std::int64_t* integer = std::get_if<std::int64_t>(&value_); integer != nullptr && *integer >= 0) {
        whole = static_cast<std::uint64_t>(*integer);
    }
    if (!whole || *whole > std::numeric_limits<std::uint32_t>::max()) {
        throw JsonError(dump() + " is not a whole number of 32 bits");
    }
    return static_cast<std::uint32_t>(*whole);
}

bool Json::boolean() const
{
    if (const bool* value = std::get_if<bool>(&value_)) {
        return *value;
    }
    throw JsonError(dump() + " is neither true nor false");
}

}  // namespace glim
