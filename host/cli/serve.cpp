#include "host/cli/commands.hpp"
#include "host/job/merge_job.hpp"
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
    table.setAll(options);
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

// What the films are, merged. Without an output they are read only.
Json merge(const Json& options)
{
    MergeJob job;
    OptionTable table;
    addMergeOptions(table, job);
    table.option("--output").require(false);
    table.setAll(options);
    table.finish();
    return describe(carryOut(job));
}

bool isSignal(ExitCode code) { return code == ExitCode::HungUp || code == ExitCode::Interrupted || code == ExitCode::Terminated; }

ExitCode serve()
{
    RenderSession session(std::cerr);
    ExitCode last = ExitCode::Done;
    for (std::string text; !isSignal(last) && std::getline(std::cin, text);) {
        Json id, merged;
        const Outcome outcome = runForOutcome([&] {
            const std::optional<Json> request = Json::parse(text);
            id = request && request->find("id") != nullptr ? request->at("id") : Json();
            const Json* const toRender = request ? request->find("render") : nullptr;
            const Json* const toMerge = request ? request->find("merge") : nullptr;
            const Json* const options = toRender != nullptr ? toRender : toMerge;
            if (!request || request->find("id") == nullptr || options == nullptr || !options->isObject() ||
                (toRender != nullptr && toMerge != nullptr)) {
                throw UsageError(MessageId::Malformed, {"a request is not of the form ", part::expected(kRequest)});
            }
            if (toMerge != nullptr) {
                merged = merge(*toMerge);
                return ExitCode::Done;
            }
            return render(session, *toRender);
        });
        last = outcome.code;
        Json answer{{"id", id},
                    {"code", static_cast<int>(outcome.code)},
                    {"error", outcome.error ? Json(outcome.error->sentence) : Json()},
                    {"reason", outcome.error ? toJson(*outcome.error) : Json()}};
        if (!merged.isNull()) {
            answer.set("film", merged);
        }
        std::cout << answer.dump() << std::endl;
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
                      "A request of \"merge\" in place of \"render\" has the options of `glim merge`: {\"films\": [\"a.exr\", \"b.exr\"],\n"
                      "\"output\": \"c.exr\"}. Its answer has the merged `film`: samples, exact, complete, estimate. Without an output\n"
                      "the films are only looked at.\n"
                      "Requests that differ only in samples, seed, size, rows, camera, time, edits and outputs reuse the device\n"
                      "and the kernels. glim serve ends at the end of its input, or after a signal.");
    command.onRun(serve);
}

}  // namespace glim
