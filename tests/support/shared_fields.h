// Every struct of shaders/shared and every field of it, in order, for both languages. Included where these are macros of one
// argument: U and F for a word, U2, F2, U3, F3 for vectors.
#ifndef GLIM_TESTS_SHARED_FIELDS
#define GLIM_TESTS_SHARED_FIELDS
#include "../../shaders/shared/course_types.h"
#include "../../shaders/shared/denoise_types.h"
#include "../../shaders/shared/display_types.h"
#include "../../shaders/shared/guide_probe_types.h"
#include "../../shaders/shared/path_types.h"
#include "../../shaders/shared/pixel_moments.h"
#include "../../shaders/shared/scene_types.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kSharedWords = 516u;

struct EverySharedStruct {
    PathRay ray;
    PathHit hit;
    PathState state;
    PathRadiance radiance;
    FirstHit firstHit;
    ShadowRay shadowRay;
    PathNote note;
    Round round;
    RayCounts rayCounts;
    Located located;
    Status status;
    BlockSums blockSums;
    Splat splat;
    CoursePass pass_;
    RenderParameters parameters;
    CourseParameters course_;
    PixelMoments pixelMoments;
    LuminanceMoments luminanceMoments;
    CatcherMoments catcher;
    CatcherSums catcherSums;
    BrightestSample brightest;
    ChosenPixel chosen;
    MaterialData material;
    PrincipledData principled;
    LayersData layers;
    MediumData medium;
    ScatteringData scattering;
    TextureData textureTexel;
    FlatLight light;
    LightNode lightNode;
    InstanceData instance;
    FlatMotionKey motionKey;
    DisplayPass display;
    ViewPass view;
    NoisyPixel noisy;
    WeightedSum weighted;
    DenoisePass denoise;
    GuideProbePass probe;
    ProbedDirection probed;
};

GLIM_SHARED_END
#endif

#ifdef F3
// clang-format off
F3(ray.origin) U(ray.source) F3(ray.direction) U(ray.media)
U(hit.primitiveRef) F(hit.t) F2(hit.barycentric)
F3(state.throughput) F(state.pdf) F(state.cosine) F(state.etaScale) U(state.bounce) U(state.normal)
F3(radiance.radiance) F(radiance.clamped)
F3(firstHit.albedo) F(firstHit.alpha) F3(firstHit.normal) F(firstHit.depth)
F3(shadowRay.origin) U(shadowRay.source) F3(shadowRay.direction) U(shadowRay.target) F3(shadowRay.contribution)
F(shadowRay.tMax)
F3(note.point) F3(note.ng) F3(note.ns) U(note.front) F3(note.baseColor) F(note.metallic) F(note.roughness) F(note.transmission)
F(note.diffuseTransmission) F(note.clearcoat) F(note.clearcoatRoughness) F3(note.sheenColor) F(note.sheenRoughness) F(note.anisotropy)
F(note.iridescence) F(note.filmThickness) F(note.alpha) U(note.medium)
F(note.lightPdfOfHit) F(note.misWeightOfHit) U(note.light) F(note.lightPdf)
F(note.bsdfPdf) F(note.misWeightOfLight) U(note.isByGuide) F(note.guideShare) F(note.guidePdf) F(note.nextBsdfPdf) F(note.nextPdf) F(note.arrival)
U(note.lobe) U(note.lobeFlags) F3(note.weight) F3(note.throughput) F(note.continuation)
U(round.paths.count) U3(round.paths.groups) U(round.shadowRays.count) U3(round.shadowRays.groups)
U2(rayCounts.closest) U2(rayCounts.shadow)
U(located.pixel) U(located.sampleIndex)
U(status.loopCaps) U(status.overflows) U(status.transparencyCaps) U(status.mediaCaps) U(status.splatOverflows) U(status.scatteringCaps) U2(status.cutThroughput) U(status.nonFinite) U(status.located[0].pixel) U(status.located[0].sampleIndex)
U(status.located[1].pixel) U(status.located[1].sampleIndex) U(status.located[2].pixel) U(status.located[2].sampleIndex)
U(status.located[3].pixel) U(status.located[3].sampleIndex) U(status.located[4].pixel) U(status.located[4].sampleIndex)
U(status.located[5].pixel) U(status.located[5].sampleIndex) U(status.located[6].pixel) U(status.located[6].sampleIndex)
U(status.located[7].pixel) U(status.located[7].sampleIndex) U(status.located[8].pixel) U(status.located[8].sampleIndex)
U(status.located[9].pixel) U(status.located[9].sampleIndex) U(status.located[10].pixel) U(status.located[10].sampleIndex)
U(status.located[11].pixel) U(status.located[11].sampleIndex) U(status.located[12].pixel) U(status.located[12].sampleIndex)
U(status.located[13].pixel) U(status.located[13].sampleIndex) U(status.located[14].pixel) U(status.located[14].sampleIndex)
U(status.located[15].pixel) U(status.located[15].sampleIndex)
U(blockSums.count) F3(blockSums.radiance) F(blockSums.alpha) F3(blockSums.albedo) F3(blockSums.normal) F(blockSums.depth)
F(blockSums.clamped)
U2(splat.red) U2(splat.green) U2(splat.blue) U2(splat.clamped)
U(pass_.pass.tileBegin) U(pass_.pass.firstPixel) U(pass_.pass.pixelCount) U(pass_.pass.firstSample) U(pass_.pass.sampleCount)
U(pass_.pass.bounce) U(pass_.pass.accumulate) U(pass_.pass.round) U(pass_.lightRound.light) U(pass_.lightRound.lightSample)
U(pass_.lightRound.lightSamples) U(pass_.lightRound.addsEmission) U(pass_.lightRound.firstRef) U(pass_.lightRound.endRef)
F3(parameters.camera.position) F3(parameters.camera.right) F3(parameters.camera.up) F3(parameters.camera.forward)
U(parameters.camera.kind) F3(parameters.camera.lensRight) F3(parameters.camera.lensUp) F(parameters.camera.inverseFocus)
U(parameters.camera.media) U(parameters.camera.projection.model)
F2(parameters.camera.projection.shift) F2(parameters.camera.projection.scale)
F3(parameters.camera.projection.radial) F(parameters.camera.projection.radial.w) F2(parameters.camera.projection.radial2)
F2(parameters.camera.projection.tangential) F(parameters.camera.projection.end)
U(parameters.camera.motion)
U(parameters.width) U(parameters.height) U(parameters.seed) U(parameters.maxBounces) U(parameters.minPathLength)
U(parameters.maxPathLength) U(parameters.lightCount) U(parameters.finiteLights) F(parameters.infiniteImportance) U(parameters.environmentLight) F3(parameters.environment)
F(parameters.clampIndirect) U(parameters.canarySteps) U(parameters.triangleCount) U(parameters.instanceCount) U(parameters.firstInstanceRef) U(parameters.firstUv) U(parameters.firstTangent)
U(parameters.firstColor) U(parameters.firstMedium) U(parameters.firstScattering) U(parameters.hidesEnvironment) U(parameters.darkensObjects) U2(parameters.environmentSize) U2(parameters.environmentCells)
F2(parameters.environmentRotation) F(parameters.environmentSplit) U(parameters.brightCells) U(parameters.causticTargets) U(parameters.causticLights) U(parameters.lightPaths)
F(parameters.splatScale) U(parameters.comparesPaths) F(parameters.timeBegin) F(parameters.timeSpan) U(parameters.lightGroups)
U(course_.refCount) F(course_.continuation) F(course_.tolerance) U(course_.constantSamples)
U(pixelMoments.count) U(pixelMoments.blocks) F3(pixelMoments.mean) F3(pixelMoments.squares) F(pixelMoments.alpha)
F3(pixelMoments.albedo) F3(pixelMoments.normal) F(pixelMoments.depth) F(pixelMoments.clamped)
U(luminanceMoments.count) F(luminanceMoments.mean) F(luminanceMoments.squares) U(luminanceMoments.met)
U(catcher.count) F(catcher.share) F3(catcher.with) F3(catcher.without) F3(catcher.squares)
F(catcherSums.share) F3(catcherSums.with) F3(catcherSums.without) U(catcherSums.page.count) F(catcherSums.page.share)
F3(catcherSums.page.with) F3(catcherSums.page.without) F3(catcherSums.page.squares)
F(brightest.luminance) U(brightest.sampleIndex)
U(chosen.pixel) U(chosen.samplesBefore)
F3(material.baseColor) U(material.type) F3(material.emission) F(material.ior) U(material.flags) U(material.principled) F(material.alpha)
F(material.alphaCutoff)
F(principled.metallic) F(principled.roughness) F(principled.reflectance) F(principled.specular) F3(principled.specularColor)
F(principled.normalScale) U(principled.textures) U(principled.firstTexture) U(principled.layers) U(principled.glossy)
U2(principled.unused) U(principled.unused.z) U(principled.unused.w)
F(layers.clearcoat) F(layers.clearcoatRoughness) F(layers.clearcoatNormalScale) U(layers.unusedOfClearcoat)
F3(layers.sheenColor) F(layers.sheenRoughness)
F(layers.anisotropy) F(layers.anisotropyCosine) F(layers.anisotropySine) U(layers.unusedOfAnisotropy)
F(layers.iridescence) F(layers.iridescenceIor) F(layers.iridescenceThicknessMinimum) F(layers.iridescenceThicknessMaximum)
F3(layers.diffuseTransmissionColor) F(layers.diffuseTransmission) F(layers.transmission) U(layers.medium) U(layers.scattersThin) F(layers.backscattered)
F3(medium.extinction) F(medium.ior) F(medium.spread) F3(medium.unused)
F3(scattering.albedo) F(scattering.anisotropy)
U(textureTexel.firstTexel) U(textureTexel.size) U(textureTexel.flags) U(textureTexel.unused) F3(textureTexel.rowU) U(textureTexel.unusedU) F3(textureTexel.rowV)
U(textureTexel.unusedV)
U(light.kind) U(light.primitiveRef) U(light.primitive) U(light.otherPrimitive) F3(light.intensity) F(light.probability) F3(light.position)
F(light.size) F3(light.edge1) F(light.versineInner) F3(light.edge2) F(light.versineOuter)
F3(lightNode.center) F(lightNode.radius) F3(lightNode.axis) F(lightNode.power) F(lightNode.cosNormals) F(lightNode.cosEmission)
U(lightNode.children) U(lightNode.firstLight)
F3(instance.column0) U(instance.beginRef) F3(instance.column1) U(instance.firstRef) F3(instance.column2) U(instance.firstPrimitive)
F3(instance.translation) U(instance.mirrors) F3(instance.errorBound) U(instance.motion)
F3(motionKey.translation) F(motionKey.time) F3(motionKey.rotation) F(motionKey.rotation.w) F3(motionKey.stretch) F(motionKey.angle)
F3(motionKey.shear) F(motionKey.inverseSine)
U(display.left) U(display.top) U(display.width) U(display.height) U(display.filmWidth) U(display.filmHeight)
U(display.tileBegin) U(display.tileCount) F(display.scale) U(display.tone) F(display.low) F(display.high) U(display.drawn)
U(view.width) U(view.firstRow) U(view.rows) U(view.left) U(view.top) U(view.right) U(view.bottom) U(view.shownAs) F(view.scale) U(view.tone)
F(view.low) F(view.high) F(view.relative) F(view.epsilon)
F3(noisy.mean) F3(noisy.variance) F3(weighted.radiance) F(weighted.weight)
U(denoise.width) U(denoise.height) U(denoise.first) U(denoise.count) U(denoise.windowRow)
F3(probe.point) F3(probe.normal) U(probe.directions) F3(probed.w) F(probed.pdf) F(probed.share)
// clang-format on
#endif
