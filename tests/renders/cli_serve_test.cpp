// glim serve: answers, and the bits of what it renders.
#include "host/job/film_report.hpp"
#include "host/json.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <utility>

extern char** environ;

namespace glim::test {
namespace {

// The options that {"a.gltf", "--size", "8x8"} gives a render, by name.
Json makeOptions(const std::vector<std::string>& words)
{
    Json options{{"file", words[0]}};
    for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
        options.set(words[i] == "-o" ? "output" : words[i].substr(2), words[i + 1]);
    }
    return options;
}

// `glim serve` as a program that talks to it: one request, one answer.
class Server {
public:
    explicit Server(const std::filesystem::path& err)
    {
        int requests[2], answers[2];
        EXPECT_EQ(pipe2(requests, O_CLOEXEC), 0);
        EXPECT_EQ(pipe2(answers, O_CLOEXEC), 0);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, requests[0], 0);
        posix_spawn_file_actions_adddup2(&actions, answers[1], 1);
        posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
        std::string program = GLIM_BINARY, command = "serve";
        char* words[] = {program.data(), command.data(), nullptr};
        EXPECT_EQ(posix_spawn(&process_, program.c_str(), &actions, nullptr, words, environ), 0);
        posix_spawn_file_actions_destroy(&actions);
        close(requests[0]);
        close(answers[1]);
        requests_ = fdopen(requests[1], "w");
        answers_ = fdopen(answers[0], "r");
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() { end(); }

    void send(const std::string& line)
    {
        EXPECT_GE(std::fputs((line + "\n").c_str(), requests_), 0);
        EXPECT_EQ(std::fflush(requests_), 0);
    }
    Json receive()
    {
        std::string line;
        for (int c = 0; (c = std::getc(answers_)) != EOF && c != '\n';) {
            line += static_cast<char>(c);
        }
        const auto answer = Json::parse(line);
        EXPECT_TRUE(answer && answer->isObject()) << line;
        return answer.value_or(Json::object());
    }
    Json ask(const std::vector<std::string>& words)
    {
        send(Json{{"id", "a"}, {"render", makeOptions(words)}}.dump());
        return receive();
    }
    void signal(int number) const { EXPECT_EQ(kill(process_, number), 0); }
    // The status of waitpid.
    int end()
    {
        int status = 0;
        if (process_ > 0) {
            std::fclose(requests_);
            std::fclose(answers_);
            waitpid(std::exchange(process_, 0), &status, 0);
        }
        return status;
    }

private:
    pid_t process_ = 0;
    std::FILE *requests_ = nullptr, *answers_ = nullptr;
};

class ServeTest : public ::testing::Test {
protected:
    void expectDone(const std::vector<std::string>& words) { EXPECT_EQ(server_.ask(words).at("code").number(), 0.0); }
    std::string digestServed(std::vector<std::string> words)
    {
        words.insert(words.end(), {"-o", (folder_ / "served.exr").string()});
        expectDone(words);
        return computeDigest(readFilm(folder_ / "served.exr"));
    }
    std::string digestAlone(std::vector<std::string> words)
    {
        words.insert(words.begin(), "render");
        words.insert(words.end(), {"-o", (folder_ / "alone.exr").string()});
        EXPECT_EQ(runGlim(words).exitCode, 0);
        return computeDigest(readFilm(folder_ / "alone.exr"));
    }

    ScratchFolder folder_;
    Server server_{folder_ / "err"};
};

TEST_F(ServeTest, DrawsPicturesAsARenderDoes)
{
    const auto words = [this](const char* film, const char* image) {
        return std::vector<std::string>{
            sceneFile("cornell.gltf"),  "--size", "8x8", "--spp",      "2",   "-o", (folder_ / film).string(), "--image",
            (folder_ / image).string(), "--tone", "agx", "--exposure", "auto"};
    };
    expectDone(words("served.exr", "served.webp"));
    std::vector<std::string> alone = words("alone.exr", "alone.webp");
    alone.insert(alone.begin(), "render");
    ASSERT_EQ(runGlim(alone).exitCode, 0);
    EXPECT_EQ(readFileBytes(folder_ / "served.webp"), readFileBytes(folder_ / "alone.webp"));
    const Json refused = server_.ask(words("served.exr", "served.gif"));
    EXPECT_EQ(refused.at("code").number(), 2.0);
    EXPECT_NE(refused.at("error").text().find("expected a name that ends in .png, .jpg, .jpeg or .webp"), std::string::npos);
}

TEST_F(ServeTest, AnUnknownErrorEndsTheRenderAndNotTheServer)
{
    const std::string film = (folder_ / "bright.exr").string(), statistics = (folder_ / "bright.json").string();
    expectDone({sceneFile("cornell.gltf"), "--size", "8x8", "--environment", "1e25,1e25,1e25", "--target-rmse", "1%", "-o", film, "--stats",
                statistics});
    EXPECT_EQ(readFilm(film).pixels.front().count, kSamplesOfUnknownError);
    const auto parsed = Json::parse(readFileBytes(statistics));
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->at("stopReason").text(), "unknown error");
    EXPECT_NE(digestServed({sceneFile("cornell.gltf"), "--size", "8x8", "--spp", "2"}), "");
}

TEST_F(ServeTest, PicturesHaveTheBitsThatTheyHaveAlone)
{
    const std::string gems = sceneFile("cornell_gems.gltf"), spheres = sceneFile("cornell_spheres.gltf");
    const std::vector<std::vector<std::string>> requests{
        {gems, "--size", "16x12", "--samples", "256:300"},
        {gems, "--size", "16x12", "--samples", "0:70"},
        {gems, "--size", "32x24", "--spp", "8", "--seed", "3"},
        {gems, "--size", "16x12", "--spp", "8", "--look-from", "0,1,3", "--look-at", "0,1,0"},
        {gems, "--size", "16x12", "--spp", "8", "--lens-radius", ".1", "--focal-distance", "3"},
        {gems, "--size", "16x12", "--spp", "8", "--lens-radius", ".1", "--focus", "3,4"},
        {gems, "--size", "16x12", "--spp", "8", "--rows", "2:7"},
        {gems, "--size", "16x12", "--spp", "8", "--rows", "7:8"},
        {gems, "--size", "16x12", "--spp", "8", "--bounces", "2"},
        {gems, "--size", "16x12", "--spp", "8", "--camera", "framed"},
        {gems, "--size", "12x16", "--spp", "8", "--camera", "framed"},
        {gems, "--size", "12x16", "--spp", "8", "--camera", "framed", "--fov", "15"},
        {gems, "--size", "12x16", "--spp", "8", "--fov", "15", "--zoom", "1.5"},
        {gems, "--size", "16x12", "--spp", "80", "--adaptive", "neighbours"},
        {gems, "--size", "16x12", "--spp", "128", "--adaptive", "neighbours", "--seed", "2"},
        {spheres, "--size", "16x12", "--spp", "8"},
        {spheres, "--size", "16x12", "--spp", "8", "--environment", ".1,.2,.3"},
    };
    for (const auto& words : requests) {
        EXPECT_EQ(digestServed(words), digestAlone(words)) << words[3] << words[4] << words[5];
    }
}

// Numbers, lists and booleans say the same as texts; null counts as left out.
TEST_F(ServeTest, OptionsAreValues)
{
    const Json size{Json::array({16.0, 12})}, from{Json::array({0, 1, 3})}, at{Json::array({0, "1", 0})};
    const std::string film = (folder_ / "served.exr").string();
    server_.send(Json{{"id", 1},
                      {"render", Json{{"file", sceneFile("cornell.gltf")},
                                      {"output", film},
                                      {"size", size},
                                      {"spp", 70},
                                      {"look_from", from},
                                      {"look-at", at},
                                      {"fov", 30.5},
                                      {"zoom", 2},
                                      {"environment_background", false},
                                      {"confine", true},
                                      {"denoise", false},
                                      {"target_rmse", 0.5},
                                      {"fps", Json()}}}}
                     .dump());
    EXPECT_EQ(server_.receive().dump(), R"({"id":1,"code":0,"error":null,"reason":null})");
    EXPECT_EQ(computeDigest(readFilm(film)),
              digestAlone({sceneFile("cornell.gltf"), "--size", "16x12", "--spp", "70", "--look-from", "0,1,3", "--look-at", "0,1,0",
                           "--fov", "30.5", "--zoom", "2", "--environment-background", "off", "--target-rmse", "50%"}));
}

// Back and forth: what was set before does not stay.
TEST_F(ServeTest, EditsAreOfTheirRequestAlone)
{
    const std::string scene = sceneFile("textures.gltf");
    const std::vector<std::string> plain{scene, "--size", "16x12", "--spp", "4"};
    std::vector<std::string> edited = plain;
    edited.insert(edited.end(), {"--set", "/materials/0/pbrMetallicRoughness/baseColorFactor=0.1,0.2,0.3,1"});
    const std::string before = digestServed(plain), after = digestServed(edited);
    EXPECT_NE(after, before);
    EXPECT_EQ(after, digestAlone(edited));
    EXPECT_EQ(digestServed(plain), before);
    const Json refused = server_.ask({scene, "-o", (folder_ / "a.exr").string(), "--set", "/materials/nobody/alphaCutoff=1"});
    EXPECT_EQ(refused.at("code").number(), 1.0);
    const std::string stats = (folder_ / "stats.json").string();
    std::vector<std::string> again = plain;
    again.insert(again.end(), {"--stats", stats});
    EXPECT_EQ(digestServed(again), before);
    EXPECT_EQ(Json::parse(readFileBytes(stats))->at("seconds").at("upload").number(), 0.0) << "the scene has stayed";
}

TEST_F(ServeTest, AnotherShapeOfThePictureKeepsTheKernels)
{
    const std::string stats = (folder_ / "stats.json").string();
    for (const bool kept : {false, true}) {
        digestServed({sceneFile("cornell.gltf"), "--size", kept ? "8x6" : "6x8", "--spp", "4", "--stats", stats});
        const auto seconds = Json::parse(readFileBytes(stats));
        ASSERT_TRUE(seconds);
        EXPECT_EQ(seconds->at("seconds").at("upload").number() == 0.0, kept);
    }
}

TEST_F(ServeTest, AFileThatHasChangedIsReadAgain)
{
    const std::filesystem::path scene = folder_ / "scene.gltf";
    std::string text = readFileBytes(sceneFile("cornell.gltf"));
    std::ofstream(scene) << text;
    const std::string before = digestServed({scene.string(), "--size", "8x8", "--spp", "4"});
    const std::size_t color = text.find("\"baseColorFactor\"");
    ASSERT_NE(color, std::string::npos);
    const std::size_t red = text.find('[', color) + 1;
    text.replace(red, text.find(',', red) - red, "0.25");
    std::ofstream(scene) << text << ' ';
    const std::string after = digestServed({scene.string(), "--size", "8x8", "--spp", "4"});
    EXPECT_NE(after, before);
    EXPECT_EQ(after, digestAlone({scene.string(), "--size", "8x8", "--spp", "4"}));
}

TEST_F(ServeTest, ARefusalIsASentenceWithAnIdAndNotTheEnd)
{
    const std::string scene = sceneFile("cornell.gltf"), film = (folder_ / "a.exr").string();
    const auto expectRefused = [&](const Json& answer, int code, MessageId id, const Parts& parts) {
        EXPECT_EQ(answer.at("code").number(), code);
        Message reason = toMessage(answer.at("reason"));
        reason.sentence = answer.at("error").text();
        EXPECT_NE(reason.sentence, "");
        expectMessage(reason, id, parts);
    };
    const Parts ofForm{.expected = "\"render\""};
    expectRefused(server_.ask({scene, "-o", film, "--sp", "4"}), 2, MessageId::UnknownName, {.value = "sp"});
    expectRefused(server_.ask({"missing.gltf", "-o", film}), 1, MessageId::FileMissing, {.file = "missing.gltf"});
    expectRefused(server_.ask({scene, "--replay", "1,1,1"}), 2, MessageId::Unsupported, {.place = "--replay"});
    server_.send(R"({"id":1,"render":{"file":"scene.gltf\u0000.png","output":"a.exr"}})");
    expectRefused(server_.receive(), 2, MessageId::Malformed, {.value = R"(scene.gltf\x00.png)"});
    server_.send(std::string(1'000'000, '['));
    expectRefused(server_.receive(), 2, MessageId::Malformed, ofForm);
    for (const char* line : {"", "x", "[]", "{}", R"({"id":1})", R"({"id":1,"render":"x"})", R"({"id":1,"render":[1]})", R"({"render":{}})",
                             R"({"id":1,"render":{},"merge":{}})"}) {
        server_.send(line);
        expectRefused(server_.receive(), 2, MessageId::Malformed, ofForm);
    }
    server_.send(R"({"id":{"page":[7]},"render":[]})");
    EXPECT_EQ(server_.receive().at("id").dump(), R"({"page":[7]})");
    server_.send(R"({"id":1,"render":{}})");
    expectRefused(server_.receive(), 2, MessageId::Missing, {.place = "file"});
    server_.send(R"({"id":1,"render":{"file":["a.gltf",["b"]]}})");
    expectRefused(server_.receive(), 2, MessageId::WrongType, {.value = R"(["a.gltf",["b"]])"});
    server_.send(R"({"id":1,"render":{"file":"a.gltf","output":"a.exr","spp":4,"time":2}})");
    expectRefused(server_.receive(), 2, MessageId::Conflict, {.place = "--spp", .value = "--time"});
    const Json done = server_.ask({scene, "--size", "8x8", "--spp", "4", "-o", film});
    EXPECT_EQ(done.dump(), R"({"id":"a","code":0,"error":null,"reason":null})");
    EXPECT_EQ(server_.end(), 0);
}

TEST_F(ServeTest, FilmsAreMergedAndLookedAt)
{
    const auto film = [this](const std::string& name) { return (folder_.path() / (name + ".exr")).string(); };
    const std::string statistics = (folder_ / "single.json").string();
    const auto merge = [&](const Json& options) {
        server_.send(Json{{"id", "m"}, {"merge", options}}.dump());
        return server_.receive();
    };
    for (const char* samples : {"0:256", "256:300", "300:320"}) {
        expectDone({sceneFile("cornell.gltf"), "--size", "8x8", "--samples", samples, "-o", film(samples)});
    }
    const Json exact = merge({{"films", Json::array({film("256:300"), film("0:256")})}, {"output", film("merged")}}).at("film");
    EXPECT_EQ(exact.at("samples").text(), "0:300");
    EXPECT_TRUE(exact.at("exact").boolean() && exact.at("complete").boolean());
    expectDone({sceneFile("cornell.gltf"), "--size", "8x8", "--samples", "0:300", "-o", film("single"), "--stats", statistics});
    EXPECT_EQ(computeDigest(readFilm(film("merged"))), computeDigest(readFilm(film("single"))));
    const Json report = Json::parse(readFileBytes(statistics)).value();
    EXPECT_EQ(exact.at("estimate").dump(), report.at("estimate").dump());

    const std::ptrdiff_t files = folder_.entries();
    const Json rounded = merge({{"films", Json::array({film("256:300"), film("300:320")})}}).at("film");
    EXPECT_EQ(rounded.at("samples").text(), "256:300 300:320");
    EXPECT_FALSE(rounded.at("exact").boolean());
    EXPECT_EQ(folder_.entries(), files) << "without an output nothing is written";
    EXPECT_TRUE(merge({{"films", film("300:320")}}).at("film").at("estimate").isNull()) << "20 samples are one block";

    const Json missing = merge({{"films", film("none")}});
    EXPECT_EQ(missing.at("code").number(), 1.0);
    EXPECT_EQ(missing.at("reason").at("id").text(), toText(MessageId::FileMissing));
    EXPECT_EQ(missing.at("reason").at("file").text(), film("none"));
    EXPECT_EQ(missing.find("film"), nullptr);
    const Json nameless = merge({{"films", film("300:320")}, {"output", ""}});
    EXPECT_EQ(nameless.at("code").number(), 2.0) << "an empty name is no missing one";
    EXPECT_EQ(merge(Json::object()).at("reason").at("id").text(), toText(MessageId::Missing));
}

TEST_F(ServeTest, ASignalEndsItAfterTheAnswer)
{
    server_.send(Json{{"id", 1},
                      {"render", makeOptions({sceneFile("cornell.gltf"), "--size", "64x64", "--spp", "1000000", "--progress", "json", "-o",
                                              (folder_ / "a.exr").string()})}}
                     .dump());
    while (!hasLine(readFileBytes(folder_ / "err"))) {
        usleep(1000);
    }
    server_.signal(SIGTERM);
    EXPECT_EQ(server_.receive().at("code").number(), 143.0);
    const int status = server_.end();
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 143);
    EXPECT_GT(readFilm(folder_ / "a.exr").pixels.front().count, 0U);
}

// Nothing is under way then.
TEST_F(ServeTest, ASignalWhileItWaitsEndsItAtOnce)
{
    expectDone({sceneFile("cornell.gltf"), "--size", "8x8", "--spp", "4", "-o", (folder_ / "a.exr").string()});
    server_.signal(SIGTERM);
    EXPECT_TRUE(WIFSIGNALED(server_.end()));
}

}  // namespace
}  // namespace glim::test
