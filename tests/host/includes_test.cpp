// Rules over the text of the sources: the direction of dependencies, the folders that own a library, what a shader file may
// declare. A test shows of each rule that it finds what it forbids.
#include "places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace glim {
namespace {

struct Source {
    std::string path;  // from the project root
    std::string text;
};

const std::set<std::string> kForAll{
    "host/clock.hpp",      "host/digest.hpp", "host/digest.cpp",  "host/fingerprint.hpp",   "host/error.hpp",       "host/text.hpp",
    "host/json.hpp",       "host/json.cpp",   "host/message.hpp", "host/message_id.hpp",    "host/message.cpp",     "host/input_file.hpp",
    "host/input_file.cpp", "host/memory.hpp", "host/memory.cpp",  "host/shared_vector.hpp", "host/atomic_file.hpp", "host/atomic_file.cpp"};

// What each folder of host/ stands directly on; what those stand on is allowed as well.
const std::map<std::string, std::set<std::string>> kStandsOn{
    {"main.cpp", {"cli"}},
    {"cli", {"job", "preview", "view", "bench"}},
    {"job", {"denoise"}},
    {"preview", {"job", "window"}},
    {"view", {"measure", "window"}},
    {"window", {"render"}},
    {"bench", {"measure"}},
    {"denoise", {"measure"}},
    {"measure", {"render"}},
    {"render", {"flatten", "gpu"}},
    {"flatten", {"bvh", "shaders/shared"}},
    {"bvh", {"scene", "shaders/shared"}},    // the depth of the traversal stack is a shared limit
    {"scene", {"image", "shaders/shared"}},  // the table of texture slots
    {"image", {}},
    {"gpu", {"spirv"}},
    {"spirv", {}},
    {"shaders/shared", {}},
};

// How an include begins, and the folders of host/ that own what it brings. Vulkan's types pass on to render and preview
// through gpu's headers.
const std::vector<std::pair<std::string, std::set<std::string>>> kOwners{
    {"tiny_gltf", {"scene"}},
    {"OpenEXR/", {"image"}},
    {"Imath/", {"image"}},
    {"Imf", {"image"}},
    {"draco/", {"scene"}},
    {"meshoptimizer", {"scene"}},
    {"png.h", {"image"}},
    {"jpeglib.h", {"image"}},
    {"webp/", {"image"}},
    {"zstd.h", {"image"}},
    {"imgui", {"window", "preview", "view", "gpu"}},
    {"GLFW/", {"window"}},
    {"vulkan/", {"gpu"}},
    {"commit.h", {"job"}},
    {"version.h", {"job", "render"}},
    {"specializer.h", {"gpu"}},
    {"glsl_options.h", {"preview"}},
    {"kernels.hpp", {"render", "denoise", "gpu"}},
    {"spirv-tools/", {"gpu", "spirv"}},
    {"nlohmann/", {"scene"}},
    {"backends/imgui", {"gpu"}},
};

// What the harness of tests takes of glim, besides host/gpu and what that stands on: a file that stands on nothing.
const std::string kTakenByHarness = "tests/harness/files.cmake";
const std::set<std::string> kForHarness{"host/measure/confidence.hpp", "host/measure/confidence.cpp"};
const std::set<std::string> kGenerated{"harness_places.h", "kernels.hpp", "specializer.h"};

// A library whose templates cost seconds in every file that includes it.
const std::string kCommandLineLibrary = "CLI/", kCommandLineOwner = "host/cli/command.cpp";

const std::vector<std::string> kShaderFolders{"shared", "lib", "access", "kernels"};  // each may include itself and those before

bool startsWith(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

// The n-th part of a path: part("host/bvh/bvh.hpp", 1) is "bvh".
std::string part(const std::string& path, std::size_t n)
{
    const std::filesystem::path split(path);
    const auto size = static_cast<std::size_t>(std::distance(split.begin(), split.end()));
    return n < size ? std::next(split.begin(), static_cast<std::ptrdiff_t>(n))->string() : "";
}

std::set<std::string> findAllBelow(const std::string& folder)
{
    std::set<std::string> below{folder};
    for (const std::string& next : kStandsOn.at(folder)) {
        below.merge(findAllBelow(next));
    }
    return below;
}

struct Include {
    std::string target;
    bool quoted;
};

std::vector<Include> findIncludes(const std::string& text)
{
    static const std::regex kInclude(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">])");
    std::vector<Include> includes;
    for (std::sregex_iterator i(text.begin(), text.end(), kInclude), end; i != end; ++i) {
        includes.push_back({(*i)[2], (*i)[1] == "\""});
    }
    return includes;
}

// By hand: std::regex recurses once per character and would run out of stack in a long comment.
std::string removeComments(const std::string& text)
{
    std::string code;
    for (std::size_t i = 0; i < text.size();) {
        const bool line = text.compare(i, 2, "//") == 0;
        if (line || text.compare(i, 2, "/*") == 0) {
            const std::size_t end = text.find(line ? "\n" : "*/", i + 2);
            i = end == std::string::npos ? text.size() : end + (line ? 0 : 2);
        } else {
            code += text[i++];
        }
    }
    return code;
}

std::string findHostDefect(const std::string& folder, const Include& include)
{
    for (const auto& [start, owners] : kOwners) {
        if (startsWith(include.target, start)) {
            return owners.count(folder) ? "" : "belongs to host/" + *owners.begin() + " alone";
        }
    }
    if (!include.quoted || kForAll.count(include.target)) {
        return "";
    }
    const bool shared = startsWith(include.target, "shaders/shared/");
    if (!shared && !startsWith(include.target, "host/")) {
        return "is neither below host nor below shaders/shared";
    }
    const std::string target = shared ? "shaders/shared" : part(include.target, 1);
    return findAllBelow(folder).count(target) ? "" : "points back or aside: host/" + folder + " must not know it";
}

std::string findCommandLineDefect(const std::string& path)
{
    return path == kCommandLineOwner ? "" : "belongs to " + kCommandLineOwner + " alone";
}

std::string findShaderDefect(const std::string& folder, const Include& include)
{
    const std::string target = part(include.target, 1).empty() ? folder : part(include.target, 0);
    const auto begin = kShaderFolders.begin(), end = kShaderFolders.end();
    const auto from = std::find(begin, end, folder), to = std::find(begin, end, target);
    if (to == end) {
        return "is not below shaders";
    }
    return to <= from ? "" : "points back: shaders/" + folder + " must not know it";
}

void findIncludeDefects(const Source& source, std::vector<std::string>& defects)
{
    const std::string folder = part(source.path, 1);
    const bool host = startsWith(source.path, "host/") && !kForAll.count(source.path);
    const bool shader = startsWith(source.path, "shaders/");
    if (host && !kStandsOn.count(folder)) {
        defects.push_back(source.path + ": host/" + folder + " is missing in kStandsOn");
        return;
    }
    for (const Include& include : findIncludes(source.text)) {
        // shaders/shared is C++ as well, and takes the standard library and glm from there.
        const bool commandLine = startsWith(include.target, kCommandLineLibrary);
        const std::string defect = commandLine                ? findCommandLineDefect(source.path)
                                   : host                     ? findHostDefect(folder, include)
                                   : shader && include.quoted ? findShaderDefect(folder, include)
                                                              : "";
        if (!defect.empty()) {
            defects.push_back(source.path + ": " + include.target + " " + defect);
        }
    }
}

void findWordDefects(const Source& source, std::vector<std::string>& defects)
{
    static const std::regex kResource(R"(\b(buffer|uniform)\b)"), kArcus(R"(\b(acos|asin)\b)");
    if (!startsWith(source.path, "shaders/") || std::filesystem::path(source.path).extension() == ".md") {
        return;
    }
    const std::string code = removeComments(source.text);
    if (part(source.path, 1) != "access" && std::regex_search(code, kResource)) {
        defects.push_back(source.path + ": declares a resource, which only shaders/access does");
    }
    // Off by 1.6e-4 and 3.9e-4 on a software driver.
    if (std::regex_search(code, kArcus)) {
        defects.push_back(source.path + ": uses acos or asin, which drivers compute too coarsely; use atan");
    }
}

// What holds for one driver stands in the file of device classes and in the list of driver bugs. The tests on the second driver name it.
void findDriverNames(const Source& source, std::vector<std::string>& defects)
{
    static const std::regex kDriver(R"(\b(llvmpipe|lavapipe|SwiftShader|Mesa|RADV)\b)");
    static const std::regex kMayNameThem(
        R"(.*\.md|host/gpu/device_class\.[ch]pp|tests/host/(device_class|includes)_test\.cpp|tests/(list_suites|second_driver)\.cmake|)"
        R"(tests/tools/.*|tools/.*)");
    std::smatch match;
    if (!std::regex_match(source.path, kMayNameThem) && std::regex_search(source.text, match, kDriver)) {
        defects.push_back(source.path + ": names the driver " + match[1].str());
    }
}

// What an unnamed namespace declares at the start of a line.
std::set<std::string> findOwnNames(const std::string& text)
{
    static const std::regex kName(
        R"(^(?:\[\[\w+\]\] )?(?!template|static_assert|namespace|using [\w:]+;)\w[^=(;{]*?[ *&]([:\w]+)(?:\[\w*\])? ?[=({;].*)");
    static const std::regex kType(R"(^(?:struct|class|enum class|enum|using) (\w+)(?: .*)?)");
    std::set<std::string> names;
    std::istringstream lines(text);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        inside = line == "namespace {" || (inside && line != "}  // namespace");
        std::smatch match;
        if (inside && (std::regex_match(line, match, kType) || std::regex_match(line, match, kName)) &&
            match[1].str().find("::") == std::string::npos) {
            names.insert(match[1]);
        }
    }
    return names;
}

std::set<std::string> findLocalConstants(const std::string& text)
{
    static const std::regex kLocal(R"(^ +(?:static )?constexpr [^=]*?(k\w+)(?:\[\w*\])? = .*)");
    std::set<std::string> names;
    std::istringstream lines(text);
    std::smatch match;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_match(line, match, kLocal)) {
            names.insert(match[1]);
        }
    }
    return names;
}

// Files of a folder are compiled several at once (CMakeLists.txt), so that their names must differ, and no local constant may hide one.
void findNameDefects(const std::vector<Source>& sources, std::vector<std::string>& defects)
{
    std::map<std::pair<std::string, std::string>, std::string> owners;  // of each folder and name
    for (const Source& source : sources) {
        const std::filesystem::path path(source.path);
        if (!startsWith(source.path, "host/")) {
            continue;
        }
        if (path.extension() == ".hpp" && source.text.find("\nnamespace {") != std::string::npos) {
            defects.push_back(source.path + ": a header has an unnamed namespace");
        }
        if (path.extension() != ".cpp") {
            continue;
        }
        for (const std::string& name : findOwnNames(source.text)) {
            const auto [owner, isNew] = owners.emplace(std::pair(path.parent_path().string(), name), source.path);
            if (!isNew) {
                defects.push_back(source.path + ": " + owner->second + " has a name " + name + " too");
            }
        }
    }
    for (const Source& source : sources) {
        for (const std::string& name : findLocalConstants(source.text)) {
            const auto owner = owners.find({std::filesystem::path(source.path).parent_path().string(), name});
            if (owner != owners.end() && owner->second != source.path) {
                defects.push_back(source.path + ": " + owner->second + " has a name " + name + " too");
            }
        }
    }
}

std::set<std::string> listTakenByHarness(const std::vector<Source>& sources)
{
    static const std::regex kComment("#[^\n]*"), kPath(R"([\w/]+\.\w+)");
    std::set<std::string> taken;
    for (const Source& source : sources) {
        if (source.path == kTakenByHarness) {
            const std::string text = std::regex_replace(source.text, kComment, "");
            taken.insert(std::sregex_token_iterator(text.begin(), text.end(), kPath), {});
        }
    }
    return taken;
}

// From the project root, as compilers find it.
std::string resolve(const std::string& target, const std::string& includer)
{
    const bool beside = target.find('/') == std::string::npos || startsWith(target, "..");
    const std::filesystem::path folder = beside                             ? std::filesystem::path(includer).parent_path()
                                         : startsWith(includer, "shaders/") ? "shaders"
                                                                            : "";
    return (folder / target).lexically_normal().generic_string();
}

// The harness and what it takes of glim include each other alone, so that they are a library for others.
void findHarnessDefects(const std::vector<Source>& sources, std::vector<std::string>& defects)
{
    const std::set<std::string> taken = listTakenByHarness(sources), below = findAllBelow("gpu");
    for (const std::string& path : taken) {
        if (startsWith(path, "host/") && !below.count(part(path, 1)) && !kForAll.count(path) && !kForHarness.count(path)) {
            defects.push_back(kTakenByHarness + ": " + path + " is nothing that host/gpu stands on");
        }
    }
    for (const Source& source : sources) {
        const bool own = startsWith(source.path, "tests/harness/") && !startsWith(source.path, "tests/harness/example/") &&
                         std::filesystem::path(source.path).extension() != ".md";
        for (const Include& include : own || taken.count(source.path) ? findIncludes(source.text) : std::vector<Include>()) {
            const std::string target = resolve(include.target, source.path);
            if (include.quoted && !startsWith(target, "tests/harness/") && !taken.count(target) && !kGenerated.count(include.target)) {
                defects.push_back(source.path + ": " + include.target + " is not among what " + kTakenByHarness + " lists");
            }
        }
    }
}

std::vector<std::string> findDefects(const std::vector<Source>& sources)
{
    std::vector<std::string> defects;
    findHarnessDefects(sources, defects);
    findNameDefects(sources, defects);
    for (const Source& source : sources) {
        findIncludeDefects(source, defects);
        findWordDefects(source, defects);
        findDriverNames(source, defects);
    }
    return defects;
}

std::vector<Source> readSources()
{
    const std::filesystem::path root = GLIM_SOURCE_DIR;
    std::vector<Source> sources;
    for (const char* folder : {"host", "shaders", "tests", "tools"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            const std::string path = entry.path().lexically_relative(root).generic_string();
            static const std::regex kText(R"(.*\.(cpp|hpp|h|glsl|comp|cmake|py|sh|txt|md)|tools/[^.]*)");
            if (entry.is_regular_file() && std::regex_match(path, kText)) {
                std::ifstream file(entry.path());
                sources.push_back({path, {std::istreambuf_iterator<char>(file), {}}});
            }
        }
    }
    return sources;
}

TEST(Includes, SourcesKeepTheRules)
{
    const std::vector<Source> sources = readSources();
    for (const char* folder : {"host/", "shaders/", "tests/", "tools/"}) {
        EXPECT_TRUE(std::any_of(sources.begin(), sources.end(), [folder](const Source& source) { return startsWith(source.path, folder); }))
            << folder << ": nothing was found to check";
    }
    for (const std::string& defect : findDefects(sources)) {
        ADD_FAILURE() << defect;
    }
}

struct Example {
    const char* path;
    const char* text;
};

TEST(Includes, WhatIsAllowedPasses)
{
    for (const auto& [path, text] : {
             Example{"host/main.cpp", "#include \"host/cli/commands.hpp\"\n#include \"host/error.hpp\"\n"},
             Example{"host/cli/command.cpp", "#include <CLI/CLI.hpp>\n"},
             Example{"host/json.cpp", "#include <nlohmann/json.hpp>\n"},
             Example{"host/cli/inspect.cpp", "#include \"host/scene/load_gltf.hpp\"\n#include \"host/gpu/device.hpp\"\n"},
             Example{"host/scene/gltf/read.cpp", "#include <tiny_gltf.h>\n#include \"host/image/exr.hpp\"\n"},
             Example{"host/bvh/build_bvh.cpp", "#include \"shaders/shared/limits.h\"\n// #include \"host/gpu/device.hpp\"\n"},
             Example{"host/gpu/instance.hpp", "#include <vulkan/vulkan.h>\n#include \"host/error.hpp\"\n"},
             Example{"host/gpu/panel_painter.cpp", "#include <backends/imgui_impl_vulkan.h>\n"},
             Example{"host/preview/panels.cpp", "#include <imgui.h>\n"},
             Example{"shaders/lib/warp.glsl", "#include \"shared/limits.h\"\n#include \"sphere.glsl\"\n// uniform, acos\n"},
             Example{"shaders/access/scene.glsl", "#include \"lib/warp.glsl\"\nreadonly buffer B { float b[]; };\n"},
             Example{"host/gpu/device_class.cpp", "// llvmpipe, SwiftShader\n"},
             Example{"host/gpu/instance.cpp", "throw DeviceError(\"Debian's mesa-vulkan-drivers\");\n"},
             Example{"shaders/shared/types.h", "#include \"vocabulary.h\"\n#include <cstdint>\n"},
             Example{"tests/harness/kernel_run.cpp", "#include \"tests/harness/kernel_run.hpp\"\n#include \"harness_places.h\"\n"},
             Example{"tests/harness/expect.glsl", "#include \"interface.h\"\n"},
             Example{"tests/harness/files.cmake", "# host/render/film.cpp\nset(A host/gpu/device.cpp host/measure/confidence.cpp)\n"},
         }) {
        for (const std::string& defect : findDefects({{path, text}})) {
            ADD_FAILURE() << defect;
        }
    }
}

TEST(Includes, EveryViolationIsFound)
{
    for (const auto& [path, text] : {
             Example{"host/scene/scene.hpp", "#include \"host/bvh/bvh.hpp\"\n"},
             Example{"host/image/exr.hpp", "#include \"shaders/shared/limits.h\"\n"},
             Example{"host/image/exr.cpp", "#include \"host/render/film.hpp\"\n"},
             Example{"host/bvh/bvh.hpp", "#pragma once\n  # include \"host/flatten/flat_scene.hpp\"\n"},
             Example{"host/flatten/light_table.cpp", "#include \"host/render/film.hpp\"\n"},
             Example{"host/flatten/light_table.cpp", "#include \"host/gpu/device.hpp\"\n"},
             Example{"host/gpu/device.cpp", "#include \"host/scene/scene.hpp\"\n"},
             Example{"host/render/renderer.cpp", "#include \"host/measure/picture.hpp\"\n"},
             Example{"host/measure/picture.cpp", "#include \"host/window/window.hpp\"\n"},
             Example{"host/cli/render.cpp", "#include \"host/main.cpp\"\n"},
             Example{"host/main.cpp", "#include \"tests/harness/statistics.hpp\"\n"},
             Example{"host/cli/render.cpp", "#include \"tools/setup.h\"\n"},
             Example{"host/cli/render.cpp", "#include \"render.hpp\"\n"},
             Example{"host/cli/render.cpp", "#include \"shaders/lib/warp.glsl\"\n"},
             Example{"host/novel/x.cpp", ""},
             Example{"host/render/film.cpp", "#include <OpenEXR/ImfHeader.h>\n"},
             Example{"host/image/png.cpp", "#include <tiny_gltf.h>\n"},
             Example{"host/cli/preview.cpp", "#include <GLFW/glfw3.h>\n"},
             Example{"host/cli/preview.cpp", "#include <imgui.h>\n"},
             Example{"host/view/view.cpp", "#include \"host/preview/session.hpp\"\n"},
             Example{"host/window/gui.cpp", "#include \"host/preview/panels.hpp\"\n"},
             Example{"host/window/gui.cpp", "#include <backends/imgui_impl_vulkan.h>\n"},
             Example{"host/render/renderer.cpp", "#include <vulkan/vulkan.h>\n"},
             Example{"host/scene/scene.hpp", "#include <vulkan/vulkan.h>\n"},
             Example{"shaders/shared/limits.h", "#include \"lib/warp.glsl\"\n"},
             Example{"shaders/lib/warp.glsl", "#include \"access/scene.glsl\"\n"},
             Example{"shaders/access/scene.glsl", "#include \"kernels/bounce.comp\"\n"},
             Example{"shaders/lib/warp.glsl", "#include \"../tests/support/expect.glsl\"\n"},
             Example{"shaders/lib/warp.glsl", "uniform sampler2D map;\n"},
             Example{"shaders/kernels/bounce.comp", "layout(binding = 0) buffer B { float b[]; };\n"},
             Example{"shaders/lib/warp.glsl", "float f(float x) { return acos(x); }\n"},
             Example{"shaders/kernels/bounce.comp", "/* a */ float y = asin(1.0); // b\n"},
             Example{"shaders/access/scene.glsl", "// llvmpipe reads words slowly\n"},
             Example{"tests/kernels/mis_test.cpp", "// as Mesa does\n"},
             Example{"host/cli/render.cpp", "#include <CLI/CLI.hpp>\n"},
             Example{"host/main.cpp", "#include <CLI/CLI.hpp>\n"},
             Example{"tests/host/merge_test.cpp", "#include <CLI/CLI.hpp>\n"},
             Example{"host/cli/render_report.cpp", "#include <nlohmann/json.hpp>\n"},
             Example{"host/bench/bench_file.hpp", "#include <nlohmann/json_fwd.hpp>\n"},
             Example{"tests/harness/kernel_run.hpp", "#include \"host/render/kernel_set.hpp\"\n"},
             Example{"tests/harness/statistics.cpp", "#include \"tests/support/test_data.hpp\"\n"},
             Example{"tests/harness/expect.glsl", "#include \"access/pass.glsl\"\n"},
             Example{"tests/harness/files.cmake", "set(A host/gpu/device.cpp host/render/film.cpp)\n"},
         }) {
        EXPECT_EQ(findDefects({{path, text}}).size(), 1U) << path << "\n" << text;
    }
}

TEST(Includes, NamesDifferWithinAFolder)
{
    const auto inUnnamed = [](const std::string& text) { return "namespace glim {\nnamespace {\n\n" + text + "\n}  // namespace\n}\n"; };
    for (const auto& [one, other] : {
             Example{"struct Part {", "struct Part {"},
             Example{"enum class Part {", "class Part : public Whole {"},
             Example{"constexpr double kMax = 1.0;", "constexpr float kMax = 2.0F;"},
             Example{"const char* const kNames[] = {", "const std::string kNames = f();"},
             Example{"double meanOf(double x)", "glm::vec3 meanOf(const glm::vec3& x) { return x; }"},
             Example{"[[noreturn]] void refuse(int x)", "[[noreturn]] void refuse(float x)"},
             Example{"constexpr double kMax = 1.0;", "void f()\n{\n    constexpr double kMax = 1.0;"},
         }) {
        EXPECT_EQ(findDefects({{"host/bvh/a.cpp", inUnnamed(one)}, {"host/bvh/b.cpp", inUnnamed(other)}}).size(), 1U) << one;
        EXPECT_EQ(findDefects({{"host/bvh/a.cpp", inUnnamed(one)}, {"host/image/b.cpp", inUnnamed(other)}}).size(), 0U) << one;
        EXPECT_EQ(findDefects({{"host/bvh/a.cpp", inUnnamed(one)}, {"host/image/b.cpp", other}}).size(), 0U) << one;
    }
    EXPECT_EQ(findDefects({{"host/bvh/a.hpp", inUnnamed("")}}).size(), 1U);
    EXPECT_EQ(
        findDefects({{"host/bvh/a.cpp", inUnnamed("using std::numbers::pi;")}, {"host/bvh/b.cpp", inUnnamed("using std::numbers::pi;")}})
            .size(),
        0U);
}

}  // namespace
}  // namespace glim
