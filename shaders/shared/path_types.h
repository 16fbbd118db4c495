// The data that kernels pass to each other. Arrays are indexed by slot: the place of a path in the pass. The structs up to ShadowRay are
// whole texels, because kernels read them as texels (paths.glsl).
#ifndef GLIM_SHARED_PATH_TYPES_H
#define GLIM_SHARED_PATH_TYPES_H
#include "pixel_moments.h"
#include "scene_types.h"
#include "vocabulary.h"

GLIM_SHARED_BEGIN

struct PathRay {
    vec3 origin;
    uint source;     // primitive that the ray leaves, or kNoPrimitive
    vec3 direction;  // unit
    uint media;      // that it is in, and whether it has a wavelength (lib/media.glsl)
};

struct PathHit {
    uint primitiveRef;  // kNoPrimitiveRef: a miss; kScatteredRef: in a volume, before it meets a surface
    float t;
    vec2 barycentric;  // weights of v1 and v2; a sphere's are unused
};

GLIM_CONST uint kScatteredRef = 0xfffffffeu;

struct PathState {
    vec3 throughput;
    float pdf;       // of the ray's direction, per steradian; 0 for camera rays and delta lobes, which light sampling cannot replace
    float cosine;    // of the ray's direction against the shading normal it left, >= 0; or minus the scatterings in a volume since then
    float etaScale;  // product of squared relative indices: throughput * etaScale is without refraction's scaling of radiance
    uint bounce;     // surfaces met
    uint normal;     // shading normal where the ray started, octahedral (lib/octahedral.glsl), or kNoReceiverNormal; a light path's group
};

// PathState::normal of a surface that transmits: lights on both sides count.
GLIM_CONST uint kNoReceiverNormal = 0x80008000u;

struct PathRadiance {
    vec3 radiance;
    float clamped;  // mean of the three channels of what --clamp-indirect took away
};

struct FirstHit {
    vec3 albedo;
    float alpha;  // 1; 0: of a miss; -1: of a shadow catcher
    vec3 normal;
    float depth;
};

// A segment that must be free for `contribution` to count: from origin to origin + tMax * direction.
struct ShadowRay {
    vec3 origin;
    uint source;
    vec3 direction;  // unnormalised; the unit direction for directional lights and the environment (see `tMax`)
    uint target;     // primitive of the light, which does not shadow itself, or kNoPrimitive; of hemisphere rays the reference met so far
    vec3 contribution;
    float tMax;  // 1, or infinity
};

GLIM_CONST uint kNoLightIndex = 0xffffffffu;

// What happened at a path's vertex, as far as no other buffer holds it. Lengths and directions as in PathRay, pdfs per steradian.
struct PathNote {
    vec3 point;
    vec3 ng;         // unit geometric normal on the side that the path came from
    vec3 ns;         // unit, the BSDF's
    uint front;      // 1: that side is the front
    vec3 baseColor;  // the material's numbers there, with textures and vertex colours
    float metallic;  // this and the next ones are 0 where the material has none
    float roughness;
    float transmission, diffuseTransmission;
    float clearcoat, clearcoatRoughness;
    vec3 sheenColor;
    float sheenRoughness;
    float anisotropy;
    float iridescence, filmThickness;  // thickness in nm
    float alpha;                       // coverage
    uint medium;                       // innermost of those that the ray came through, or 0
    float lightPdfOfHit;               // of light sampling, for the light that the ray has hit; 0: not evaluated
    float misWeightOfHit;              // MIS weight of that light; 1 unless noted
    uint light;                        // index of the sampled light, or kNoLightIndex
    float lightPdf;                    // of choosing that light and that direction; 0: a point, spot or directional light
    float bsdfPdf;                     // of BSDF sampling, for that direction
    float misWeightOfLight;
    uint isByGuide;      // 1: the guide chose the next direction, else the BSDF
    float guideShare;    // how likely it does; 0: no guide is known there, and the pdfs are 0
    float guidePdf;      // the guide's, for that direction; 0 of a delta lobe
    float nextBsdfPdf;   // the BSDF's
    float nextPdf;       // that it was weighted by; 0 of a delta lobe, and where the BSDF's is 0
    float arrival;       // probability of a guided path's roulette, which is on arrival; 0: there was none
    uint lobe;           // that the next direction was sampled from: kLambert, kMirror or kDielectric, or kPrincipled + kLobeInterface ...
    uint lobeFlags;      // kBsdfDelta | kBsdfTransmission
    vec3 weight;         // of the sampled direction: BSDF * |cos| / pdf
    vec3 throughput;     // with that weight, before roulette
    float continuation;  // roulette's probability to continue; 0: the path ended before
};

// How many entries a queue has, and workgroups enough for a dispatch over it (indirect arguments).
struct Queue {
    uint count;
    uvec3 groups;
};

// Workgroups that a queue asks for at once, whenever the last ones are full. So few of its entries add to their number.
GLIM_CONST uint kGroupsAtOnce = 8u;

// What a pass traces in one round: a bounce of the wavefront, or a dispatch of trace_paths.
struct Round {
    Queue paths;
    Queue shadowRays;
};

// Rounds that are recorded at once, at most. The kernels of the last one queue paths for the round after it.
GLIM_CONST uint kMaxRounds = 64u;
GLIM_CONST uint kRoundsOfPass = kMaxRounds + 1u;
// Behind the rounds of two passes, one of which may have been recorded while the device traces the other.
GLIM_CONST uint kEmptyRound = 2u * kRoundsOfPass;  // has no paths
GLIM_CONST uint kLeftRound = kEmptyRound + 1u;     // paths that a pass with kStopsNext has left: passes after it do nothing
GLIM_CONST uint kRounds = kLeftRound + 1u;

// Rays traced so far in this render, 64 bits in two words.
struct RayCounts {
    uvec2 closest;
    uvec2 shadow;
};

GLIM_CONST uint kMaxLocated = 16u;
GLIM_CONST float kCutUnit = 1.52587890625e-5f;  // of Status::cutThroughput: 2^-16

struct Located {
    uint pixel;  // index in the picture
    uint sampleIndex;
};

struct Status {
    uint loopCaps;                 // threads whose loops the driver cut short: the picture is wrong
    uint overflows;                // queue entries beyond one per slot: the picture is wrong
    uint transparencyCaps;         // rays that passed more transparent surfaces than they may: the next one counted as opaque
    uint mediaCaps;                // rays that entered more media than a path keeps: the outermost was forgotten
    uint splatOverflows;           // splats beyond what a pixel can hold: the picture is wrong
    uint scatteringCaps;           // paths that scattered in volumes more often than they may between two surfaces: they ended there
    uvec2 cutThroughput;           // of those, 64 bits in two words, in units of kCutUnit
    uint nonFinite;                // samples that were not finite, and are in no average
    Located located[kMaxLocated];  // the first of them to be counted
};

// Sums over the samples of a block so far.
struct BlockSums {
    uint count;
    vec3 radiance;
    float alpha;
    vec3 albedo;
    vec3 normal;
    float depth;  // the nearest
    float clamped;
};

// The same of a shadow catcher, and what is known of the pixel.
struct CatcherSums {
    float share;  // samples that met it first
    vec3 with, without;
    CatcherMoments page;
};

// Light that light paths have brought to a pixel: 64 bits in two words, the lower one first, so that no order of additions changes a bit.
struct Splat {
    uvec2 red, green, blue;
    uvec2 clamped;  // as in PathRadiance
};

GLIM_CONST uint kEndsBlock = 1u;   // accumulate folds the block into the page afterwards, whole or not
GLIM_CONST uint kEveryPixel = 2u;  // the pass goes over all pixels of the tile, whichever are chosen
GLIM_CONST uint kStopsNext = 4u;   // if paths are left, passes after it do nothing: the device has one already

// A pixel of a pass over some pixels of a tile, which need not have had the same number of samples before.
struct ChosenPixel {
    uint pixel;          // index in the tile
    uint samplesBefore;  // added to the pass's firstSample
};

// Push constants of every kernel of a pass: pixels [firstPixel, firstPixel + pixelCount) of a tile or, in adaptive renders, of
// its list of chosen pixels, each with samples [firstSample, firstSample + sampleCount); a chosen pixel may begin later.
// Slot = (pixel - firstPixel) * sampleCount + (sample - firstSample).
struct Pass {
    uint tileBegin;   // index in the picture of the tile's pixel 0
    uint firstPixel;  // within the tile
    uint pixelCount;
    uint firstSample;
    uint sampleCount;
    uint bounce;      // surfaces that the paths of the active queue have met
    uint accumulate;  // kEndsBlock | kEveryPixel | kStopsNext
    uint round;       // of those recorded at once
};

// What stays the same during a render. In a storage buffer: some drivers compile kernels anew for the values of a
// uniform one (driver_bugs.md).
struct RenderParameters {
    FlatCamera camera;
    uint width, height;
    uint seed;
    uint maxBounces;
    uint minPathLength;  // least number of surfaces between camera and light, for light that counts
    uint maxPathLength;
    uint lightCount;
    uint finiteLights;         // the first of them
    float infiniteImportance;  // of the others, in the unit of the light tree's
    uint environmentLight;     // index, if the scene has an environment
    vec3 environment;          // radiance, W/(sr m^2)
    float clampIndirect;       // infinity: off
    uint canarySteps;          // 3, unknown to the compiler
    uint triangleCount;        // primitives from here on are spheres
    uint instanceCount;
    uint firstInstanceRef;                   // references from here on are those of instances (scene_types.h)
    uint firstUv, firstTangent, firstColor;  // sections of the vertices (scene_types.h)
    uint firstMedium, firstScattering;       // texels of the first MediumData and ScatteringData
    uint hidesEnvironment;                   // 1: from the camera
    uint darkensObjects;                     // 1: what a catcher reflects of them is black
    uvec2 environmentSize;                   // texels of the map
    uvec2 environmentCells;                  // of its sampler
    vec2 environmentRotation;                // cosine and sine of its rotation
    float environmentSplit;                  // radiance of the map from which on light paths carry the rest of its light
    uint brightCells;                        // at which they begin
    uint causticTargets, causticLights;      // how many there are (scene_types.h)
    uint lightPaths;                         // per sample of the picture
    float splatScale;                        // units of a splat per W/(sr m^2), a power of two
    uint comparesPaths;                      // 1: Splat::clamped is what kComparedShare says
    float timeBegin, timeSpan;               // of paths, as in FlatMotionKey; of a span of 0 all have the same time
    uint lightGroups;                        // how many; 0: the film has none
};

// With comparesPaths, splats sum up in `clamped` the square of the light that a camera path would have brought by the same path, so
// weighted that its mean is that of camera paths; times splatScale^2 and this, with room for strong light.
GLIM_CONST float kComparedShare = 2.2737367544323206e-13f;  // 2^-42

// Whether a path samples lights at the surface that it meets after `bounce` others. That light has then met bounce + 1 surfaces. At the
// last hit no light is sampled: only emission is added.
GLIM_FUNCTION bool samplesLights(uint bounce, uint maxBounces, uint minPathLength, uint lightCount)
{
    return lightCount > 0u && bounce < maxBounces && bounce + 1u >= minPathLength;
}

GLIM_SHARED_END
#endif
