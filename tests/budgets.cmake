# The tests that tools/test leaves to tools/test --ci: names as gtest has them, with * for any characters. What they look at is looked
# at by default as well, by unit tests, by fewer cases of the same kind, or with fewer samples; each group says by what.
# list_suites.cmake refuses names that no test has. What else is left to tools/test --ci are tests on a second driver (second_driver.cmake)
# and under adverse arithmetic (adverse.cmake).
set(onlyInCi
    # Long pictures in which two estimators, or an estimator and an answer on paper, agree. By default: the kernels' tests of each lobe,
    # light and density, one or two cases of each kind, and the golden pictures of four scenes.
    Scenes/CausticsTest.*
    CausticsOfLightsTest.*
    CausticsFilmTest.AdaptiveRendersHaveTheSameLight
    CausticsFilmTest.CountsTheSamplesThatEachPixelHas
    CausticsFilmTest.HasTheSameBitsOfPartsThatAreMerged
    CausticsFilmTest.HasTheSameBitsInBands
    MotionBlurTest.OfCausticsIsTheMeanOfSharpPictures
    MotionBlurTest.FindsTheMediaOfEachTime
    Lights/MirroredLightTest.*
    Places/DirectLightTest.*
    DirectLightTest.T3ASphereFromWithin
    LightSamplesTest.DivideTheVariance
    Albedos/FurnaceTest.*
    Scenes/GoldenTest.*
    Cameras/CropTest.*/shifted
    Cameras/CropTest.*/intrinsics
    Cameras/CropTest.*/distorted
    Cameras/CropTest.*/equirectangular
    Scenes/ArenaTest.*
    Scenes/ArithmeticTest.*
    IntersectorTest.*
    Ways/PathPartsTest.*
    PathPartsTest.*
    Ways/SidesTest.*
    Sides.CameraRaysPassBackFaces
    Sides.BouncesPassBackFaces
    LinearityTest.T20LightsAddUp
    LinearityTest.T20ThousandfoldLightIsThousandfoldRadianceBitForBit
    LinearityTest.T20PermutedChannelsArePermutedBitForBit
    RoulettePictureTest.H24H25RoomOfAlbedo99Percent
    RoulettePictureTest.FixedHasInfiniteVarianceAboveItsLimit
    TruthTest.T11DiskLightAsPolygon
    TruthTest.T12RectangleAndTriangleLight
    TruthTest.T15ConcentricSpheres
    TruthTest.T10SphereLight
    MaterialTest.TwoHundredRandomMaterialsCreateNoEnergy
    MaterialTest.SunsAreFoundByLightsAndByBsdfsAlike
    MaterialTest.LampsBehindPanesAreFoundByLightsAndByChanceAlike
    MaterialTest.ClearGlassInAFurnaceIsInvisible
    MaterialTest.NestedGlassInAFurnaceIsInvisible
    MaterialTest.NoMaterialReflectsMoreThanItGets
    ScatteringTest.SlabsReflectAndTransmitAsByAddingAndDoubling
    MaterialTest.RoughPanesKeepTheAlbedoOfSingleScattering
    HardMaterialTest.H45AlphaAtTheDeltaLimit
    HardMaterialTest.H48BlackAttenuation
    HardLightTest.OfCoincidentLightsTheFirstShines
    HardLightTest.CoincidentSpheresFromWithin
    HardLightTest.H14AMillionEmitters
    HardLightTest.ADoubleSidedLampInTheCeiling
    HardLightTest.H7TeapotInAStadium
    ScaleAndPlaceTest.H1H7H8RoomsThatAreInstances
    ScaleAndPlaceTest.H7EveryScaleGivesThePicture
    ScaleAndPlaceTest.H7NothingShadowsItself
    ScaleAndPlaceTest.H8SmallOrLargeAndFarAway
    FarTest.H52AStrayPartLeavesTheRestAsItIs
    EnvironmentTest.LightsBsdfsAndBothGiveTheSameBlocks
    AlphaTest.H47NormalMapsThatPointAway
    AlphaTest.CardsInFrontOfCardsWhateverTheTree
    TexturedLampTest.IsFoundByLightsAndByBsdfsAlike
    SharedMeshesTest.LookLikeFlattenedOnes
    SharedMeshesTest.MoveInARefittedTree
    SharedMeshesTest.DoNotDependOnTheTreeOrTheSchedule
    PointsTest.TheirColoursMultiplyTheBaseColour
    PointsTest.ThoseThatEmitAreSphereLights
    PointsTest.SpheresBesideColouredTrianglesStayWhite
    LinesTest.ALineInPartsIsTheWholeLine
    LinesTest.TheirColoursAreThoseOfTheMaterial
    LinesTest.ThoseThatEmitShineAsSphereLightsDo
    # Many films whose errors are compared with what films say of them. By default: the same statistics from made-up numbers (host/).
    Samplers/ErrorEstimateTest.*
    ErrorEstimateBlocksTest.*
    BenchTest.*
    NeighboursTest.H29PictureIsNotDarker
    NeighboursTest.TheControlIsNewSamplesOfAFewPixels
    NeighboursTest.AFilmOfAnUnfinishedRoundSaysSo
    NeighboursTest.DoesNotDependOnHowTheWorkIsCut
    NeighboursTest.EveryPixelHasTheSamplesOfUniformRenders
    NeighboursTest.ATargetEndsItWithTheRoundThatReachesIt
    AdaptiveTest.WorksAcrossTiles
    AdaptiveTest.EveryPixelHasTheBitsOfAUniformRenderOfItsCount
    AdaptiveTest.BatchesMayEndWithinABlock
    AdaptiveTest.H28ConstantPixelsStopAtTheFloor
    # The same bits whatever does not matter. By default: one sampler or schedule of each kind, and the hash of each scene's picture
    # (DriverAgreementTest).
    Samplers/DeterminismTest.*
    Schedules/ResumeTest.*
    ResumeTargetTest.*
    ResumeFilmTest.AnyFilmThatEndsWithAPageGoesOn
    Settings/ScheduleTest.*
    Ways/AcceleratorTest.*
    SplitRulePictureTest.EveryRuleGivesTheBitsOfTheOthers
    MergedRenderTest.*
    PathCapacityTest.*
    StagingTest.ARenderHasTheBitsOfASoftwareDevice
    StepsTest.PassesThatAreGivenUpAreTracedAgain
    StepsTest.FilmsAreThoseOfWholeRenders
    StepsTest.AWindowShowsWhatFilesHold
    StepsTest.OtherCamerasBeginAgain
    StepsTest.AdaptiveFilmsToo
    ReplayTest.HasTheBitsOfTheSampleInEveryScene
    ReplayTest.SuspectsAreTheBrightestSamples
    ReplayTest.HasThemHoweverLightIsFound
    ReplayTest.SaysWhatTheEstimatorIsMadeOf
    IdentifyTest.SamplesAreThoseOfThePicture
    CompressedScene.*
    # Sessions of windows, in which seconds pass. By default: the panels, keys and pictures of a few.
    PreviewTest.*
    ViewWindowTest.*
    # Many processes of glim, or long ones. By default: the rest of the command line, and the options' table and texts (host/).
    CommandLineTest.SuspectsAreReplayedToTheSameBits
    CommandLineTest.KernelRatesOfTransparentSurfacesLeaveTheCourseOut
    CommandLineTest.MergedBandsOfRowsAreTheBitsOfTheSingleRun
    CommandLineTest.RefusedScenesLeaveTheTargetAsItWas
    CommandLineTest.MergeRefusesWhatDoesNotBelongTogether
    CommandLineTest.ReportsDescribeTheTree
    CommandLineTest.FilesThatWouldGrowTooLargeAreNotWritten
    CommandLineTest.MergeSaysThatAFilmEndedEarly
    CommandLineTest.ComparisonsTestNoNoiseThatIsShared
    CommandLineTest.ComparisonsFailByNoiseAndByRmse
    CommandLineTest.ATargetEndsARender
    CommandLineTest.NeighboursStopAtATargetOrInTime
    CommandLineTest.AdaptiveFilmsAreNotTakenForUnfinishedOnes
    CommandLineTest.TimeEndsAnAdaptiveRender
    CommandLineTest.MergedPagesAreTheBitsOfTheSingleRun
    CommandLineTest.ClampingSaysWhatItTook
    CommandLineTest.TheSameSeedGivesTheSamePixels
    CommandLineTest.AnEarlySignalSparesThePictureThatIsThere
    CommandLinePoseTest.FilmsOfTwoTimesAreNotMerged
    CommandLineResumeTest.KilledAtAnyMomentItGoesOnWithTheSameBits
    CommandLineResumeTest.KilledWithinAnyWriteItGoesOnWithTheSameBits
    CommandLineResumeTest.UserSignalWritesAndGoesOn
    CommandLineResumeTest.NeighboursGoOn
    CommandLineResumeTest.MessagesThatRepeatBecomeRarer
    CommandLineResumeTest.OtherFilmsAreRefusedAndLeft
    OptionsTest.*
    SequenceTest.WholeFilmsAreKept
    SequenceTest.CamerasMayBeListed
    SequenceTest.ListsOfCamerasThatAreWrongAreRefused
    SequenceTest.CamerasOfTheFileAreAllRendered
    SequenceTest.KernelsAreThoseThatEachPictureNeeds
    DenoiseTest.TheFilmKeepsItsBits
    DenoiseTest.MergedFilmsAreThoseOfTheirSamples
    DenoiseTest.FramesThatAreThereKeepTheirDenoisedPicture
    DenoiseTest.EndsAtATargetOfTheDenoisedPicture
    DeviceFaultTest.ALostDeviceLeavesTheLastCheckpoint
    DeviceFaultTest.ADeviceThatIsLostAfterTheRenderLeavesTheFilm
    DeviceFaultTest.MemoryThatIsRefusedIsNamed
    DeviceFaultTest.WhatCannotBeMadeLeavesNothingBehind
    LooksTest.ToneMappingIsOfPicturesAlone
    LooksTest.TheStudioIsShownByNeutralUnlessToldOtherwise
    LooksTest.LargeTexturesAreStatedBeforeTheRender
    LooksTest.BackFacesAreLeftOutUnlessAskedFor
    LooksTest.ReplaysShowMaterialsAndLobes
    ServeTest.PicturesHaveTheBitsThatTheyHaveAlone
    TerminalTest.EveryStyleOfEveryRenderEndsWithItsFilm
    TerminalTest.ReadersThatAreGoneEndNothing
    TerminalTest.ReadersThatDoNotReadAreNotWaitedFor
    UnknownErrorTest.MeetsNoTargetAndEndsTheRender
    UnknownErrorTest.OfRadianceBeyondFloat
    IdsTest.GoWithOtherWaysToSample
    DegenerateInputTest.*
    BenchCommandTest.MeasuresWritesAndComparesWithAnEarlierBench
    BenchKernelsTest.*
    AutoScheduleTest.*
    # Single tests of many cases: a picture of 65,535 columns, a million lights, mutants of files. By default: smaller ones, mutants of
    # text, and the corpus of tools/fuzz.
    NlMeans.BandsOfALargePictureJoin
    LightChoiceTest.H14AMillionLights
    GltfFuzz.SurvivesMutantsOfPoses
    GltfFuzz.SurvivesMutantsOfBinaryFiles
    # The reference of the glTF material, PLY and Collada files of every kind, and the errors of eleven more denoised pictures. By default:
    # the unit kernels that compare values with that reference, to_gltf with OBJ files, and one denoised picture.
    OracleTest
    ToGltfPlyTest
    ToGltfColladaTest
    Blurs/DenoisedErrorTest.*
    # Farms of several processes, folders for other machines, SPIR-V's optimizer for each feature,
    # and the module for Python beside the command line. By default: what farms keep in files, and films and parts of scenes in Python.
    FarmTest
    FarmFailuresTest
    FarmSlurmTest
    GpuCheckTest
    LeanKernelsTest
    PythonAddedTest
    PythonBitsTest
    PythonImagesTest
    PythonMapsTest
    PythonManyTest
    PythonRandomDomainTest
    PythonRobotCameraTest
    PythonUseTest
)
# Of the families above.
set(byDefault
    Scenes/CausticsTest.AgreeWithPathTracing/mirrorQuad
    Albedos/FurnaceTest.H25T2T3ClosedRoom/0
    Scenes/ArithmeticTest.FilmsDoNotLeanOnMoreThanVulkanPromises/cornell_spheres
    Scenes/GoldenTest.AgreesWithTheLongRender/cornell_spheres
    Scenes/GoldenTest.AgreesWithTheLongRender/materials
    Scenes/GoldenTest.AgreesWithTheLongRender/textures
    Scenes/GoldenTest.AgreesWithTheLongRender/veach_mis
    Ways/PathPartsTest.AddUpToAll/bsdf
    Ways/SidesTest.EstimatorsOfDirectLightAgree/bsdf
    BenchTest.ChoosesAPowerOfTwoThatTakesAboutAsLong
    Samplers/ErrorEstimateTest.H30RelativeErrorsAreRelativeToTheTruth/sobol
    Samplers/DeterminismTest.H34TwoRuns/sobol
    Schedules/ResumeTest.RowsHaveTheBitsOfThePicture/1
    Settings/ScheduleTest.ChangesNoBit/Clamp
    Settings/ScheduleTest.ChangesNoBit/Lens
    Settings/ScheduleTest.ChangesNoBit/Tiles
    Blurs/DenoisedErrorTest.IsUnbiasedAndItsIntervalHolds/7
    PreviewTest.ShowsAndWritesWhatARenderGives
    PreviewTest.KeyboardAndMouseOfTheScreen
    ViewWindowTest.PrintsWhatIsClicked
)
# These count the pictures of a second, which are few under the sanitizer of threads.
set(neverSanitized "")
if(sanitizer STREQUAL "thread")
    set(neverSanitized PreviewTest.NeverFlashesBlack PreviewTest.ShowsTheFlight PreviewTest.ShowsPicturesThroughALongDrag)
endif()
