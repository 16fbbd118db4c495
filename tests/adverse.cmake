# What arithmetic as bad as Vulkan allows (GLIM_ARITHMETIC=adverse:SEED) is not asked of tests/kernels and the golden pictures, by reason.
# All others run under it too, with one seed in tools/test --ci. Names are those of gtest, with * for any characters. list_suites.cmake
# refuses names that no test has.

# They ask what the driver does, make devices of their own, with an arithmetic that they choose, or spend the driver's loop budget on sums
# (GlassFurnaceTest: thin films have loops of their own then).
set(notUnderAdverse
    AdverseArithmeticTest.*
    Arithmetics/ExactArithmeticTest.*
    DriverPrecisionTest.*
    GlassFurnaceTest.SolidsUnderFilmsKeepNearlyAllLight
    Kernels/FloatMarksTest.*
    ProbeArithmeticTest.*
    UniqueResults.*
)
# Seconds that the driver spends on compiling kernels, which are several times as large then: only in tools/test --all. Other
# tests of most of these suites remain, and golden pictures that take few seconds.
set(tooSlowUnderAdverse
    AnisotropicFurnaceTest.*
    BsdfSamplingTest.AbsentLayersLeaveNoTrace
    BsdfSamplingTest.H20CornersAreFinite
    BsdfSamplingTest.MixturesFollowTheirDensity
    CoplanarTest.*
    KernelRegistersTest.*
    LeavePiecesTest.*
    LightChoiceTest.ALampOfManyTrianglesCostsAsOne
    LightChoiceTest.ALampOfManyTrianglesIsChosenByItsSideTowardsThePoint
    LightChoiceTest.CertainLightsLackTheirProbability
    LightChoiceTest.DrawsWithTheProbabilitiesThatItStates
    LightChoiceTest.FollowsWhatArrivesBetterThanPower
    LightChoiceTest.H14AMillionLights
    LightTest.DiskOfManyTriangles
    NextRayTest.TheLastRayIsTracedOnlyForWhatItAloneFinds
    NlMeans.BandsOfALargePictureJoin
    Places/LeaveSurfaceTest.*/At1e4
    Places/LeaveSurfaceTest.*/Huge
    Places/LeaveSurfaceTest.*/Size1e3AtOrigin
    Places/LeaveSurfaceTest.*/Size1e5AtOrigin
    Places/LeaveSurfaceTest.*/Tiny
    Places/LeaveSurfaceTest.*/Unit
    PrincipledTest.OpaqueMaterialsAreReciprocal
    Rows/InstancesTest.*/Far
    Rows/InstancesTest.*/FarAndUpright
    Rows/InstancesTest.*/Large
    Rows/InstancesTest.*/Mirrored
    Rows/InstancesTest.*/MirroredProportions
    Rows/InstancesTest.*/OtherProportions
    Rows/InstancesTest.*/SharedStack
    Rows/InstancesTest.*/Small
    Scenes/GoldenTest.*/alpha
    Scenes/GoldenTest.*/car_paint
    Scenes/GoldenTest.*/closed_room
    Scenes/GoldenTest.*/cloth
    Scenes/GoldenTest.*/cornell_gems
    Scenes/GoldenTest.*/cornell_mirror_glass
    Scenes/GoldenTest.*/furnace
    Scenes/GoldenTest.*/light_directional
    Scenes/GoldenTest.*/light_point
    Scenes/GoldenTest.*/liquid
    Scenes/GoldenTest.*/many_lights
    Scenes/GoldenTest.*/materials
    Scenes/GoldenTest.*/normal_map
    Scenes/GoldenTest.*/shaded_lamp
    Scenes/GoldenTest.*/textures
    Scenes/GoldenTest.*/veach_mis
    Scenes/GoldenTest.*/wax
    Scenes/ScanTest.*/Large
    Scenes/ScanTest.*/Mixed
    Scenes/ScanTest.*/OneTriangle
    Scenes/ScanTest.*/Spheres
    SharedStructsTest.*
    SingleSidedTest.AMirroredFrontStaysTheFront
)
