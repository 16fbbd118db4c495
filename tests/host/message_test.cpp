// What messages do to words from files and from the command line.
#include "host/message.hpp"
#include "host/error.hpp"

#include <gtest/gtest.h>

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
    EXPECT_STREQ(InputError("nodes[0] (\"a\0b\") is bad"s).what(), "nodes[0] (\"a\\x00b\") is bad");
}

}  // namespace
}  // namespace glim
