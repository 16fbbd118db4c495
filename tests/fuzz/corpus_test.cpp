// The inputs that fuzzing has found, which reach most of the code that reads files: each holds the contract. tools/fuzz makes new ones.
#include "host/error.hpp"
#include "places.h"
#include "tests/fuzz/contract.hpp"
#include "tests/fuzz/targets.hpp"

#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace glim::fuzz {
namespace {

void replay(const std::string& target, const std::string& corpus)
{
    int count = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(GLIM_SOURCE_DIR "/tests/fuzz/corpus") / corpus)) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), {}};
        const auto defect = runTarget(target, bytes);
        EXPECT_FALSE(defect) << entry.path() << ": " << *defect;
        ++count;
    }
    EXPECT_GT(count, 20) << "the corpus is missing";
}

TEST(FuzzCorpus, ScenesLoadOrAreRefused) { replay("load", "load"); }
TEST(FuzzCorpus, ScenesAreBuilt) { replay("build", "load"); }
TEST(FuzzCorpus, FilmsAreMergedOrRefused) { replay("film", "film"); }
TEST(FuzzCorpus, ImagesAreDecodedOrRefused) { replay("image", "image"); }
TEST(FuzzCorpus, Ktx2TexturesAreDecodedOrRefused) { replay("ktx2", "ktx2"); }

TEST(FuzzContract, NoticesEachViolation)
{
    const auto defectOf = [](const std::function<void()>& step) { return findDefect("a.gltf: ", step).value_or(""); };
    const auto refusing = [](const std::string& sentence) { return [sentence] { throw InputError(MessageId::Malformed, {sentence}); }; };
    EXPECT_EQ(defectOf([] {}), "");
    EXPECT_EQ(defectOf(refusing("a.gltf: is not glTF; expected it")), "");
    EXPECT_EQ(defectOf([] { throw std::out_of_range("x"); }), "throws what is no InputError: x");
    EXPECT_EQ(defectOf(refusing("it is not glTF")), "does not begin with \"a.gltf: \": it is not glTF");
    EXPECT_EQ(defectOf(refusing("a.gltf: no")), "says too little: a.gltf: no");
    EXPECT_EQ(defectOf(refusing("a.gltf: " + std::string(5000, 'x'))), "is a sentence of 5008 bytes");
    EXPECT_EQ(defectOf(refusing("a.gltf: " + std::string(9000, 'x'))), "is a sentence of 7173 bytes");  // of a message that was cut
    volatile double sum = 0.0;
    const auto slow = [&] {
        for (const std::clock_t begin = std::clock();
             std::clock() - begin < static_cast<std::clock_t>(1.1 * maxSeconds() * CLOCKS_PER_SEC);) {
            sum = sum + 1.0;
        }
    };
    EXPECT_NE(defectOf(slow).find(" s of CPU time; expected "), std::string::npos);
}

}  // namespace
}  // namespace glim::fuzz
