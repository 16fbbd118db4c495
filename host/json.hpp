// A JSON value to build, print and parse. json.cpp and the glTF reader alone include nlohmann-json, whose templates
// took a quarter of the build time.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace glim {

// The value has another type than was asked for. The message is one sentence without a full stop.
class JsonError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class Json {
public:
    struct Member;  // {name, value}

    Json();  // null
    Json(std::nullptr_t);
    Json(const char* text);
    Json(std::string text);
    template <class T>
    requires std::is_arithmetic_v<T> Json(T number)
        : value_(store(number))
    {}
    template <class T>
    Json(const std::optional<T>& value)
        : Json(value ? Json(*value) : Json())
    {}
    template <class Range>
    requires(!std::is_convertible_v<const Range&, std::string>) && requires(const Range& range)
    {
        typename Range::value_type;
        range.begin();
    }
    Json(const Range& range)
        : Json(makeArray(range.begin(), range.end()))
    {}
    Json(std::initializer_list<Member> members);  // an object, in this order
    Json(const Json& other);
    Json(Json&& other) noexcept;
    Json& operator=(const Json& other);
    Json& operator=(Json&& other) noexcept;
    ~Json();

    static Json array(std::initializer_list<Json> elements = {});
    static Json object();
    // Nothing if `text` is not JSON, or is nested hundreds of levels deep.
    static std::optional<Json> parse(const std::string& text);

    void append(Json element);                      // to an array
    void set(const std::string& name, Json value);  // sets a member of an object; an existing one keeps its place
    void update(const Json& object);                // sets each member of `object`

    // `indent` spaces per level; -1: all on one line. Infinities and NaN become null; bytes that are not UTF-8 become U+FFFD.
    std::string dump(int indent = -1) const;

    bool isNull() const;
    bool isObject() const;
    bool isArray() const;
    bool isText() const;
    bool isNumber() const;
    bool isBoolean() const;
    const std::vector<Member>& members() const;       // of an object; throws JsonError
    bool is(const std::string& text) const;           // whether it is this string
    const Json* find(const std::string& name) const;  // null if there is no such member or this is no object
    // These throw JsonError.
    const Json& at(const std::string& name) const;
    const Json& at(std::size_t index) const;
    const std::vector<Json>& elements() const;
    const std::string& text() const;
    double number() const;
    std::uint32_t count() const;  // an unsigned 32-bit integer
    bool boolean() const;

private:
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;
    using Value = std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>;
    friend struct JsonConversion;

    template <class T>
    static auto store(T number)
    {
        if constexpr (std::is_same_v<T, bool>) {
            return number;
        } else if constexpr (std::is_floating_point_v<T>) {
            return static_cast<double>(number);
        } else if constexpr (std::is_signed_v<T>) {
            return static_cast<std::int64_t>(number);
        } else {
            return static_cast<std::uint64_t>(number);
        }
    }
    template <class Iterator>
    static Json makeArray(Iterator begin, Iterator end)
    {
        Json json = array();
        for (; begin != end; ++begin) {
            json.append(*begin);
        }
        return json;
    }

    Value value_;
};

struct Json::Member {
    std::string name;
    Json value;
};

}  // namespace glim
