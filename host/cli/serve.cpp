#include "host/cli/commands.hpp"
#include "host/cli/outcome.hpp"
#include "host/cli/render_sequence.hpp"
#include "host/cli/version.hpp"
#include "host/json.hpp"

#include <iostream>

namespace glim {
namespace {

constexpr const char* kRequest = R"({"id": 1, "render": ["scene.glb", "-o", "out.exr", "--spp", "64"]})";

struct Request {
    Json id;
    std::vector<std::string> words;  // as of `glim render`
};

Request parseRequest(const std::string& line)
{
    const auto refuse = [] { return UsageError(std::string("a request is not of the form ") + kRequest); };
    const std::optional<Json> json = Json::parse(line);
    if (!json || !json->isObject()) {
        throw refuse();
    }
    try {
        Request request{json->at("id"), {"render"}};
        for (const Json& word : json->at("render").elements()) {
            request.words.push_back(word.text());
        }
        return request;
    } catch (const JsonError&) {
        throw refuse();
    }
}

ExitCode render(RenderSession& session, const std::vector<std::string>& words)
{
    RenderOptions options;
    CommandLine line("Renders by requests", versionText(), "");
    const Command command = line.addCommand("render", "As `glim render`");
    addRenderOptions(command, options);
    command.onRun([&] {
        if (options.replay) {
            throw UsageError("--replay", "expected a picture to render; `glim render` replays samples");
        }
        return session.render(options);
    });
    return line.run(words);
}

bool isSignal(ExitCode code) { return code == ExitCode::HungUp || code == ExitCode::Interrupted || code == ExitCode::Terminated; }

ExitCode serve()
{
    std::ostream answers(std::cout.rdbuf());
    std::cout.rdbuf(std::cerr.rdbuf());  // what renders report
    RenderSession session;
    ExitCode last = ExitCode::Done;
    for (std::string text; !isSignal(last) && std::getline(std::cin, text);) {
        Json id;
        const Outcome outcome = outcomeOf([&] {
            const Request request = parseRequest(text);
            id = request.id;
            return render(session, request.words);
        });
        last = outcome.code;
        answers << Json{{"id", id},
                        {"code", static_cast<int>(outcome.code)},
                        {"error", outcome.error.empty() ? Json() : Json(outcome.error)}}
                       .dump()
                << std::endl;
    }
    std::cout.rdbuf(answers.rdbuf());
    return isSignal(last) ? last : ExitCode::Done;
}

}  // namespace

void addServe(CommandLine& line)
{
    const Command command = line.addCommand("serve", "Render what standard input asks for, and keep the scene");
    command.setFooter(std::string("Each line of standard input is a request, with the words of `glim render`:\n    ") + kRequest +
                      "\nEach is answered by a line of standard output, once its files are written. `code` is the exit code that\n"
                      "`glim render` would have, and `error` null or one sentence:\n"
                      "    {\"id\":1,\"code\":0,\"error\":null}\n"
                      "Scene, device and kernels serve again for requests that differ in nothing but samples, seed, size, camera,\n"
                      "time and outputs. It ends with its input, or after a signal like `glim render`.");
    command.onRun(serve);
}

}  // namespace glim
