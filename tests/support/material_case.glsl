// Makes a Principled of a MaterialCase.
#ifndef GLIM_TESTS_MATERIAL_CASE
#define GLIM_TESTS_MATERIAL_CASE

#include "access/principled.glsl"
#include "material_case.h"

Principled makePrincipled(MaterialCase c, vec3 wo)
{
    PrincipledInput m;
    float reflectance = (c.ior - 1.0) * (c.ior - 1.0) / ((c.ior + 1.0) * (c.ior + 1.0));
    m.data = PrincipledData(c.metallic, c.roughness, reflectance, c.specular, c.specularColor, 1.0, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 0u);
    m.layers = LayersData(c.clearcoat, c.clearcoatRoughness, 0u, 0u, c.sheenColor, c.sheenRoughness, 0u, 0u, 0u, 1.0, c.anisotropy, 1.0, 0.0,
                          0u, c.film, c.filmIor, 0.0, c.filmThickness, 0u, 0u, c.transmission, 0u, c.diffuseTransmissionColor,
                          c.diffuseTransmission, 0u, 0u, c.solid > 0.0 ? 1u : 0u, 0u);
    m.baseColor = c.base;
    m.coatNormal = c.coatNormal;
    m.filmThickness = c.filmThickness;
    m.eta = c.inside > 0.0 ? 1.0 / c.ior : c.ior;
    m.passesStraight = false;
    return makePrincipled(m, wo);
}

#endif
