// One thread is one index of a texel buffer that holds consecutive numbers as float bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/scene.glsl"

// Texel t, word k of every buffer holds the float 4 t + k.
float word(uint index, uint texels, uint place)
{
    return float(4u * texels * index + place);
}

vec3 words(uint index, uint texels, uint place)
{
    return vec3(word(index, texels, place), word(index, texels, place + 1u), word(index, texels, place + 2u));
}

void expectMaterial(uint i)
{
    FlatMaterial m = fetchMaterial(i);
    EXPECT_TRUE(m.baseColor == words(i, kMaterialTexels, 0u));
    EXPECT_EQUAL(uintBitsToFloat(m.scattering), word(i, kMaterialTexels, 3u));
    EXPECT_TRUE(m.emission == words(i, kMaterialTexels, 4u));
    EXPECT_EQUAL(m.ior, word(i, kMaterialTexels, 7u));
    EXPECT_EQUAL(uintBitsToFloat(m.doubleSided), word(i, kMaterialTexels, 8u));
}

void expectLight(uint i)
{
    FlatLight l = fetchLight(i);
    EXPECT_EQUAL(uintBitsToFloat(l.kind), word(i, kLightTexels, 0u));
    EXPECT_EQUAL(uintBitsToFloat(l.firstEmitter), word(i, kLightTexels, 1u));
    EXPECT_EQUAL(uintBitsToFloat(l.emitterCount), word(i, kLightTexels, 2u));
    EXPECT_EQUAL(l.probability, word(i, kLightTexels, 3u));
    EXPECT_TRUE(l.position == words(i, kLightTexels, 4u));
    EXPECT_EQUAL(l.radius, word(i, kLightTexels, 7u));
    EXPECT_TRUE(l.direction == words(i, kLightTexels, 8u));
    EXPECT_EQUAL(l.cosInner, word(i, kLightTexels, 11u));
    EXPECT_TRUE(l.intensity == words(i, kLightTexels, 12u));
    EXPECT_EQUAL(l.cosOuter, word(i, kLightTexels, 15u));
    EXPECT_EQUAL(uintBitsToFloat(l.alias.threshold), word(i, kLightTexels, 16u));
    EXPECT_EQUAL(uintBitsToFloat(l.alias.other), word(i, kLightTexels, 17u));
    EXPECT_EQUAL(uintBitsToFloat(l.doubleSided), word(i, kLightTexels, 18u));
}

void expectEmitter(uint i)
{
    FlatEmitter e = fetchEmitter(i);
    EXPECT_EQUAL(uintBitsToFloat(e.alias.threshold), word(i, kEmitterTexels, 0u));
    EXPECT_EQUAL(uintBitsToFloat(e.alias.other), word(i, kEmitterTexels, 1u));
    EXPECT_EQUAL(uintBitsToFloat(e.record), word(i, kEmitterTexels, 2u));
    EXPECT_EQUAL(uintBitsToFloat(e.light), word(i, kEmitterTexels, 3u));
    EXPECT_EQUAL(e.areaPdf, word(i, kEmitterTexels, 4u));
}

void main()
{
    if (isTestThread()) {
        expectMaterial(TEST_THREAD);
        expectLight(TEST_THREAD);
        expectEmitter(TEST_THREAD);
        Record record = fetchRecord(TEST_THREAD);
        EXPECT_TRUE(floatsOf(record.t0) == words(TEST_THREAD, kRecordTexels, 0u));
        EXPECT_TRUE(floatsOf(record.t1) == words(TEST_THREAD, kRecordTexels, 4u));
        EXPECT_TRUE(floatsOf(record.t2) == words(TEST_THREAD, kRecordTexels, 8u));
        EXPECT_TRUE(!isSphere(record));
        record.t1.w |= kSphereBit;
        EXPECT_TRUE(isSphere(record));
    }
    endTest();
}
