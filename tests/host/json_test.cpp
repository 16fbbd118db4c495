#include "host/json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace glim {
namespace {

TEST(Json, MembersKeepTheirOrderAndNumbersTheirDigits)
{
    const Json json = {{"b", 1U},
                       {"a", -2},
                       {"tenth", 0.1},
                       {"float", 0.1F},
                       {"big", std::numeric_limits<std::uint64_t>::max()},
                       {"yes", true},
                       {"none", nullptr},
                       {"absent", std::optional<double>()},
                       {"text", "x"},
                       {"list", std::vector<double>{1.0, 2.5}},
                       {"names", std::vector<std::string>{"p", "q"}},
                       {"triple", std::array<float, 3>{1.0F, 2.0F, 3.0F}},
                       {"empty", Json::array()},
                       {"inner", {{"c", Json::array({1, "y"})}}}};
    EXPECT_EQ(json.dump(), R"({"b":1,"a":-2,"tenth":0.1,"float":0.10000000149011612,"big":18446744073709551615,"yes":true,)"
                           R"("none":null,"absent":null,"text":"x","list":[1.0,2.5],"names":["p","q"],"triple":[1.0,2.0,3.0],)"
                           R"("empty":[],"inner":{"c":[1,"y"]}})");
    EXPECT_EQ(Json({{"a", Json::object()}}).dump(2), "{\n  \"a\": {}\n}");
}

TEST(Json, RefusesToRecurseWithoutEnd)
{
    EXPECT_TRUE(Json::parse(std::string(200, '[') + std::string(200, ']')));
    EXPECT_FALSE(Json::parse(std::string(1'000'000, '[') + std::string(1'000'000, ']')));
    EXPECT_FALSE(Json::parse(std::string(1'000'000, '[')));
}

TEST(Json, WhatJsonCannotSayIsReplaced)
{
    EXPECT_EQ(Json(std::nan("")).dump(), "null");
    EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
    EXPECT_EQ(Json("a\"\n\xff").dump(), "\"a\\\"\\n\xef\xbf\xbd\"");
}

TEST(Json, MembersAreSetInTheirOldPlace)
{
    Json json = {{"a", 1}, {"b", 2}};
    json.set("a", "x");
    json.update({{"c", 3}, {"b", 4}});
    EXPECT_EQ(json.dump(), R"({"a":"x","b":4,"c":3})");
}

TEST(Json, ReadsWhatItPrints)
{
    const std::string text = R"({"n":null,"t":true,"i":-3,"u":4294967295,"d":0.5,"s":"é","a":[1,[]],"o":{"x":{}}})";
    const std::optional<Json> json = Json::parse(text);
    ASSERT_TRUE(json);
    EXPECT_EQ(json->dump(), text);
    EXPECT_TRUE(json->isObject());
    EXPECT_TRUE(json->at("t").boolean());
    EXPECT_EQ(json->at("i").number(), -3.0);
    EXPECT_EQ(json->at("u").count(), 4294967295U);
    EXPECT_EQ(json->at("d").number(), 0.5);
    EXPECT_TRUE(json->at("s").is("é"));
    EXPECT_EQ(json->at("a").at(0).count(), 1U);
    EXPECT_EQ(json->at("a").elements().size(), 2U);
    EXPECT_EQ(json->find("none"), nullptr);
    for (const char* broken : {"", "{", "[1,]", "{\"a\":1}x", "nul"}) {
        EXPECT_FALSE(Json::parse(broken)) << broken;
    }
}

TEST(Json, RefusesValuesOfAnotherKind)
{
    const Json json = {{"text", "x"}, {"half", 0.5}, {"negative", -1}, {"large", std::uint64_t{1} << 32}, {"list", Json::array({1})}};
    EXPECT_THROW(json.at("none"), JsonError);
    EXPECT_THROW(json.at(0), JsonError);
    EXPECT_THROW(json.at("list").at(1), JsonError);
    EXPECT_THROW(json.at("list").at("x"), JsonError);
    EXPECT_THROW(json.at("text").number(), JsonError);
    EXPECT_THROW(json.at("text").boolean(), JsonError);
    EXPECT_THROW(json.at("half").text(), JsonError);
    for (const char* name : {"half", "negative", "large", "text"}) {
        EXPECT_THROW(json.at(name).count(), JsonError) << name;
    }
}

}  // namespace
}  // namespace glim
