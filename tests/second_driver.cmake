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
# Some ten seconds or more, most of which SwiftShader spends on compiling; KernelRegistersTest and the test of black pixels also take more
# than 20 GB. Other tests of most of these suites remain, of a few seconds each.
set(tooSlowForIt
    AnisotropicFurnaceTest.WhiteMetalsReflectAllLight
    ContactTest.*
    CoplanarTest.*
    KernelRegistersTest.*
    LeavePiecesTest.*
    LightChoiceTest.DrawsWithTheProbabilitiesThatItStates
    LightTest.*
    NearLightTest.*
    NlMeans.BandsOfALargePictureJoin
    NlMeans.BlackPixelsBesideBrightOnesHaveTheSameBitsOnAllDevices
    Places/LeaveSurfaceTest.*/Size1e3AtOrigin
    Places/LeaveSurfaceTest.*/Size1e5AtOrigin
    Places/WatertightTest.*/4
    Places/WatertightTest.*/5
    Rows/InstancesTest.*/AsTheyAre
    Rows/InstancesTest.*/Mirrored
    Rows/InstancesTest.*/OtherProportions
    Rows/InstancesTest.*/Small
    Rows/InstancesTest.*/Large
    Rows/InstancesTest.*/VeryFar
    Rows/InstancesTest.*/FarAndUpright
    Rows/InstancesTest.*/SharedStack
    SingleSidedTest.AMirroredFrontStaysTheFront
)
# Scenes whose kernels it compiles for more than 30 s; of the suns, it refuses the environment map.
set(scenesTooSlowForIt
    sun_glass
    sun_water
    cornell_gems
    cornell_mirror_glass
    mirror_room
    materials
    showcase
)
