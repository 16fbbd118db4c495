// Binding numbers of set 0, and ids of specialization constants.
#ifndef GLIM_SHARED_BINDINGS_H
#define GLIM_SHARED_BINDINGS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// A storage buffer that kernels write is read as texels at its binding plus this.
GLIM_CONST uint kTexelsOf = 64u;

// scene.glsl
GLIM_CONST uint kBindNodes = 0u;
GLIM_CONST uint kBindPrimitiveRefs = 1u;
GLIM_CONST uint kBindTriangles = 2u;
GLIM_CONST uint kBindMaterials = 3u;
GLIM_CONST uint kBindLights = 4u;
GLIM_CONST uint kBindLightNodes = 5u;
GLIM_CONST uint kBindVertices = 34u;
GLIM_CONST uint kBindAlbedos = 35u;
GLIM_CONST uint kBindEnvironment = 36u;
GLIM_CONST uint kBindEnvironmentCells = 37u;
GLIM_CONST uint kBindCaustics = 38u;
GLIM_CONST uint kBindTexels = 40u;  // and the next ones, kMaxTexelViews in all
GLIM_CONST uint kBindInstances = 48u;
GLIM_CONST uint kBindMotions = 56u;
// parameters.glsl
GLIM_CONST uint kBindParameters = 6u;
// paths.glsl
GLIM_CONST uint kBindRays = 7u;
GLIM_CONST uint kBindHits = 8u;
GLIM_CONST uint kBindStates = 9u;
GLIM_CONST uint kBindRadiance = 10u;
GLIM_CONST uint kBindFirstHits = 11u;
GLIM_CONST uint kBindShadowRays = 12u;
GLIM_CONST uint kBindActiveQueue = 13u;
GLIM_CONST uint kBindNextQueue = 14u;
GLIM_CONST uint kBindShadowQueue = 15u;
GLIM_CONST uint kBindRounds = 16u;
GLIM_CONST uint kBindRayCounts = 17u;
GLIM_CONST uint kBindBlocks = 19u;
GLIM_CONST uint kBindPages = 20u;
GLIM_CONST uint kBindLuminance = 21u;
GLIM_CONST uint kBindBrightest = 23u;
GLIM_CONST uint kBindSplats = 39u;
GLIM_CONST uint kBindCatchers = 57u;
GLIM_CONST uint kBindGroupSums = 59u;
// light_groups.glsl
GLIM_CONST uint kBindGroupLight = 58u;
// guide.glsl, guide_records.glsl
GLIM_CONST uint kBindGuide = 60u;
GLIM_CONST uint kBindGuideRecords = 61u;
// pass.glsl
GLIM_CONST uint kBindChosenPixels = 22u;
// notes.glsl
GLIM_CONST uint kBindNote = 24u;
// status.glsl
GLIM_CONST uint kBindStatus = 18u;
// course/: the parameters of the course's estimators
GLIM_CONST uint kBindCourseParameters = 33u;
// display.glsl, with blocks, pages and catchers
GLIM_CONST uint kBindFolded = 26u;
GLIM_CONST uint kBindFoldedCatchers = 27u;
GLIM_CONST uint kBindPicture = 28u;
// view.glsl, with the picture
GLIM_CONST uint kBindViewed = 54u;
GLIM_CONST uint kBindReference = 55u;
// arithmetic.glsl
GLIM_CONST uint kBindProbed = 49u;
// denoise.glsl
GLIM_CONST uint kBindNoisy = 50u;
GLIM_CONST uint kBindPooled = 51u;
GLIM_CONST uint kBindDistances = 52u;
GLIM_CONST uint kBindSums = 53u;
// 30 to 32 are those of test kernels (tests/harness/interface.h)

GLIM_CONST uint kSpecWorkgroup = 0u;
GLIM_CONST uint kSpecFeatures = 1u;            // kFeatureSpheres ...: what the scene needs, the lower 32 bits
GLIM_CONST uint kSpecUpperFeatures = 2u;       // and the others
GLIM_CONST uint kSpecSobol = 7u;               // else independent samples
GLIM_CONST uint kSpecMollerTrumbore = 8u;      // of the course; else watertight
GLIM_CONST uint kSpecBruteForce = 9u;          // of the course: every primitive against every ray; else the BVH
GLIM_CONST uint kSpecDirect = 10u;             // of the course: kDirectMis ...
GLIM_CONST uint kSpecRoulette = 11u;           // of the course: kRouletteThroughput ...
GLIM_CONST uint kSpecLens = 12u;               // else a pinhole
GLIM_CONST uint kSpecProjection = 15u;         // kCentredFilm ...
GLIM_CONST uint kSpecChosen = 13u;             // passes go over chosen pixels
GLIM_CONST uint kSpecAov = 14u;                // kAovRadiance ...
GLIM_CONST uint kSpecFolded = 16u;             // the host has taken pages of the film, and given them back folded
GLIM_CONST uint kSpecSuspects = 17u;           // each pixel's brightest sample is kept
GLIM_CONST uint kSpecNotes = 18u;              // the kernels note what they find out about the only path of a pass
GLIM_CONST uint kSpecMovingCamera = 19u;       // while the shutter is open
GLIM_CONST uint kSpecGuided = 20u;             // paths are guided
GLIM_CONST uint kSpecLearns = 28u;             // paths learn a guide: they sample lights wherever they can
GLIM_CONST uint kSpecGuidedScatterings = 29u;  // so are those in media
GLIM_CONST uint kSpecStackLevels = 23u;        // as many as the BVH needs
GLIM_CONST uint kSpecTexelViews = 24u;         // as many as the textures need
GLIM_CONST uint kSpecPathsPerThread = 25u;     // of the device's class
GLIM_CONST uint kSpecSharedStack = 26u;        // of the device's class
GLIM_CONST uint kSpecTexelViewBits = 27u;      // of the device's limit

// Arbitrary output variables: what a picture shows, or a display of a film.
GLIM_CONST uint kAovRadiance = 0u;
GLIM_CONST uint kAovNormal = 1u;
GLIM_CONST uint kAovDepth = 2u;
GLIM_CONST uint kAovAlbedo = 3u;
GLIM_CONST uint kAovBvhSteps = 4u;  // --view bvh-steps: nodes visited, primitives tested
GLIM_CONST uint kAovGuide = 5u;     // --view guide: its mean direction, times how concentrated it is
GLIM_CONST uint kAovSampleCount = 6u;

GLIM_SHARED_END
#endif
