// How much light a node of the light tree may send to a point.
#ifndef GLIM_LIB_LIGHT_IMPORTANCE
#define GLIM_LIB_LIGHT_IMPORTANCE

#include "shared/scene_types.h"

// cos(max(a - b, 0)) of two angles in [0, pi], from their cosines and sines.
float cosOfRest(float cosA, float sinA, float cosB, float sinB)
{
    return cosA > cosB ? 1.0 : cosA * cosB + sinA * sinB;
}

// The sine of the same.
float sinOfRest(float cosA, float sinA, float cosB, float sinB)
{
    return cosA > cosB ? 0.0 : sinA * cosB - cosA * sinB;
}

float sinFromCos(float c) { return sqrt(max(0.0, (1.0 - c) * (1.0 + c))); }

// About the irradiance at p on a surface with the unit normal n, or across the light's way if n is 0. It is 0 only where no light of the
// node reaches the front of that surface, to float's rounding. Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting", 2018, section 3; with cosines instead of angles. Within the sphere both angles are unknown and the distance counts as the
// radius, so that the unit of length does not matter.
float lightImportance(LightNode node, vec3 p, vec3 n)
{
    vec3 towards = node.center - p;
    float distance2 = dot(towards, towards);
    float radius2 = node.radius * node.radius;
    bool outside = distance2 > radius2;
    vec3 wi = towards / sqrt(max(distance2, 1e-37));
    float sin2 = outside ? radius2 / distance2 : 0.0;
    float sinSphere = sqrt(sin2), cosSphere = sqrt(1.0 - sin2);
    float cosAxis = -dot(node.axis, wi);
    cosAxis = clamp((node.child & kTwoSidedNode) != 0u ? abs(cosAxis) : cosAxis, -1.0, 1.0);
    float sinAxis = sinFromCos(cosAxis), sinNormals = sinFromCos(node.cosNormals);
    float cosNearest = cosOfRest(cosAxis, sinAxis, node.cosNormals, sinNormals);
    float sinNearest = sinOfRest(cosAxis, sinAxis, node.cosNormals, sinNormals);
    float cosEmitted = cosOfRest(cosNearest, sinNearest, cosSphere, sinSphere);
    float cosArriving = dot(n, wi);
    float cosReceived = n == vec3(0.0) ? 1.0 : cosOfRest(cosArriving, sinFromCos(cosArriving), cosSphere, sinSphere);
    float seen = cosEmitted > node.cosEmission ? max(cosEmitted, 0.0) * max(cosReceived, 0.0) : 0.0;
    return node.power * (outside ? seen / distance2 : 1.0 / max(radius2, 1e-37));
}

#endif
