// What sets options by text and by value, and what is refused.
#include "host/job/option_table.hpp"
#include "host/job/parse.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

using test::expectRefusal;
using test::Parts;

// Options of each kind, and what they store.
struct Options {
    Options()
    {
        const Option size = table_.add("-s,--size", "WxH", "", [this](const OptionValue& value) { size_ = parseSize(value); });
        addNumber<std::uint32_t>(table_, {"--spp", "N", "", 1, 1000000, ""}, [this](std::uint32_t count) { spp_ = count; }).needs(size);
        addNumber<double>(table_, {"--time", "S", "", 0.0, 1e30, ""}, [this](double seconds) {
            time_ = seconds;
        }).excludes(table_.option("--spp"));
        addChoice(table_, "--back-faces", "B", "", {"off", "on"}, [this](std::size_t i) { choice_ = i; });
        table_.addFlag("--confine", "", confined_);
        table_.addPath("file,SCENE", "F", "", file_).require();
    }
    void set(const std::string& name, const std::string& json) { table_.set(name, OptionValue(*Json::parse(json))); }
    void expectRefused(const std::string& name, const std::string& json, MessageId id, const Parts& parts)
    {
        SCOPED_TRACE(name + " " + json);
        expectRefusal<UsageError>([&] { set(name, json); }, id, parts);
    }

    OptionTable table_;
    glm::uvec2 size_{0};
    std::uint32_t spp_ = 0;
    double time_ = 0.0;
    std::size_t choice_ = 9;
    bool confined_ = false;
    std::filesystem::path file_;
};

class OptionTableTest : public ::testing::Test, protected Options {};

TEST(OptionValues, SayTheSameAsTexts)
{
    for (const char* size : {R"("640x480")", "[640, 480]", R"(["640", 480.0])"}) {
        Options options;
        options.set("size", size);
        EXPECT_EQ(options.size_, glm::uvec2(640, 480)) << size;
    }
    for (const char* count : {R"("100000")", "100000", "100000.0", "[100000]", "1e5"}) {
        Options options;
        options.set("--spp", count);
        EXPECT_EQ(options.spp_, 100000U) << count;
    }
    for (const auto& [text, choice] : {std::pair(R"("on")", 1U), {"false", 0U}, {"true", 1U}}) {
        Options options;
        options.set("back_faces", text);
        EXPECT_EQ(options.choice_, choice) << text;
    }
    for (const double seconds : {1e22, 0.1, 3.0, 100000.0}) {
        Options options;
        options.table_.set("time", OptionValue(Json(seconds)));
        EXPECT_EQ(options.time_, seconds);
    }
    EXPECT_EQ(parsePercent("", OptionValue("1%")), parsePercent("", OptionValue(Json(0.01))));
    EXPECT_EQ(parseDuration("", OptionValue("2m")), parseDuration("", OptionValue(Json(120))));
}

TEST_F(OptionTableTest, AnOptionMayServeAsTheOneThatIsNeeded)
{
    bool anySize = false;
    table_.addFlag("--any-size", "", anySize);
    table_.option("--any-size").servesAs(table_.option("--size"));
    set("file", R"("f")");
    set("--spp", "1");
    expectRefusal<UsageError>([this] { table_.finish(); }, MessageId::Requires, {.place = "--spp", .expected = "--size or --any-size"});
    set("--any-size", "true");
    EXPECT_NO_THROW(table_.finish());
}

TEST_F(OptionTableTest, EditsAreAPointerAndJson)
{
    for (const auto& [text, json] : {std::pair("1,.25,-3e2,1", "[1.0,0.25,-300.0,1.0]"),
                                     {".5", "0.5"},
                                     {"true", "true"},
                                     {"BLEND", "\"BLEND\""},
                                     {"[1, 2]", "[1, 2]"},
                                     {"a=b,c", "\"a=b,c\""},
                                     {"", "\"\""}}) {
        EXPECT_EQ(parseEdit(OptionValue(std::string("/x/y=") + text)), (Edit{"/x/y", json})) << text;
        EXPECT_EQ(parseEdit(OptionValue("/x/y", Json(text))), (Edit{"/x/y", json})) << text;
    }
    EXPECT_EQ(parseEdit(OptionValue("/x", Json::array({0.5}))), (Edit{"/x", "[0.5]"}));
    EXPECT_EQ(parseEdit(OptionValue("/x", Json(0.5))), (Edit{"/x", "0.5"}));
    EXPECT_EQ(parseEdit(OptionValue("/x", Json(false))), (Edit{"/x", "false"}));
    for (const char* word : {"inf", "nan", "1,inf"}) {  // null would take a property away
        EXPECT_EQ(parseEdit(OptionValue(std::string("/x=") + word)).value, Json(word).dump());
    }
    for (const char* text : {"", "/x", "x=1", "=1"}) {
        expectRefusal<UsageError>([&] { parseEdit(OptionValue(text)); }, MessageId::Malformed, {.place = "--set", .value = text});
    }
    expectRefusal<UsageError>(
        [&] {
            parseEdit(OptionValue("/x", Json::array({"a", "b"})));
        },
        MessageId::WrongType, {.place = "--set", .value = "/x"});
}

TEST_F(OptionTableTest, FlagsThatAreFalseAreNotGiven)
{
    set("confine", "false");
    EXPECT_FALSE(confined_ || table_.isGiven("--confine"));
    set("confine", "true");
    EXPECT_TRUE(confined_ && table_.isGiven("--confine"));
    EXPECT_FALSE(table_.isGiven("--nowhere"));
}

TEST_F(OptionTableTest, WhatIsNoValueIsRefused)
{
    expectRefused("spp", "true", MessageId::Malformed, {.place = "--spp", .value = "true", .expected = "1 to 1000000"});
    expectRefused("spp", "1.5", MessageId::Malformed, {.place = "--spp", .value = "1.5"});
    expectRefused("spp", "-1", MessageId::OutOfRange, {.place = "--spp", .value = "-1"});
    expectRefused("spp", "null", MessageId::WrongType, {.value = "null"});
    expectRefused("size", R"({"x": 1})", MessageId::WrongType, {.value = R"({"x":1})"});
    expectRefused("size", "[[640], 480]", MessageId::WrongType, {.value = "[[640],480]"});
    expectRefused("size", "[640]", MessageId::Malformed, {.place = "--size", .value = "640", .expected = "WIDTHxHEIGHT"});
    expectRefused("confine", "2", MessageId::WrongType, {.place = "--confine", .value = "2", .expected = "true or false"});
    expectRefused("bounces", "2", MessageId::UnknownName, {.value = "bounces"});
    expectRefused("file", R"("a\u0000b")", MessageId::Malformed, {.value = R"(a\x00b)"});
    EXPECT_FALSE(table_.isGiven("--spp") || table_.isGiven("--size"));
}

TEST_F(OptionTableTest, WhatDoesNotGoTogetherIsRefused)
{
    const auto expectUnfinished = [this](MessageId id, const Parts& parts) {
        expectRefusal<UsageError>([this] { table_.finish(); }, id, parts);
    };
    expectUnfinished(MessageId::Missing, {.place = "SCENE"});
    set("file", R"("a.gltf")");
    set("spp", "4");
    expectUnfinished(MessageId::Requires, {.place = "--spp", .expected = "--size"});
    set("-s", R"("8x8")");
    for (const char* name : {"size", "--size", "-s"}) {
        expectRefused(name, R"("9x9")", MessageId::Duplicate, {.place = "--size"});
    }
    table_.finish();
    set("time", "2");
    expectUnfinished(MessageId::Conflict, {.place = "--spp", .value = "--time"});
    EXPECT_EQ(table_.wordsGiven({"--time"}), (std::vector<std::string>{"--size=8x8", "--spp=4"}));
}

// As of --edits.
TEST_F(OptionTableTest, WhatIsSetOtherwisePrecedesAFile)
{
    const auto setByFile = [this](const std::string& name, const std::string& json) { table_.setByFile("f", name, *Json::parse(json)); };
    setByFile("size", "[8, 8]");
    setByFile("spp", "4");
    setByFile("back_faces", "true");
    setByFile("confine", "true");
    set("time", "2");
    set("size", R"("9x9")");
    set("confine", "false");
    set("file", R"("a.gltf")");
    table_.finish();
    EXPECT_EQ(size_, glm::uvec2(9, 9));
    EXPECT_EQ(spp_, 0U) << "is excluded";
    EXPECT_EQ(choice_, 1U);
    EXPECT_FALSE(confined_);
    EXPECT_TRUE(table_.isByFile("--back-faces"));
    EXPECT_FALSE(table_.isByFile("--size"));
    EXPECT_EQ(table_.wordsGiven({}), (std::vector<std::string>{"--size=9x9", "--time=2", "--back-faces=true"}));
}

TEST_F(OptionTableTest, SentencesNameTheFile)
{
    set("file", R"("a.gltf")");
    table_.setByFile("f", "spp", 0);
    expectRefusal<UsageError>([this] { table_.finish(); }, MessageId::OutOfRange, {.file = "f", .place = "--spp", .value = "0"});
    Options other;
    other.set("file", R"("a.gltf")");
    other.table_.setByFile("f", "spp", 4);
    expectRefusal<UsageError>([&] { other.table_.finish(); }, MessageId::Requires, {.file = "f", .place = "--spp", .expected = "--size"});
    expectRefusal<UsageError>([&] { other.table_.setByFile("f", "spp", 5); }, MessageId::Duplicate, {.place = "--spp"});
}

// The order of a program's members means nothing.
TEST_F(OptionTableTest, MembersAreSetInTheOrderOfTheTable)
{
    table_.setAll(*Json::parse(R"({"confine": true, "size": [8, 8], "file": "a", "spp": 3})"));
    EXPECT_TRUE(confined_ && spp_ == 3U && file_ == "a");
    Options other;
    expectRefusal<UsageError>([&] { other.table_.setAll(*Json::parse(R"({"spp": 0, "size": 1})")); }, MessageId::Malformed,
                              {.place = "--size"});
    expectRefusal<UsageError>([&] { other.table_.setAll(*Json::parse(R"({"spp": 0, "spq": 1})")); }, MessageId::UnknownName,
                              {.value = "spq"});
}

}  // namespace
}  // namespace glim
