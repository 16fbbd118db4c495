#include "host/job/shown_options.hpp"

#include "host/flatten/camera_options.hpp"
#include "host/job/parse.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace glim {
namespace {

std::string textOf(const glm::vec3& v) { return exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z); }

// As a command line has it: lists without brackets and words without quotes where that says the same.
std::string textOf(const Edit& edit)
{
    const std::optional<Json> value = Json::parse(edit.value);
    if (value && value->isText() && parseEdit({edit.pointer, *value}).value == edit.value) {
        return value->text();
    }
    if (value && value->isNumber()) {
        return OptionValue(*value).text();
    }
    if (value && value->isArray() && value->elements().size() > 1 && std::ranges::all_of(value->elements(), &Json::isNumber)) {
        return OptionValue(*value).text();
    }
    return edit.value;
}

void listFloor(const SceneFloor& floor, std::vector<ShownOption>& options)
{
    options.push_back({"floor", "", floor.height ? exactText(*floor.height) : "lowest"});
    if (floor.color != SceneFloor().color) {
        options.push_back({"floor-color", "", textOf(floor.color)});
    }
    if (floor.roughness) {
        options.push_back({"floor-roughness", "", exactText(*floor.roughness)});
    }
    if (floor.backdrop) {
        options.push_back({"backdrop", "", exactText(*floor.backdrop)});
    }
}

void listLightGroups(const LightGroupChoice& choice, std::vector<ShownOption>& options)
{
    for (const LightGroup& group : choice.groups) {
        std::string lights;
        for (const std::string& light : group.lights) {
            lights += (lights.empty() ? "" : ",") + light;
        }
        options.push_back({"light-group", group.name, lights});
    }
    if (choice.each) {
        options.push_back({"light-group", "", "each"});
    }
}

// Each pointer has one value, the last.
void listSet(const std::vector<Edit>& edits, std::vector<ShownOption>& options)
{
    for (auto edit = edits.begin(); edit != edits.end(); ++edit) {
        if (std::none_of(edit + 1, edits.end(), [&](const Edit& later) { return later.pointer == edit->pointer; })) {
            options.push_back({"set", edit->pointer, textOf(*edit)});
        }
    }
}

// Every member of LoadOptions is named here, so that a new one does not compile before it is listed.
void listScene(const LoadOptions& load, std::vector<ShownOption>& options)
{
    const auto& [scene, environment, environmentRotation, environmentStrength, environmentBackground, sun, showsBackFaces, pointRadius,
                 lineRadius, missingTextures, confined, maxTexture, variant, at, shutter, animation, aspectRatio, yfov, framed, floor,
                 lightGroups, catchers, edits, additions] = load;
    static_cast<void>(aspectRatio);  // by --size,
    static_cast<void>(yfov);         // --fov,
    static_cast<void>(framed);       // and --camera
    const auto add = [&options](bool isGiven, const std::string& name, const std::string& value) {
        if (isGiven) {
            options.push_back({name, "", value});
        }
    };
    add(scene.has_value(), "scene", std::to_string(scene.value_or(0)));
    add(!variant.empty(), "variant", variant);
    add(environment.has_value(), "environment", environment ? describeEnvironment(*environment) : "");
    add(environmentRotation != 0.0F, "environment-rotation", exactText(environmentRotation));
    add(environmentStrength != 1.0F, "environment-strength", exactText(environmentStrength));
    add(!environmentBackground, "environment-background", "off");
    add(sun.has_value(), "sun", sun ? describeSun(*sun) : "");
    add(showsBackFaces, "back-faces", "shown");
    add(pointRadius.has_value(), "point-radius", exactText(pointRadius.value_or(0.0)));
    add(lineRadius.has_value(), "line-radius", exactText(lineRadius.value_or(0.0)));
    if (floor) {
        listFloor(*floor, options);
    }
    for (const std::string& catcher : catchers) {
        add(true, "catcher", catcher);
    }
    listLightGroups(lightGroups, options);
    for (const Addition& addition : additions) {
        add(true, "add", describeAddition(addition));
    }
    add(missingTextures == MissingTextures::Grey, "missing-textures", "grey");
    add(maxTexture != kMaxImageSide, "max-texture", std::to_string(maxTexture));
    add(confined, "confine", "");
    add(at.has_value(), "at", exactText(at.value_or(0.0)));
    add(at.has_value() && !animation.empty(), "animation", animation);
    add(at.has_value() && shutter.has_value(), "shutter", shutter ? describeShutter(*shutter) : "");
    listSet(edits, options);
}

void listLook(const LookOptions& look, std::vector<ShownOption>& options)
{
    if (look.exposure != LookOptions().exposure) {
        options.push_back({"exposure", "", look.exposure ? exactText(*look.exposure) : "auto"});
    }
    if (look.tone) {
        options.push_back({"tone", "", getName(*look.tone)});
    }
}

std::string quoted(const std::string& word)
{
    const std::string plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789%+,-./:=@^_";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
        return word;
    }
    std::string text = "'";
    for (const char c : word) {
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return text + "'";
}

// A number or a list of numbers where that reads back as the same text would.
Json valueOf(const std::string& text)
{
    Json numbers = Json::array();
    for (const std::string& part : OptionValue(text).split(',')) {
        double number = 0.0;
        const char* end = part.data() + part.size();
        const auto [stop, error] = std::from_chars(part.data(), end, number);
        if (error != std::errc() || stop != end || !(std::abs(number) < 0x1p53) || OptionValue(Json(number)).text() != part) {
            return text;
        }
        numbers.append(number == std::floor(number) ? Json(static_cast<std::int64_t>(number)) : Json(number));
    }
    return numbers.elements().size() == 1 ? numbers.at(0) : numbers;
}

bool isFlag(const ShownOption& option) { return option.key.empty() && option.value.empty(); }

std::string wordOf(const ShownOption& option) { return option.key.empty() ? option.value : option.key + "=" + option.value; }

}  // namespace

std::vector<ShownOption> listShownOptions(const ShownPicture& shown)
{
    std::vector<ShownOption> options{{"camera", "", shown.camera}};
    for (const auto& [name, value] : cameraOptions(shown.pose, shown.field, shown.lens, shown.projection)) {
        options.push_back({name, "", value});
    }
    options.push_back({"size", "", std::to_string(shown.size.x) + "x" + std::to_string(shown.size.y)});
    listLook(shown.look, options);
    listScene(shown.load, options);
    return options;
}

std::string toCommandLine(const std::vector<ShownOption>& options)
{
    std::string line;
    for (const ShownOption& option : options) {
        line += (line.empty() ? "--" : " --") + option.name;
        line += isFlag(option) ? "" : " " + quoted(wordOf(option));
    }
    return line;
}

Json toEdits(const std::vector<ShownOption>& options)
{
    Json edits = Json::object();
    for (auto option = options.begin(); option != options.end();) {
        const auto end = std::find_if(option, options.end(), [&](const ShownOption& other) { return other.name != option->name; });
        Json value = isFlag(*option) ? Json(true) : valueOf(option->value);
        if (std::all_of(option, end, [](const ShownOption& one) { return !one.key.empty(); })) {
            value = Json::object();
            std::for_each(option, end, [&value](const ShownOption& one) { value.set(one.key, valueOf(one.value)); });
        } else if (end - option > 1) {
            value = Json::array();
            std::for_each(option, end, [&value](const ShownOption& one) { value.append(wordOf(one)); });
        }
        edits.set(option->name, value);
        option = end;
    }
    return edits;
}

}  // namespace glim
