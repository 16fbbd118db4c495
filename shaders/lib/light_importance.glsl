// How much light a node of the light tree may send to a point.
#ifndef GLIM_LIB_LIGHT_IMPORTANCE
#define GLIM_LIB_LIGHT_IMPORTANCE

#include "shared/scene_types.h"

// cos(max(a - b, 0)) of two angles in [0, pi], from their cosines and sines.
float cosSubtractClamped(float cosA, float sinA, float cosB, float sinB)
{
    return cosA > cosB ? 1.0 : cosA * cosB + sinA * sinB;
}

// The sine of the same.
float sinSubtractClamped(float cosA, float sinA, float cosB, float sinB)
{
    return cosA > cosB ? 0.0 : sinA * cosB - cosA * sinB;
}

float sinFromCos(float c) { return sqrt(max(0.0, (1.0 - c) * (1.0 + c))); }

// About the irradiance at p on a surface with the unit normal n, or across the light's way if n is 0. It is 0 only where no light of the
// node reaches the front of that surface, to float's rounding. Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting", 2018, section 3; with cosines instead of angles, and an upper bound of the cosine at the receiver that needs no sine.
// Within the sphere both angles are unknown and the distance counts as the radius, so that the unit of length does not matter. Sums of
// importances are finite: powers are at most 1.
float lightImportance(LightNode node, vec3 p, vec3 n)
{
    vec3 towards = node.center - p;
    float distance2 = dot(towards, towards);
    float radius2 = node.radius * node.radius;
    float inverse = 1.0 / max(max(distance2, radius2), 1e-30);
    float inverseDistance = sqrt(inverse);
    float sinSphere = min(node.radius * inverseDistance, 1.0);
    float cosSphere = sqrt((1.0 - sinSphere) * (1.0 + sinSphere));
    float cosAxis = -dot(node.axis, towards) * inverseDistance;
    cosAxis = clamp((node.children & kTwoSidedNode) != 0u ? abs(cosAxis) : cosAxis, -1.0, 1.0);
    float sinAxis = sinFromCos(cosAxis), sinNormals = sinFromCos(node.cosNormals);
    float cosNearest = cosSubtractClamped(cosAxis, sinAxis, node.cosNormals, sinNormals);
    float sinNearest = sinSubtractClamped(cosAxis, sinAxis, node.cosNormals, sinNormals);
    float cosEmitted = cosSubtractClamped(cosNearest, sinNearest, cosSphere, sinSphere);
    float cosReceived = n == vec3(0.0) ? 1.0 : clamp(dot(n, towards) * inverseDistance * cosSphere + sinSphere, 0.0, 1.0);
    float seen = cosEmitted > node.cosEmission ? max(cosEmitted, 0.0) * cosReceived : 0.0;
    return node.power * inverse * (distance2 > radius2 ? seen : 1.0);
}

#endif
