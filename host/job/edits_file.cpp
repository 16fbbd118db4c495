#include "host/job/edits_file.hpp"

#include "host/input_file.hpp"
#include "host/job/parse.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <variant>

namespace fs = std::filesystem;

namespace glim {
namespace {

constexpr std::uintmax_t kMaxMebibytes = 16;
constexpr const char* kExample = R"({"set": {"/nodes/lamp/translation": [0, 2, 0]}, "sun": [30, 45, 1000]})";

// What is shown, not how it is sampled and where it is written.
constexpr const char* kShown[] = {"--scene",
                                  "--variant",
                                  "--at",
                                  "--animation",
                                  "--shutter",
                                  "--environment",
                                  "--environment-rotation",
                                  "--environment-strength",
                                  "--environment-background",
                                  "--sun",
                                  "--back-faces",
                                  "--point-radius",
                                  "--line-radius",
                                  "--floor",
                                  "--floor-color",
                                  "--floor-roughness",
                                  "--backdrop",
                                  "--catcher",
                                  "--catcher-reflections",
                                  "--light-group",
                                  "--set",
                                  "--add",
                                  "--missing-textures",
                                  "--max-texture",
                                  "--confine",
                                  "--size",
                                  "--camera",
                                  "--look-from",
                                  "--look-at",
                                  "--look-up",
                                  "--fov",
                                  "--zoom",
                                  "--lens-radius",
                                  "--focal-distance",
                                  "--focus",
                                  "--pose-gltf",
                                  "--pose-opencv",
                                  "--intrinsics",
                                  "--intrinsics-opencv",
                                  "--distortion",
                                  "--fisheye",
                                  "--shift",
                                  "--projection",
                                  "--crop",
                                  "--exposure",
                                  "--tone"};

std::string readText(const fs::path& file)
{
    try {
        requireFile(file, "a file of JSON");
    } catch (const InputError& error) {
        throw UsageError(Message(error.message(), {part::place("--edits"), ": ", error.message().sentence}));
    }
    std::error_code unknown;
    if (fs::file_size(file, unknown) > kMaxMebibytes << 20U) {
        throw UsageError(MessageId::TooLarge, {part::place("--edits"), ": ", part::file(file), ": is too large; expected ",
                                               part::expected("at most " + std::to_string(kMaxMebibytes) + " MiB")});
    }
    std::ifstream stream(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) {
        throw UsageError(MessageId::FileUnreadable, {part::place("--edits"), ": ", part::file(file), ": cannot be read"});
    }
    return text;
}

// The texts of a value, or the names of its members, as `rename` says.
Json renamed(const Json& value, const std::function<std::string(const std::string&)>& rename)
{
    Json result = value.isText() ? Json(rename(value.text())) : value.isArray() ? Json::array() : value.isObject() ? Json::object() : value;
    if (value.isArray()) {
        for (const Json& element : value.elements()) {
            result.append(element.isText() ? Json(rename(element.text())) : element);
        }
    } else if (value.isObject()) {
        for (const Json::Member& member : value.members()) {
            result.set(rename(member.name), member.value);
        }
    }
    return result;
}

// The value with names of files that begin in `folder`, unless they are absolute.
Json valueWithin(const fs::path& folder, const std::string& option, const Json& value)
{
    const auto within = [&folder](const std::string& name) { return (folder / name).string(); };
    // A pointer into an added file names it as --add does, or without its folder.
    const auto pointerWithin = [&within](const std::string& pointer) {
        const std::string file = pointer.substr(0, pointer.find("#/"));
        const bool hasFolder = file.size() < pointer.size() && fs::path(file).has_parent_path();
        return hasFolder ? within(file) + pointer.substr(file.size()) : pointer;
    };
    const auto isMap = [&value] { return std::holds_alternative<fs::path>(parseEnvironment(OptionValue(value))); };
    if (option == "--add" || (option == "--environment" && value.isText() && isMap())) {
        return renamed(value, within);
    }
    return option == "--set" ? renamed(value, pointerWithin) : value;
}

// The option's name. Refuses what is not of what is shown.
std::string nameOf(const OptionTable& table, const std::string& name)
{
    const MessagePart expected = part::expected("an option of scene, camera, lens, time or look");
    const std::string* option = nullptr;
    try {
        option = &table.entry(name).name();
    } catch (const UsageError& unknown) {
        throw UsageError(Message(unknown.message(), {unknown.message().sentence, "; expected ", expected}));
    }
    if (std::ranges::find(kShown, *option) == std::end(kShown)) {
        throw UsageError(MessageId::Unsupported, {part::place(*option), ": is not of what is shown; expected ", expected});
    }
    return *option;
}

void setByText(OptionTable& table, const fs::path& file, const std::string& text)
{
    const std::optional<Json> options = Json::parse(text);
    if (!options || !options->isObject()) {
        throw UsageError(MessageId::Malformed, {"expected ", part::expected("a JSON object of options"), ", as in ", kExample});
    }
    for (const auto& [name, value] : options->members()) {
        const std::string option = nameOf(table, name);
        table.setByFile(file, option, valueWithin(file.parent_path(), option, value));
    }
}

}  // namespace

void addEdits(OptionTable& table)
{
    table
        .add("--edits", "FILE.json", "Options of scene, camera, time and look from a file; those given here come first",
             [&table](const OptionValue& value) {
                 const fs::path file = value.text();
                 const std::string text = readText(file);
                 try {
                     setByText(table, file, text);
                 } catch (const UsageError& error) {
                     throw UsageError(Message(error.message(), {part::file(file), ": ", error.message().sentence}));
                 }
             })
        .holds(OptionKind::Path);
}

}  // namespace glim
