// What messages do to words from files and from the command line.
#include "host/message.hpp"
#include "host/error.hpp"
#include "host/json.hpp"

#include <gtest/gtest.h>

#include <set>

namespace glim {
namespace {

TEST(Message, ControlCharactersAndBrokenUtf8AreEscaped)
{
    using namespace std::string_literals;
    EXPECT_EQ(escaped("a\x1b[2J\n\t\x7f"), "a\\x1b[2J\\x0a\\x09\\x7f");
    EXPECT_EQ(escaped("a\0b"s), "a\\x00b");
    EXPECT_EQ(escaped("\xc2\x9b"
                      "31m"),
              "\\xc2\\x9b31m")
        << "C1, which terminals obey too";
    for (const char* broken : {"\x80", "\xc0\xaf", "\xc3", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"}) {
        EXPECT_EQ(escaped(broken).rfind("\\x", 0), 0U) << escaped(broken);
        EXPECT_EQ(escaped(broken).size() % 4, 0U);
    }
}

TEST(Message, WhatATerminalShowsStays)
{
    for (const char* shown : {"", "plain \"text\" \\x1b", "scéne", "\xc2\xa0", "日本語", "\U0001F600", "\U0010FFFF"}) {
        EXPECT_EQ(escaped(shown), shown);
    }
    EXPECT_EQ(escaped(escaped("\x1b")), escaped("\x1b"));
}

TEST(Message, LongNamesAreCutBetweenCharacters)
{
    EXPECT_EQ(shortened(std::string(80, 'a')), std::string(80, 'a'));
    EXPECT_EQ(shortened(std::string(81, 'a')), std::string(80, 'a') + "...");
    const std::string japanese = std::string(79, 'a') + "日本";
    EXPECT_EQ(shortened(japanese), std::string(79, 'a') + "...");
    EXPECT_EQ(inQuotes("lamp"), "\"lamp\"");
}

TEST(Message, ErrorsKeepWhatFollowsAByteOfZero)
{
    using namespace std::string_literals;
    const InputError error(MessageId::OutOfRange, {"nodes[0] (\"a\0b\") is "s, part::value("\0"s)});
    EXPECT_STREQ(error.what(), "nodes[0] (\"a\\x00b\") is \\x00");
    EXPECT_EQ(error.message().value, "\\x00");
}

TEST(Message, PartsAreTheFirstWordsOfTheirKind)
{
    const Message message(MessageId::DanglingIndex, {part::file("a.gltf"), ": ", part::place("nodes[0].mesh"), " is ", part::value("7"),
                                                     " as ", part::place("nodes[1].mesh"), "; expected ", part::expected("one below 3")});
    EXPECT_EQ(message.sentence, "a.gltf: nodes[0].mesh is 7 as nodes[1].mesh; expected one below 3");
    EXPECT_EQ(toJson(message).dump(),
              R"({"id":"dangling-index","file":"a.gltf","place":"nodes[0].mesh","value":"7","expected":"one below 3"})");
    EXPECT_EQ(toJson(Message(MessageId::NoLight, {"dark"})).dump(), R"({"id":"no-light"})");
}

TEST(Message, WordsAroundAMessageKeepWhatItIsAbout)
{
    const InputError inner(MessageId::FileMissing, {part::file("wood.png"), ": is not there; expected ", part::expected("a picture")});
    const InputError outer(inner, {part::file("a.gltf"), ": ", part::place("images[0]"), " cannot be read (", inner.what(), ")"});
    EXPECT_EQ(outer.message().id, MessageId::FileMissing);
    EXPECT_EQ(outer.message().file, "a.gltf");
    EXPECT_EQ(outer.message().place, "images[0]");
    EXPECT_EQ(outer.message().expected, "a picture");
    EXPECT_STREQ(outer.what(), "a.gltf: images[0] cannot be read (wood.png: is not there; expected a picture)");
}

TEST(Message, SentencesAndPartsAreBounded)
{
    const std::string all(1'000'000, 'a');
    const Message message(MessageId::UnknownName,
                          {part::file("\x1b" + all), ": ", part::place(all), part::value(all), part::expected(all)});
    for (const std::string& text : {message.sentence, message.file, message.place, message.value, message.expected}) {
        EXPECT_LE(text.size(), 8192U);
        EXPECT_TRUE(text.ends_with("aaa"));
    }
    EXPECT_EQ(message.file.rfind("\\x1ba", 0), 0U);
}

TEST(Message, IdsHaveNamesOfTheirOwn)
{
    std::set<std::string> names;
    for (unsigned i = 0; i < kMessageIdCount; ++i) {
        names.insert(toText(static_cast<MessageId>(i)));
    }
    EXPECT_EQ(names.size(), kMessageIdCount);
    EXPECT_EQ(toText(MessageId::FileMissing), "file-missing");
}

}  // namespace
}  // namespace glim
