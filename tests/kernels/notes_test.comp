// One thread writes notes, as the only path of a pass does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/notes.glsl"

SurfaceMaterial notedMaterial()
{
    SurfaceMaterial material;
    material.data.baseColor = vec3(32.0, 33.0, 34.0);
    material.data.principled = 1u;
    material.principled.metallic = 35.0;
    material.principled.roughness = 36.0;
    material.layers = noLayers();
    material.layers.transmission = 37.0;
    material.layers.diffuseTransmission = 38.0;
    material.layers.clearcoat = 39.0;
    material.layers.clearcoatRoughness = 40.0;
    material.layers.sheenColor = vec3(41.0, 42.0, 43.0);
    material.layers.sheenRoughness = 44.0;
    material.layers.anisotropy = 45.0;
    material.layers.iridescence = 46.0;
    material.filmThickness = 47.0;
    return material;
}

void main()
{
    if (TEST_THREAD == 0u) {
        vec3 ng = vec3(4.0, 5.0, 6.0);
        noteSurface(SurfaceInteraction(vec3(1.0, 2.0, 3.0), vec3(0.0), ng, vec3(0.0), vec2(0.0), true, 0u, 0u, 0u, 0u, kNoInstance), vec3(7.0, 8.0, 9.0));
        noteMaterial(SurfaceInteraction(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0), true, 0u, 0u, 0u, 0u, kNoInstance), PathHit(0u, 0.0, vec2(0.0)),
                     notedMaterial(), 5u | 6u << kMediumBits);
        noteHitLight(10.0, 11.0);
        noteLight(12u);
        noteLightSample(13.0, 14.0, 15.0);
        noteGuide(true, 23.0, 24.0, 25.0, 26.0);
        noteLobe(30u, 31u);
        noteBounce(vec3(16.0, 17.0, 18.0), vec3(19.0, 20.0, 21.0));
        noteContinuation(22.0);
        noteArrival(27.0, true);
        EXPECT_TRUE(!kNotes || pass.pixelCount == 1u);
    }
    endTest();
}
