// Tone mapping: scene-linear light to the light of a display that shows 0 to 1. Files and the window share these functions.
#ifndef GLIM_SHARED_TONE_MAPPING_H
#define GLIM_SHARED_TONE_MAPPING_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kToneNone = 0u;
GLIM_CONST uint kToneNeutral = 1u;
GLIM_CONST uint kToneAgx = 2u;

// Infinity counts as this much, which every tone shows as white.
GLIM_CONST float kMaxToned = 1e30F;

// Khronos PBR Neutral, with the names of its specification (KhronosGroup/ToneMapping, PBR_Neutral/README.md, 2024).
GLIM_FUNCTION vec3 toneNeutral(vec3 c)
{
    float f90 = 0.04F, ks = 0.8F - f90, kd = 0.15F;
    float x = min(c.x, min(c.y, c.z));
    float f = x <= 2.0F * f90 ? x - x * x / (4.0F * f90) : f90;
    vec3 shifted = c - f;
    float p = max(shifted.x, max(shifted.y, shifted.z));
    if (p <= ks) {
        return shifted;
    }
    float pn = 1.0F - (1.0F - ks) * (1.0F - ks) / (p + 1.0F - 2.0F * ks);
    float g = 1.0F / (kd * (p - pn) + 1.0F);
    return g * (pn / p) * shifted + (1.0F - g) * pn;
}

// AgX of Troy Sobotka (github.com/sobotka/AgX, 2022): mixes the channels, applies a sigmoid to log2 from 10 stops below middle grey (.18)
// to 6.5 above, and unmixes them for a display of gamma 2.2. Matrices, and a polynomial in place of the sigmoid, by Benjamin Wrensch
// (Minimal AgX Implementation, iolite-engine.com, 2023). Of his two polynomials this one shows the brightest light as white.
GLIM_FUNCTION vec3 toneAgx(vec3 c)
{
    float lowest = -12.47393F, highest = 4.026069F;
    vec3 mixed = vec3(dot(c, vec3(0.842479062253094F, 0.0784335999999992F, 0.0792237451477643F)),
                      dot(c, vec3(0.0423282422610123F, 0.878468636469772F, 0.0791661274605434F)),
                      dot(c, vec3(0.0423756549057051F, 0.0784336F, 0.879142973793104F)));
    vec3 x = clamp((log2(max(mixed, vec3(1e-10F))) - lowest) / (highest - lowest), 0.0F, 1.0F);
    vec3 y = (((((15.5F * x - 40.14F) * x + 31.96F) * x - 6.868F) * x + 0.4298F) * x + 0.1191F) * x - 0.00232F;
    vec3 encoded = vec3(dot(y, vec3(1.19687900512017F, -0.0980208811401368F, -0.0990297440797205F)),
                        dot(y, vec3(-0.0528968517574562F, 1.15190312990417F, -0.0989611768448433F)),
                        dot(y, vec3(-0.0529716355144438F, -0.0980434501171241F, 1.15107367264116F)));
    return pow(max(encoded, vec3(0.0F)), vec3(2.2F));
}

// `tone` is kToneNone, which changes nothing, or another, which gives 0 to 1. `c` is not NaN.
GLIM_FUNCTION vec3 mapTone(vec3 c, uint tone)
{
    if (tone == kToneNone) {
        return c;
    }
    vec3 bounded = clamp(c, 0.0F, kMaxToned);
    if (tone == kToneNeutral) {
        return clamp(toneNeutral(bounded), 0.0F, 1.0F);
    }
    return clamp(toneAgx(bounded), 0.0F, 1.0F);
}

// The tone for a pixel. Where its mean is its albedo, bit for bit, it shows an unlit surface alone, whose colour stays as the file has it.
GLIM_FUNCTION uint toneOfPixel(vec3 mean, vec3 albedo, uint tone) { return mean == albedo ? kToneNone : tone; }

GLIM_SHARED_END
#endif
