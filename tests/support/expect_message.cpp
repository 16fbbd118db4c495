#include "tests/support/expect_message.hpp"

#include <algorithm>
#include <optional>
#include <ostream>
#include <sstream>

namespace glim {

void PrintTo(const Message& message, std::ostream* stream) { *stream << toJson(message).dump() << ' ' << message.sentence; }

namespace test {
namespace {

MessageId parseId(const std::string& text)
{
    for (unsigned i = 0; i < kMessageIdCount; ++i) {
        if (toText(static_cast<MessageId>(i)) == text) {
            return static_cast<MessageId>(i);
        }
    }
    ADD_FAILURE() << "there is no message " << text;
    return MessageId::NoLight;
}

}  // namespace

Message toMessage(const Json& json)
{
    Message message(parseId(json.at("id").text()), {});
    for (const auto& [name, part] : {std::pair{"sentence", &message.sentence},
                                     {"file", &message.file},
                                     {"place", &message.place},
                                     {"value", &message.value},
                                     {"expected", &message.expected}}) {
        *part = json.find(name) == nullptr ? "" : json.at(name).text();
    }
    return message;
}

void expectMessage(const Message& message, MessageId id, const Parts& parts)
{
    EXPECT_EQ(toText(message.id), toText(id)) << message.sentence;
    EXPECT_TRUE(message.file.ends_with(parts.file)) << message.file << "\nends otherwise than " << parts.file << '\n' << message.sentence;
    if (!parts.place.empty()) {
        EXPECT_EQ(message.place, parts.place) << message.sentence;
    }
    if (!parts.value.empty()) {
        EXPECT_EQ(message.value, parts.value) << message.sentence;
    }
    EXPECT_TRUE(contains(message.expected, parts.expected)) << message.expected << "\nlacks " << parts.expected << '\n' << message.sentence;
    EXPECT_FALSE(contains(message.sentence, "\n")) << message.sentence;
}

GlimRun runForMessages(GlimCall call)
{
    call.environment["GLIM_MESSAGES"] = "json";
    return runGlim(call);
}

GlimRun runForMessages(const std::vector<std::string>& arguments) { return runForMessages(GlimCall{.arguments = arguments}); }

std::vector<Said> findMessages(const std::string& err)
{
    std::vector<Said> said;
    std::istringstream lines(err);
    for (std::string line; std::getline(lines, line);) {
        const std::optional<Json> json = Json::parse(line);
        if (json && json->find("severity") != nullptr) {
            said.push_back({json->at("severity").text(), toMessage(*json)});
        }
    }
    return said;
}

void expectSaid(const GlimRun& run, MessageId id, const Parts& parts)
{
    const std::vector<Said> said = findMessages(run.err);
    const auto found = std::ranges::find(said, id, [](const Said& one) { return one.message.id; });
    ASSERT_NE(found, said.end()) << "no " << toText(id) << " in\n" << run.err;
    expectMessage(found->message, id, parts);
}

bool hasSaid(const GlimRun& run, MessageId id)
{
    return std::ranges::any_of(findMessages(run.err), [id](const Said& one) { return one.message.id == id; });
}

void expectRefused(const GlimRun& run, int exitCode, MessageId id, const Parts& parts)
{
    EXPECT_EQ(run.exitCode, exitCode) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(countLines(run.err), 1U) << run.err;
    const std::vector<Said> said = findMessages(run.err);
    ASSERT_EQ(said.size(), 1U) << run.err;
    EXPECT_EQ(said[0].severity, "error");
    expectMessage(said[0].message, id, parts);
}

std::optional<Message> findMessage(const GlimRun& run, MessageId id)
{
    const std::vector<Said> said = findMessages(run.err);
    const auto found = std::ranges::find(said, id, [](const Said& one) { return one.message.id; });
    return found == said.end() ? std::nullopt : std::optional(found->message);
}

}  // namespace test
}  // namespace glim
