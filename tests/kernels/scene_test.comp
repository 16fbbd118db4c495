// One thread is one primitive, as the host has it and as the flattened scene does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/scene.glsl"

struct Case {
    uint primitiveRef;
    uint id;
    uint triangle;
    vec3 corners[3];  // sphere: centre, (radius, 0, 0)
    vec3 normals[3];
    uint sliver;
    uint material;
    vec3 baseColor;
    vec3 emission;
    uint emits;
    vec3 cameraPosition;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PrimitiveRef ref = fetchPrimitiveRef(c.primitiveRef);
        EXPECT_EQUAL(getPrimitive(ref), c.id);
        EXPECT_EQUAL(uint(isSphere(ref)), 1u - c.triangle);
        EXPECT_TRUE(toFloats(ref.t0) == c.corners[0]);
        EXPECT_TRUE(toFloats(ref.t1) == c.corners[1]);
        EXPECT_TRUE(toFloats(ref.t2) == c.corners[2]);
        EXPECT_TRUE(isSliver(ref) == (c.sliver != 0u));
        EXPECT_EQUAL(getMaterial(ref), c.material);
        if (c.triangle != 0u) {
            uvec4 vertices = texelFetch(sceneTriangles, int(c.id));
            EXPECT_TRUE(toFloats(texelFetch(sceneVertices, int(vertices.x))) == c.normals[0]);
            EXPECT_TRUE(toFloats(texelFetch(sceneVertices, int(vertices.y))) == c.normals[1]);
            EXPECT_TRUE(toFloats(texelFetch(sceneVertices, int(vertices.z))) == c.normals[2]);
        }
        MaterialData material = fetchMaterial(c.material);
        EXPECT_TRUE(material.baseColor == c.baseColor);
        EXPECT_TRUE(material.emission == c.emission);
        EXPECT_EQUAL(uint(ref.t2.w != 0u), c.emits);
        if (ref.t2.w != 0u) {
            FlatLight light = fetchLight(ref.t2.w - 1u);
            EXPECT_EQUAL(light.primitive, c.id);
            EXPECT_EQUAL(getPrimitive(fetchPrimitiveRef(light.primitiveRef)), c.id);
            EXPECT_EQUAL(light.kind, c.triangle != 0u ? kTriangleLight : kSphereLight);
            EXPECT_TRUE(light.intensity == c.emission && light.position == c.corners[0]);
            bool isRound = c.triangle == 0u;
            EXPECT_TRUE(isRound || light.edge1 == c.corners[1] - c.corners[0] && light.edge2 == c.corners[2] - c.corners[0]);
            EXPECT_CLOSE(light.size, isRound ? c.corners[1].x : 0.5 * length(cross(light.edge1, light.edge2)), 1e-5);
        }
        EXPECT_TRUE(render.camera.position == c.cameraPosition);
    }
    endTest();
}
