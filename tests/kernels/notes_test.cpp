#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

namespace glim::notes_test {

PathNote noteOf(bool asked)
{
    Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    upload(note, std::span<const PathNote>(std::vector<PathNote>(1)));
    SceneBuilder builder;
    builder.sphere(vec3(0.0F), 1.0F, builder.lambert(vec3(0.5F)));
    const SceneOnDevice scene(builder.scene());
    KernelTest test = scene.test(test_kernels::notes_test);
    test.features(kFeaturePrincipled).specialize(kSpecNotes, asked).buffers({{kBindNote, &note}}).threads(1).run();
    return download<PathNote>(note, 1)[0];
}

TEST(NotesTest, TellEverythingToWhoAsks)
{
    const PathNote note = noteOf(true);
    EXPECT_EQ(note.point, vec3(1, 2, 3));
    EXPECT_EQ(note.ng, vec3(4, 5, 6));
    EXPECT_EQ(note.ns, vec3(7, 8, 9));
    EXPECT_EQ(note.front, 1U);
    EXPECT_EQ(note.baseColor, vec3(32, 33, 34));
    EXPECT_EQ(note.metallic, 35.0F);
    EXPECT_EQ(note.roughness, 36.0F);
    EXPECT_EQ(note.transmission, 37.0F);
    EXPECT_EQ(note.diffuseTransmission, 38.0F);
    EXPECT_EQ(note.clearcoat, 39.0F);
    EXPECT_EQ(note.clearcoatRoughness, 40.0F);
    EXPECT_EQ(note.sheenColor, vec3(41, 42, 43));
    EXPECT_EQ(note.sheenRoughness, 44.0F);
    EXPECT_EQ(note.anisotropy, 45.0F);
    EXPECT_EQ(note.iridescence, 46.0F);
    EXPECT_EQ(note.filmThickness, 47.0F);
    EXPECT_EQ(note.alpha, 1.0F);
    EXPECT_EQ(note.medium, 5U) << "the innermost of two";
    EXPECT_EQ(note.lobe, 30U);
    EXPECT_EQ(note.lobeFlags, 31U);
    EXPECT_EQ(note.lightPdfOfHit, 10.0F);
    EXPECT_EQ(note.misWeightOfHit, 11.0F);
    EXPECT_EQ(note.light, 12U);
    EXPECT_EQ(note.lightPdf, 13.0F);
    EXPECT_EQ(note.bsdfPdf, 14.0F);
    EXPECT_EQ(note.misWeightOfLight, 15.0F);
    EXPECT_EQ(note.isByGuide, 1U);
    EXPECT_EQ(note.guideShare, 23.0F);
    EXPECT_EQ(note.guidePdf, 24.0F);
    EXPECT_EQ(note.nextBsdfPdf, 25.0F);
    EXPECT_EQ(note.nextPdf, 26.0F);
    EXPECT_EQ(note.arrival, 27.0F);
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
    EXPECT_EQ(note.guideShare, 0.0F);
    EXPECT_EQ(note.arrival, 0.0F);
    EXPECT_EQ(note.throughput, vec3(0.0F));
    EXPECT_EQ(note.continuation, 0.0F);
}

}  // namespace glim::notes_test
