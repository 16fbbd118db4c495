#include "host/job/parse.hpp"

#include "host/text.hpp"

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <regex>
#include <sstream>

namespace glim {
namespace {

// The whole of `text` as a number, or nothing.
template <class T>
bool parseNumber(const std::string& text, T& value)
{
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end && !text.empty();
}

std::string join(const std::vector<std::string>& parts, const std::string& separator)
{
    std::string text;
    for (const std::string& part : parts) {
        text += (text.empty() ? "" : separator) + part;
    }
    return text;
}

// Three finite numbers.
template <class Vector>
bool parseTriple(const OptionValue& value, Vector& triple)
{
    const std::vector<std::string> parts = value.split(',');
    bool valid = parts.size() == 3;
    for (int k = 0; valid && k < 3; ++k) {
        valid = parseNumber(parts[static_cast<std::size_t>(k)], triple[k]) && std::isfinite(triple[k]);
    }
    return valid;
}

template <class T>
std::string toText(T number)
{
    std::ostringstream text;
    text << number;
    return text.str();
}

// `text` has the right form if `isWellFormed`.
[[noreturn]] void refuseValue(const std::string& option, const std::string& text, bool isWellFormed, const std::string& expected)
{
    throw UsageError(isWellFormed ? MessageId::OutOfRange : MessageId::Malformed,
                     {part::place(option), ": ", part::quoted(text), ": expected ", part::expected(expected)});
}

template <class T>
T parseBounded(const NumberOption<T>& option, const OptionValue& given, const std::string& others = "")
{
    T value{};
    const std::string text = given.text();
    const std::string unsignedText = text.substr(text.rfind('+', 0) == 0 ? 1 : 0);
    // NaN fails both comparisons.
    if (!parseNumber(unsignedText, value) || !(value >= option.low && value <= option.high)) {
        double number = 0.0;
        const bool isNumber = parseNumber(unsignedText, number) && (!std::is_integral_v<T> || number == std::floor(number));
        refuseValue(option.name, text, isNumber,
                    std::string(std::is_integral_v<T> ? "a whole number" : "a number") + " from " + toText(option.low) + " to " +
                        toText(option.high) + others);
    }
    return value;
}

}  // namespace

template <class T>
Option addNumber(OptionTable& table, const NumberOption<T>& option, std::function<void(T)> store)
{
    const std::string help = option.what + ", " + toText(option.low) + " to " + toText(option.high) + " [" + option.fallback + "]";
    return table.add(option.name, option.unit, help, [option, store](const OptionValue& value) { store(parseBounded(option, value)); })
        .holds(std::is_integral_v<T> ? OptionKind::Whole : OptionKind::Number);
}

template Option addNumber(OptionTable&, const NumberOption<std::uint32_t>&, std::function<void(std::uint32_t)>);
template Option addNumber(OptionTable&, const NumberOption<float>&, std::function<void(float)>);
template Option addNumber(OptionTable&, const NumberOption<double>&, std::function<void(double)>);

Option addChoice(OptionTable& table, const std::string& name, const std::string& unit, const std::string& help,
                 const std::vector<std::string>& names, std::function<void(std::size_t)> store)
{
    return table
        .add(name, unit, help,
             [name, names, store](const OptionValue& value) {
                 const std::string text = value.boolean() ? (*value.boolean() ? "on" : "off") : value.text();
                 const auto found = std::find(names.begin(), names.end(), text);
                 if (found == names.end()) {
                     throw UsageError(MessageId::UnknownName,
                                      {part::place(name), ": ", part::quoted(text), ": expected ", part::expected(join(names, " or "))});
                 }
                 store(static_cast<std::size_t>(found - names.begin()));
             })
        .holds(OptionKind::Choice, names);
}

Option addSceneIndex(OptionTable& table, std::optional<std::size_t>& index)
{
    constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();
    return addNumber<std::uint32_t>(table, {"--scene", "INDEX", "Scene of the file", 0, kMax, "the file's default scene"},
                                    [&index](std::uint32_t value) { index = value; });
}

glm::uvec2 parseSize(const OptionValue& value, const std::string& option)
{
    const std::string text = value.text();
    const std::vector<std::string> parts = value.split('x');
    glm::uvec2 size(0);
    const bool areNumbers = parts.size() == 2 && parseNumber(parts[0], size.x) && parseNumber(parts[1], size.y);
    if (!areNumbers || size.x == 0 || size.y == 0 || size.x > kMaxSide || size.y > kMaxSide) {
        refuseValue(option, text, areNumbers, "WIDTHxHEIGHT in pixels, each 1 to " + std::to_string(kMaxSide) + ", as in 640x480");
    }
    return size;
}

FrameRange parseFrames(const OptionValue& value)
{
    constexpr std::uint32_t kMaxFrame = 999999999;
    const std::string text = value.text();
    const std::vector<std::string> parts = value.split(':');
    FrameRange range;
    const bool areNumbers = (parts.size() == 2 || parts.size() == 3) && parseNumber(parts[0], range.first) &&
                            parseNumber(parts[1], range.last) && (parts.size() == 2 || parseNumber(parts[2], range.step));
    if (!areNumbers || range.first > range.last || range.last > kMaxFrame || range.step == 0) {
        refuseValue("--frames", text, areNumbers, "FIRST:LAST or FIRST:LAST:STEP with FIRST <= LAST and STEP >= 1, as in 1:250");
    }
    return range;
}

std::pair<std::uint32_t, std::uint32_t> parseRange(const std::string& option, const OptionValue& value, std::uint32_t most)
{
    const std::string text = value.text();
    const std::vector<std::string> parts = value.split(':');
    std::pair<std::uint32_t, std::uint32_t> range;
    const bool areNumbers = parts.size() == 2 && parseNumber(parts[0], range.first) && parseNumber(parts[1], range.second);
    if (!areNumbers || range.first >= range.second || range.second > most) {
        refuseValue(option, text, areNumbers, "BEGIN:END with BEGIN < END <= " + std::to_string(most) + ", as in 0:256");
    }
    return range;
}

std::vector<double> parseNumbers(const std::string& option, const OptionValue& value, const std::vector<std::size_t>& counts,
                                 const std::string& expected)
{
    const std::vector<std::string> parts = value.split(',');
    std::vector<double> numbers(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (!parseNumber(parts[i], numbers[i]) || !std::isfinite(numbers[i])) {
            refuseValue(option, value.text(), false, expected);
        }
    }
    if (std::ranges::find(counts, parts.size()) == counts.end()) {
        refuseValue(option, value.text(), false, expected);
    }
    return numbers;
}

Shutter parseShutter(const OptionValue& value)
{
    constexpr double kLongest = 1e6;
    const std::string expected =
        "OPEN,CLOSE in seconds from the frame's time, OPEN at most 0, CLOSE at least 0 and not both 0, as in 0,0.02";
    const std::vector<double> times = parseNumbers("--shutter", value, {2}, expected);
    if (!(times[0] <= 0.0 && times[1] >= 0.0 && times[1] > times[0] && times[1] - times[0] <= kLongest)) {
        refuseValue("--shutter", value.text(), true, expected);
    }
    return {times[0] + 0.0, times[1] + 0.0};
}

std::string describeShutter(const Shutter& shutter) { return exactText(shutter.open) + "," + exactText(shutter.close); }

double parsePercent(const std::string& option, const OptionValue& value)
{
    const std::string text = value.text();
    double percent = 0.0;
    if (value.isNumber() && parseNumber(text, percent) && percent > 0.0 && percent <= 10.0) {
        return percent;
    }
    const bool isPercent = !text.empty() && text.back() == '%' && parseNumber(text.substr(0, text.size() - 1), percent);
    if (!isPercent || !(percent > 0.0 && percent <= 1000.0)) {
        const bool lacksSign = !isPercent && parseNumber(text, percent);
        refuseValue(option, text, isPercent || value.isNumber(),
                    lacksSign ? text + "%, with its sign, for so many percent of the mean"
                              : "more than 0 and at most 1000 percent of the mean, as in 1%");
    }
    return 0.01 * percent;
}

std::optional<double> parseExposure(const OptionValue& value)
{
    if (value.text() == "auto") {
        return std::nullopt;
    }
    return parseBounded<double>({"--exposure", "", "", -100.0, 100.0, ""}, value, ", or auto");
}

Edit parseEdit(const OptionValue& value)
{
    const std::string text = value.text();
    const std::size_t equals = value.key().empty() ? text.find('=') : 0;
    Edit edit{value.key().empty() ? text.substr(0, equals) : value.key(),
              value.key().empty() ? text.substr(std::min(equals, text.size() - 1) + 1) : text};
    if (!(edit.pointer.starts_with('/') || edit.pointer.find("#/") != std::string::npos) || equals == std::string::npos) {
        refuseValue("--set", value.key() + text, false,
                    "a pointer and a value, as in /materials/0/pbrMetallicRoughness/roughnessFactor=0.2");
    }
    const std::vector<std::string> parts = OptionValue(edit.value).split(',');
    Json numbers = Json::array();
    for (const std::string& part : parts) {
        double number = 0.0;
        if (parseNumber(part, number) && std::isfinite(number)) {
            numbers.append(number);
        }
    }
    if (numbers.elements().size() == parts.size()) {  // JSON has no .5
        edit.value = parts.size() == 1 && !value.isList() ? numbers.at(0).dump() : numbers.dump();
    } else if (value.isList()) {
        throw UsageError(MessageId::WrongType, {part::place("--set"), ": ", part::value(edit.pointer), ": expected ",
                                                part::expected("a number, a list of numbers, true, false or a word")});
    } else if (!Json::parse(edit.value)) {
        edit.value = Json(edit.value).dump();  // a word
    }
    return edit;
}

void parseLightGroup(const OptionValue& value, LightGroupChoice& choice)
{
    const std::string text = value.text();
    if (value.key().empty() && text == "each") {
        choice.each = true;
        return;
    }
    const std::size_t equals = text.find('=');
    const bool isMember = !value.key().empty();
    const LightGroup group{isMember ? value.key() : text.substr(0, equals), isMember ? value.split(',')
                                                                            : equals == std::string::npos
                                                                                ? std::vector<std::string>()
                                                                                : OptionValue(text.substr(equals + 1)).split(',')};
    const bool isName = !group.name.empty() &&
                        std::ranges::none_of(group.name, [](unsigned char c) { return c <= ' ' || c == '.' || c == ',' || c == ':'; });
    const bool areLights = !group.lights.empty() && std::ranges::none_of(group.lights, &std::string::empty);
    if (!isName || !areLights) {
        refuseValue("--light-group", text, false,
                    "each, or a name without spaces, dots, commas and colons and its lights, as in key=Lamp,Bulb*");
    }
    const bool isKnown = std::ranges::any_of(choice.groups, [&](const LightGroup& other) { return other.name == group.name; });
    if (isKnown || group.name == kOtherLights) {
        refuseValue("--light-group", text, true, isKnown ? "each name once" : "another name, as \"others\" are all lights without a group");
    }
    choice.groups.push_back(group);
}

LightWeight parseLightWeight(const OptionValue& value)
{
    const std::string text = value.text();
    const std::size_t equals = value.key().empty() ? text.find('=') : 0;
    const std::string name = value.key().empty() ? text.substr(0, equals) : value.key();
    const std::string rest = value.key().empty() ? text.substr(std::min(equals, text.size() - 1) + 1) : text;
    LightWeight weight{name};
    float factor = 0.0F;
    const bool isNumber = parseNumber(rest, factor);
    const bool isValid = equals != std::string::npos && !name.empty() && (isNumber || parseTriple(OptionValue(rest), weight.factor));
    weight.factor = isNumber ? glm::vec3(factor) : weight.factor;
    if (!isValid || !(weight.factor.r >= 0.0F && weight.factor.g >= 0.0F && weight.factor.b >= 0.0F) || !std::isfinite(factor)) {
        refuseValue("--light", text, isValid, "a light group and a factor or R,G,B, 0 or more, as in key=0.5");
    }
    return weight;
}

Addition parseAddition(const OptionValue& value)
{
    constexpr std::size_t kOfPoint = 3, kOfMatrix = 16;
    const std::string text = value.text();
    const std::size_t at = text.rfind('@');
    const bool isMember = !value.key().empty();
    const std::vector<std::string> parts = isMember                  ? value.split(',')
                                           : at == std::string::npos ? std::vector<std::string>()
                                                                     : OptionValue(text.substr(at + 1)).split(',');
    std::vector<double> numbers;
    for (const std::string& part : parts) {
        double number = 0.0;
        if (parseNumber(part, number) && std::isfinite(number)) {
            numbers.push_back(number);
        }
    }
    const bool areNumbers = numbers.size() == parts.size() && (numbers.size() == kOfPoint || numbers.size() == kOfMatrix);
    // An @ may be part of a file's name, unless numbers follow.
    if (isMember ? !areNumbers : !numbers.empty() && !areNumbers) {
        refuseValue("--add", isMember ? value.key() + " " + text : text, false,
                    "a file, then if need be @ and its place: x,y,z in metres, or the 16 numbers of a matrix, column by column");
    }
    Addition addition{isMember ? value.key() : areNumbers ? text.substr(0, at) : text};
    if (numbers.size() == kOfPoint) {
        addition.worldFromFile = glm::translate(glm::dmat4(1.0), glm::dvec3(numbers[0], numbers[1], numbers[2]));
    } else if (areNumbers) {
        addition.worldFromFile = glm::make_mat4(numbers.data());
        const glm::dvec4 row = glm::row(addition.worldFromFile, 3);
        if (row != glm::dvec4(0.0, 0.0, 0.0, 1.0) || glm::determinant(glm::dmat3(addition.worldFromFile)) == 0.0) {
            throw UsageError(MessageId::Degenerate, {part::place("--add"), ": ", part::quoted(text), ": expected ",
                                                     part::expected("an invertible matrix whose last row is 0 0 0 1")});
        }
    }
    if (addition.file.empty()) {
        throw UsageError(MessageId::Missing,
                         {part::place("--add"), ": ", part::quoted(text), ": expected ", part::expected("a file before the @")});
    }
    return addition;
}

std::string describeAddition(const Addition& addition)
{
    std::string text = addition.file.string();
    for (int i = 0; i < 16 && addition.worldFromFile != glm::dmat4(1.0); ++i) {
        text += (i == 0 ? "@" : ",") + exactText(addition.worldFromFile[i / 4][i % 4]);
    }
    return text;
}

SamplePlace parseSample(const OptionValue& value)
{
    const std::string text = value.text();
    const std::vector<std::string> parts = value.split(',');
    SamplePlace place{};
    const bool areNumbers =
        parts.size() == 3 && parseNumber(parts[0], place.x) && parseNumber(parts[1], place.y) && parseNumber(parts[2], place.sample);
    if (!areNumbers || place.x >= kMaxSide || place.y >= kMaxSide || place.sample >= kMaxSample) {
        refuseValue("--replay", text, areNumbers,
                    "X,Y,SAMPLE with whole numbers X and Y from 0 to " + std::to_string(kMaxSide - 1) + " and SAMPLE from 0 to " +
                        std::to_string(kMaxSample - 1) + ", as in 12,40,7");
    }
    return place;
}

glm::uvec2 parsePixel(const std::string& option, const OptionValue& value)
{
    const std::vector<std::string> parts = value.split(',');
    glm::uvec2 pixel(0);
    const bool areNumbers = parts.size() == 2 && parseNumber(parts[0], pixel.x) && parseNumber(parts[1], pixel.y);
    if (!areNumbers || std::max(pixel.x, pixel.y) >= kMaxSide) {
        refuseValue(option, value.text(), areNumbers,
                    "X,Y with whole numbers from 0 to " + std::to_string(kMaxSide - 1) + ", as in 320,240");
    }
    return pixel;
}

constexpr double kMaxSeconds = 1e9;  // 30 years

double parseDuration(const std::string& option, const OptionValue& given)
{
    double seconds = 0.0;
    const std::string text = given.text() + (parseNumber(given.text(), seconds) ? "s" : "");
    const double unit = text.empty() ? 0.0 : text.back() == 's' ? 1.0 : text.back() == 'm' ? 60.0 : text.back() == 'h' ? 3600.0 : 0.0;
    double value = 0.0;
    const bool isTime = unit != 0.0 && parseNumber(text.substr(0, text.size() - 1), value);
    if (!isTime || !(value > 0.0) || !(value * unit <= kMaxSeconds)) {
        refuseValue(option, given.text(), isTime, "a time above 0 in seconds or with its unit, as in 90, 5m or 1h");
    }
    return value * unit;
}

float parseSurvival(const OptionValue& value)
{
    const std::string text = value.text();
    const std::string start = "fixed:";
    float survival = 0.0F;
    const bool isNumber = text.starts_with(start) && parseNumber(text.substr(start.size()), survival);
    if (!isNumber || !std::isnormal(survival) || !(survival > 0.0F && survival <= 1.0F)) {
        refuseValue("--roulette", text, isNumber, "throughput, none or fixed:P with 0 < P <= 1, as in fixed:0.7");
    }
    return survival;
}

EnvironmentChoice parseEnvironment(const OptionValue& value)
{
    const std::string text = value.text();
    if (text == "none" || text == "studio") {
        return text == "none" ? BuiltInEnvironment::None : BuiltInEnvironment::Studio;
    }
    const bool isMap = std::regex_search(text, std::regex("\\.(hdr|exr)$", std::regex::icase));
    return isMap ? EnvironmentChoice(std::filesystem::path(text)) : EnvironmentChoice(parseRadiance(value));
}

std::string describeEnvironment(const EnvironmentChoice& choice)
{
    if (const auto* radiance = std::get_if<glm::vec3>(&choice)) {
        return exactText(radiance->r) + "," + exactText(radiance->g) + "," + exactText(radiance->b);
    }
    if (const auto* file = std::get_if<std::filesystem::path>(&choice)) {
        return file->string();
    }
    return std::get<BuiltInEnvironment>(choice) == BuiltInEnvironment::None ? "none" : "studio";
}

Sun parseSun(const OptionValue& value)
{
    const std::string text = value.text();
    glm::dvec3 triple(0.0);
    const bool isTriple = parseTriple(value, triple);
    if (!isTriple || std::abs(triple.x) > 360.0 || std::abs(triple.y) > 90.0 || !(triple.z >= 0.0 && triple.z <= 1e30)) {
        refuseValue("--sun", text, isTriple,
                    "azimuth and elevation in degrees, within 360 and 90, and an irradiance >= 0 in W/m^2, as in 30,45,1000");
    }
    return {triple.x, triple.y, static_cast<float>(triple.z)};
}

std::string describeSun(const Sun& sun)
{
    return exactText(sun.azimuth) + "," + exactText(sun.elevation) + "," + exactText(sun.irradiance);
}

std::optional<double> parseFloorHeight(const OptionValue& value)
{
    double height = 0.0;
    if (value.text() == "lowest") {
        return std::nullopt;
    }
    const bool isNumber = parseNumber(value.text(), height);
    if (!isNumber || !(std::abs(height) <= 1e9)) {
        refuseValue("--floor", value.text(), isNumber, "lowest, or a height within 1e9 metres of 0, as in 0.5");
    }
    return height;
}

glm::vec3 parseReflectance(const std::string& option, const OptionValue& value)
{
    glm::vec3 color(0.0F);
    const bool isTriple = parseTriple(value, color);
    if (!isTriple || glm::any(glm::lessThan(color, glm::vec3(0.0F))) || glm::any(glm::greaterThan(color, glm::vec3(1.0F)))) {
        refuseValue(option, value.text(), isTriple, "three numbers from 0 to 1, as in 0.8,0.5,0.1");
    }
    return color;
}

glm::vec3 parseRadiance(const OptionValue& value)
{
    const std::string text = value.text();
    glm::vec3 radiance(0.0F);
    const bool isTriple = parseTriple(value, radiance);
    if (!isTriple || glm::any(glm::lessThan(radiance, glm::vec3(0.0F)))) {
        refuseValue("--environment", text, isTriple,
                    "the name of a .hdr or .exr map, a constant radiance R,G,B with numbers >= 0, as in 1,1,1, studio or none");
    }
    return radiance;
}

glm::dvec3 parsePoint(const std::string& option, const OptionValue& value)
{
    glm::dvec3 point(0.0);
    if (!parseTriple(value, point)) {
        refuseValue(option, value.text(), false, "three numbers, as in 1,2.5,-3");
    }
    return point;
}

}  // namespace glim
