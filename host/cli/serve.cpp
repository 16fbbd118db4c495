#include "host/cli/commands.hpp"
#include "host/job/outcome.hpp"
#include "host/job/render_sequence.hpp"
#include "host/job/version.hpp"
#include "host/json.hpp"

#include <iostream>

namespace glim {
namespace {

constexpr const char* kRequest = R"({"id": 1, "render": {"file": "scene.glb", "output": "out.exr", "spp": 64, "size": [640, 480]}})";

ExitCode render(RenderSession& session, const Json& options)
{
    RenderJob job;
    OptionTable table;
    addJobOptions(table, job);
    for (const Json::Member& option : options.members()) {
        table.set(option.name, option.value);
    }
    if (!table.isGiven("SCENE")) {
        throw UsageError(MessageId::Missing, {part::place("file"), " is required"});
    }
    table.finish();
    if (job.replay) {
        throw UsageError(MessageId::Unsupported, {part::place("--replay"), ": expected ", part::expected("a picture to render"),
                                                  "; `glim render` replays samples"});
    }
    return session.render(job);
}

bool isSignal(ExitCode code) { return code == ExitCode::HungUp || code == ExitCode::Interrupted || code == ExitCode::Terminated; }

ExitCode serve()
{
    RenderSession session(std::cerr);
    ExitCode last = ExitCode::Done;
    for (std::string text; !isSignal(last) && std::getline(std::cin, text);) {
        Json id;
        const Outcome outcome = runForOutcome([&] {
            const std::optional<Json> request = Json::parse(text);
            id = request && request->find("id") != nullptr ? request->at("id") : Json();
            const Json* options = request ? request->find("render") : nullptr;
            if (!request || request->find("id") == nullptr || options == nullptr || !options->isObject()) {
                throw UsageError(MessageId::Malformed, {"a request is not of the form ", part::expected(kRequest)});
            }
            return render(session, *options);
        });
        last = outcome.code;
        std::cout << Json{{"id", id},
                          {"code", static_cast<int>(outcome.code)},
                          {"error", outcome.error ? Json(outcome.error->sentence) : Json()},
                          {"reason", outcome.error ? toJson(*outcome.error) : Json()}}
                         .dump()
                  << std::endl;
    }
    return isSignal(last) ? last : ExitCode::Done;
}

}  // namespace

void addServe(CommandLine& line)
{
    Command& command = line.addCommand("serve", "Render what standard input asks for, and keep the scene");
    command.setFooter(std::string("Each line of standard input is a request, with the options of `glim render` by their names:\n    ") +
                      kRequest +
                      "\nA line of standard output answers each request once its files are written. `code` is the exit code that\n"
                      "`glim render` would have, and `error` null or one sentence. `reason` is null, or for programs the\n"
                      "id of the sentence and what it is about, if there is such: file, place (as an option), value, expected.\n"
                      "    {\"id\":1,\"code\":0,\"error\":null,\"reason\":null}\n"
                      "Requests that differ only in samples, seed, size, rows, camera, time, edits and outputs reuse the device\n"
                      "and the kernels. glim serve ends at the end of its input, or after a signal.");
    command.onRun(serve);
}

}  // namespace glim
