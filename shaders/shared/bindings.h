// Binding numbers of set 0, and ids of specialization constants.
#ifndef GLIM_SHARED_BINDINGS_H
#define GLIM_SHARED_BINDINGS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// What kernels write as a storage buffer they read as texels at the binding that is so much higher.
GLIM_CONST uint kTexelsOf = 64u;

// scene.glsl
GLIM_CONST uint kBindNodes = 0u;
GLIM_CONST uint kBindRecords = 1u;
GLIM_CONST uint kBindNormals = 2u;
GLIM_CONST uint kBindMaterials = 3u;
GLIM_CONST uint kBindLights = 4u;
GLIM_CONST uint kBindEmitters = 5u;
GLIM_CONST uint kBindCamera = 6u;
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
GLIM_CONST uint kBindQueueSizes = 16u;
GLIM_CONST uint kBindQueueTails = 17u;
GLIM_CONST uint kBindRayCounts = 18u;
GLIM_CONST uint kBindBlocks = 19u;
GLIM_CONST uint kBindPages = 20u;
GLIM_CONST uint kBindLuminance = 21u;
GLIM_CONST uint kBindChosenPixels = 22u;
GLIM_CONST uint kBindBrightest = 23u;
GLIM_CONST uint kBindNote = 24u;
GLIM_CONST uint kBindStatus = 25u;
// display.glsl, with blocks and pages
GLIM_CONST uint kBindFolded = 26u;
GLIM_CONST uint kBindText = 27u;
GLIM_CONST uint kBindPicture = 28u;
GLIM_CONST uint kBindShown = 29u;
// tests
GLIM_CONST uint kBindCases = 30u;
GLIM_CONST uint kBindReport = 31u;
GLIM_CONST uint kBindResults = 32u;

GLIM_CONST uint kSpecWorkgroup = 0u;
GLIM_CONST uint kSpecSpheres = 1u;         // the scene has spheres
GLIM_CONST uint kSpecSmooth = 2u;          // some triangles have vertex normals
GLIM_CONST uint kSpecMirrors = 3u;         // some material is a mirror
GLIM_CONST uint kSpecTriangleLights = 4u;  // some triangle emits
GLIM_CONST uint kSpecPunctualLights = 5u;
GLIM_CONST uint kSpecEnvironment = 6u;
GLIM_CONST uint kSpecSobol = 7u;           // else independent samples
GLIM_CONST uint kSpecMollerTrumbore = 8u;  // else watertight
GLIM_CONST uint kSpecBruteForce = 9u;      // every primitive against every ray; else the BVH
GLIM_CONST uint kSpecDirect = 10u;         // kDirectMis ...
GLIM_CONST uint kSpecRoulette = 11u;       // kRouletteThroughput ...
GLIM_CONST uint kSpecLens = 12u;           // else a pinhole
GLIM_CONST uint kSpecChosen = 13u;         // passes go over chosen pixels
GLIM_CONST uint kSpecView = 14u;           // kViewNormal ...
GLIM_CONST uint kSpecLook = 15u;           // kLookRadiance ...
GLIM_CONST uint kSpecFolded = 16u;         // the host has taken pages of the film, and given them back folded
GLIM_CONST uint kSpecSuspects = 17u;       // each pixel's brightest sample is kept
GLIM_CONST uint kSpecNotes = 18u;          // the kernels note what they find out about the only path of a pass
GLIM_CONST uint kSpecLuminance = 19u;      // the film knows the luminance of its pixels
GLIM_CONST uint kSpecSlivers = 20u;        // some triangle is a sliver
GLIM_CONST uint kSpecGlasses = 21u;        // some material is glass
GLIM_CONST uint kSpecSphereLights = 22u;   // some sphere emits
GLIM_CONST uint kSpecStackLevels = 23u;    // as many as the BVH needs

// How direct light is estimated.
GLIM_CONST uint kDirectMis = 0u;
GLIM_CONST uint kDirectLights = 1u;
GLIM_CONST uint kDirectHemisphere = 2u;
GLIM_CONST uint kDirectBsdf = 3u;

GLIM_CONST uint kRouletteThroughput = 0u;
GLIM_CONST uint kRouletteFixed = 1u;
GLIM_CONST uint kRouletteNone = 2u;

GLIM_CONST uint kViewNormal = 1u;
GLIM_CONST uint kViewDepth = 2u;
GLIM_CONST uint kViewAlbedo = 3u;
GLIM_CONST uint kViewBvhSteps = 4u;

GLIM_SHARED_END
#endif
