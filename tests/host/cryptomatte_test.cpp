// Ids of names against those of the specification and of mmh3, a Python package that knows nothing of glim.
#include "host/image/cryptomatte.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>

namespace glim {
namespace {

using nlohmann::json;

TEST(Cryptomatte, HashesAreThoseOfMurmurHash3)
{
    const std::pair<const char*, std::uint32_t> kHashes[] = {{"bunny", 0x13851a76U},
                                                             {"default", 0x42c9679fU},
                                                             {"bunny_porcelain_mat", 0xb24b26d4U},  // of the specification
                                                             {"", 0U},
                                                             {"a", 0x3c2569b2U},
                                                             {"ab", 0x9bbfd75fU},
                                                             {"abc", 0xb3dd93faU},
                                                             {"abcd", 0x43ed676aU},
                                                             {"abcde", 0xe89b9af6U},
                                                             {"abcdef", 0x6181c085U},
                                                             {"abcdefg", 0x883c9b06U},
                                                             {"The quick brown fox jumps over the lazy dog", 0x2e4ff723U},
                                                             {"gr\xc3\xbcn", 0x2af580c6U},
                                                             {"\xe8\x8a\xb1", 0x67a7c7b1U},
                                                             {"node.68", 0x00637004U},
                                                             {"node.424", 0x003e4d11U},
                                                             {"node.15", 0x7f953d43U},
                                                             {"node.429", 0x7f9add58U}};
    for (const auto& [name, hash] : kHashes) {
        EXPECT_EQ(murmurHash3(name), hash) << name;
    }
}

TEST(Cryptomatte, IdsAreNormalFloatsAndElseTheHash)
{
    EXPECT_EQ(matteId("bunny"), 0x13851a76U);
    EXPECT_EQ(matteId("node.68"), 0x00e37004U) << "exponent 0 becomes 1";
    EXPECT_EQ(matteId("node.15"), 0x7f153d43U) << "exponent 255 becomes 254";
    EXPECT_EQ(matteId(""), 0x00800000U);
    int changed = 0;
    for (int i = 0; i < 100000; ++i) {
        const std::string name = "node." + std::to_string(i);
        const std::uint32_t hash = murmurHash3(name), id = matteId(name);
        ASSERT_TRUE(std::isnormal(std::bit_cast<float>(id))) << name;
        ASSERT_TRUE(id == hash || id == (hash ^ 1U << 23U)) << name;
        changed += id == hash ? 0 : 1;
    }
    // Of 256 exponents two: 781 of 100,000, with a standard deviation of 28.
    EXPECT_NEAR(changed, 781, 4.56 * 28);
}

TEST(Cryptomatte, RanksAreTwoToALayer)
{
    EXPECT_EQ(matteIdChannel("CryptoObject", 0), "CryptoObject00.R");
    EXPECT_EQ(matteCoverageChannel("CryptoObject", 0), "CryptoObject00.G");
    EXPECT_EQ(matteIdChannel("CryptoObject", 1), "CryptoObject00.B");
    EXPECT_EQ(matteCoverageChannel("CryptoObject", 1), "CryptoObject00.A");
    EXPECT_EQ(matteIdChannel("CryptoObject", 4), "CryptoObject02.R");
    EXPECT_EQ(matteCoverageChannel("CryptoObject", 5), "CryptoObject02.A");
}

TEST(Cryptomatte, AttributesDescribeTheLayer)
{
    Image image;
    addMatteAttributes(image, "CryptoObject", {{"a \"b\"\\\n", 0x13851a76U}, {"gr\xc3\xbcn", 0x00e37004U}});
    ASSERT_EQ(image.attributes.size(), 4U);
    const auto text = [&](const char* name) { return std::get<std::string>(image.attributes.at(name)); };
    EXPECT_EQ(text("cryptomatte/3ae39a5/name"), "CryptoObject");
    EXPECT_EQ(text("cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
    EXPECT_EQ(text("cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
    EXPECT_EQ(json::parse(text("cryptomatte/3ae39a5/manifest")), json({{"a \"b\"\\\n", "13851a76"}, {"gr\xc3\xbcn", "00e37004"}}));
    addMatteAttributes(image, "CryptoAsset", {});
    EXPECT_EQ(text("cryptomatte/f42029d/manifest"), "{}");
}

}  // namespace
}  // namespace glim
