#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

PathNote noteOf(bool asked)
{
    Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    upload(note, std::span<const PathNote>(std::vector<PathNote>(1)));
    KernelTest test(test_kernels::notes_test);
    test.specialize(kSpecNotes, asked).buffers({{kBindNote, &note}}).threads(1).run();
    return download<PathNote>(note, 1)[0];
}

TEST(NotesTest, TellEverythingToWhoAsks)
{
    const PathNote note = noteOf(true);
    EXPECT_EQ(note.point, vec3(1, 2, 3));
    EXPECT_EQ(note.ng, vec3(4, 5, 6));
    EXPECT_EQ(note.ns, vec3(7, 8, 9));
    EXPECT_EQ(note.front, 1U);
    EXPECT_EQ(note.lightPdfOfHit, 10.0F);
    EXPECT_EQ(note.misWeightOfHit, 11.0F);
    EXPECT_EQ(note.light, 12U);
    EXPECT_EQ(note.lightPdf, 13.0F);
    EXPECT_EQ(note.bsdfPdf, 14.0F);
    EXPECT_EQ(note.misWeightOfLight, 15.0F);
    EXPECT_EQ(note.weight, vec3(16, 17, 18));
    EXPECT_EQ(note.throughput, vec3(19, 20, 21));
    EXPECT_EQ(note.continuation, 22.0F);
}

TEST(NotesTest, AreNotTakenElsewhere)
{
    const PathNote note = noteOf(false);
    EXPECT_EQ(note.point, vec3(0.0F));
    EXPECT_EQ(note.front, 0U);
    EXPECT_EQ(note.light, 0U);
    EXPECT_EQ(note.misWeightOfLight, 0.0F);
    EXPECT_EQ(note.throughput, vec3(0.0F));
    EXPECT_EQ(note.continuation, 0.0F);
}

}  // namespace
}  // namespace glim
