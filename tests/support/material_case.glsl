// Makes a Principled of a MaterialCase.
#ifndef GLIM_TESTS_MATERIAL_CASE
#define GLIM_TESTS_MATERIAL_CASE

#include "access/principled.glsl"
#include "access/scene.glsl"
#include "material_case.h"

Principled makePrincipled(MaterialCase c, vec3 wo)
{
    PrincipledInput m;
    float reflectance = (c.ior - 1.0) * (c.ior - 1.0) / ((c.ior + 1.0) * (c.ior + 1.0));
    m.data.metallic = c.metallic;
    m.data.roughness = c.roughness;
    m.data.reflectance = reflectance;
    m.data.specular = c.specular;
    m.data.specularColor = c.specularColor;
    m.layers = noLayers();
    m.layers.clearcoat = c.clearcoat;
    m.layers.clearcoatRoughness = c.clearcoatRoughness;
    m.layers.sheenColor = c.sheenColor;
    m.layers.sheenRoughness = c.sheenRoughness;
    m.layers.anisotropy = c.anisotropy;
    m.layers.iridescence = c.film;
    m.layers.iridescenceIor = c.filmIor;
    m.layers.diffuseTransmissionColor = c.diffuseTransmissionColor;
    m.layers.diffuseTransmission = c.diffuseTransmission;
    m.layers.transmission = c.transmission;
    m.layers.medium = c.solid > 0.0 ? 1u : 0u;
    m.baseColor = c.base;
    m.coatNormal = m.ng = c.coatNormal;
    m.filmThickness = c.filmThickness;
    m.eta = c.inside > 0.0 ? 1.0 / c.ior : c.ior;
    m.passesStraight = false;
    return makePrincipled(m, wo);
}

#endif
