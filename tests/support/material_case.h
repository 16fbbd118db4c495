// A glTF material in numbers, and the Principled that they make; in both languages, and in the order of Material in
// tests/oracle/write_cases.py.
#ifndef GLIM_TESTS_MATERIAL_CASE_H
#define GLIM_TESTS_MATERIAL_CASE_H
#include "../../shaders/shared/vocabulary.h"

GLIM_SHARED_BEGIN

struct MaterialCase {
    vec3 base;
    float metallic;
    float roughness;
    float ior;
    float specular;
    vec3 specularColor;
    float anisotropy;
    float clearcoat;
    float clearcoatRoughness;
    vec3 coatNormal;
    vec3 sheenColor;
    float sheenRoughness;
    float film, filmIor, filmThickness;
    float transmission;
    float diffuseTransmission;
    vec3 diffuseTransmissionColor;
    float solid;   // 1: it encloses a medium
    float inside;  // 1: wo is in there
};

GLIM_SHARED_END
#endif
