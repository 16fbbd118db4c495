#include "host/window/script.hpp"

#include "host/error.hpp"
#include "host/window/event_queue.hpp"

#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

namespace glim {
namespace {

using Kind = ScriptStep::Kind;

// Reads the rest of a line word by word. A word of another kind than expected makes the line bad.
class Words {
public:
    explicit Words(const std::string& line)
        : stream_(line)
    {}

    std::string word()
    {
        std::string text;
        good_ = good_ && static_cast<bool>(stream_ >> text);
        return text;
    }
    double number() { return scan<1>("%lf%n")[0]; }
    glm::dvec2 point()
    {
        const auto values = scan<2>("%lf,%lf%n");
        return {values[0], values[1]};
    }
    glm::uvec2 size()
    {
        const auto values = scan<2>("%lfx%lf%n");
        expect(values[0] >= 1.0 && values[1] >= 1.0 && values[0] <= 65535.0 && values[1] <= 65535.0);
        return good_ ? glm::uvec2(values[0], values[1]) : glm::uvec2(0);
    }
    char key()
    {
        const std::string name = word();
        if (name == "space" || name == "escape" || name == "F11") {
            return name == "space" ? ' ' : name == "escape" ? kEscape : kFullScreen;
        }
        expect(name.size() == 1 && (std::isalnum(static_cast<unsigned char>(name[0])) || name[0] == '+' || name[0] == '-'));
        return good_ ? static_cast<char>(std::toupper(static_cast<unsigned char>(name[0]))) : '\0';
    }
    std::string rest()
    {
        std::string text;
        std::getline(stream_ >> std::ws, text);
        text.erase(text.find_last_not_of(" \t\r") + 1);
        expect(!text.empty());
        return text;
    }
    void expect(bool right) { good_ = good_ && right; }
    bool isGoodToTheEnd()
    {
        std::string more;
        return good_ && !(stream_ >> more);
    }

private:
    template <int count>
    std::array<double, count> scan(const char* format)
    {
        std::array<double, count> values{};
        const std::string text = word();
        int end = -1;
        if constexpr (count == 1) {
            std::sscanf(text.c_str(), format, &values[0], &end);
        } else {
            std::sscanf(text.c_str(), format, &values[0], &values[1], &end);
        }
        expect(end == static_cast<int>(text.size()));
        for (const double value : values) {
            expect(std::isfinite(value));
        }
        return values;
    }

    std::istringstream stream_;
    bool good_ = true;
};

// Reads the arguments of the step `name`. Returns false if there is no such step.
bool readArguments(const std::string& name, Words& words, ScriptStep& step)
{
    static const std::map<std::string, Kind> kKinds = {{"key", Kind::Key},         {"press", Kind::Press},     {"release", Kind::Release},
                                                       {"drag", Kind::Drag},       {"scroll", Kind::Scroll},   {"click", Kind::Click},
                                                       {"resize", Kind::Resize},   {"iconify", Kind::Iconify}, {"restore", Kind::Restore},
                                                       {"samples", Kind::Samples}, {"close", Kind::Close},     {"scale", Kind::Scale},
                                                       {"drop", Kind::Drop}};
    const auto found = kKinds.find(name);
    if (found == kKinds.end()) {
        return false;
    }
    step.kind = found->second;
    switch (step.kind) {
    case Kind::Key:
    case Kind::Press:
    case Kind::Release: step.key = words.key(); break;
    case Kind::Drag: {
        const std::string button = words.word();
        words.expect(button == "left" || button == "middle");
        step.pan = button == "middle";
        step.from = words.point();
        step.to = words.point();
        break;
    }
    case Kind::Scroll: step.notches = words.number(); break;
    case Kind::Click: step.from = words.point(); break;
    case Kind::Resize: step.size = words.size(); break;
    case Kind::Scale:
        step.scale = static_cast<float>(words.number());
        words.expect(step.scale > 0.0F && step.scale <= 16.0F);
        break;
    case Kind::Drop: step.file = words.rest(); break;
    case Kind::Samples: {
        const double samples = words.number();
        words.expect(samples >= 1.0 && samples <= 2147483648.0);
        step.samples = samples >= 1.0 ? static_cast<std::uint64_t>(samples) : 0;
        break;
    }
    case Kind::Iconify:
    case Kind::Restore:
    case Kind::Close: break;
    }
    return true;
}

}  // namespace

std::vector<ScriptStep> readScript(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream) {
        throw InputError(errno == ENOENT ? MessageId::FileMissing : MessageId::FileUnreadable,
                         {part::file(file), ": the script cannot be read."});
    }
    std::vector<ScriptStep> steps;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::string text = line.substr(0, line.find('#'));
        if (text.find_first_not_of(" \t\r") == std::string::npos) {
            continue;
        }
        Words words(text);
        ScriptStep step;
        step.delay = words.number();
        words.expect(step.delay >= 0.0);
        const bool known = readArguments(words.word(), words, step);
        if (!known || !words.isGoodToTheEnd()) {
            throw InputError(
                MessageId::Malformed,
                {part::file(file), ", ", part::place("line " + std::to_string(number)), ": ", part::quoted(line), ": expected ",
                 part::expected("a delay in seconds and a step, as in \"0.5 key V\", \"0 drag left 10,20 30,40\", \"0 scroll 1\", "
                                "\"0 click 5,5\", \"1 resize 300x200\", \"0 drop a.glb\", \"0 samples 16\" or \"0 close\""),
                 "."});
        }
        step.file = step.kind == Kind::Drop ? file.parent_path() / step.file : "";
        steps.push_back(step);
    }
    return steps;
}

}  // namespace glim
