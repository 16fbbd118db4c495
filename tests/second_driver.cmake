# What SwiftShader, the second driver of tools/test --ci, is not asked of tests/kernels and scenes, by reason. All other tests of kernels run
# there too, and a small picture of every other scene must have the bits of Mesa's. Names are those of gtest and of scenes, with * for any
# characters. list_suites.cmake refuses names that nothing has.

# Buffers of more than 65,536 texels, which SwiftShader refuses. A test that is not refused must leave the list.
set(beyondItsLimits
    EnvironmentMapTest.H15HotTexelsAtThePoles
    EnvironmentMapTest.CellsOfSeveralTexels
    LightChoiceTest.H14AMillionLights
    LightChoiceTest.FollowsWhatArrivesBetterThanPower
    TraverseStepsTest.H6CoincidentTrianglesGiveTheLowestOrAreReported
    TraverseStepsTest.H6GrowingLineAgreesWithTheReference
    TraverseStepsTest.TheStackIsAsDeepAsTheTreeNeeds
)
# More than 25 s, most of which SwiftShader spends on compiling; KernelRegistersTest and the test of black pixels also take more than 20 GB.
# Of the instances three remain, of six or seven seconds each.
set(tooSlowForIt
    ContactTest.*
    CoplanarTest.*
    KernelRegistersTest.*
    LightTest.*
    NearLightTest.*
    NlMeans.BandsOfALargePictureJoin
    NlMeans.BlackPixelsBesideBrightOnesHaveTheSameBitsOnAllDevices
    Rows/InstancesTest.*/Mirrored
    Rows/InstancesTest.*/OtherProportions
    Rows/InstancesTest.*/Small
    Rows/InstancesTest.*/Large
    Rows/InstancesTest.*/VeryFar
    Rows/InstancesTest.*/FarAndUpright
)
# Scenes whose kernels it compiles for more than 30 s.
set(scenesTooSlowForIt
    cornell_gems
    cornell_mirror_glass
    materials
    showcase
)
