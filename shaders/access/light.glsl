// Selects and samples lights, and evaluates the density of light that a ray has hit. A new kind of light adds its branches here.
#ifndef GLIM_ACCESS_LIGHT
#define GLIM_ACCESS_LIGHT

#include "lib/cone.glsl"
#include "lib/frame.glsl"
#include "lib/finite.glsl"
#include "lib/punctual.glsl"
#include "lib/spherical_rectangle.glsl"
#include "lib/spherical_triangle.glsl"
#include "lib/warp.glsl"
#include "environment_map.glsl"
#include "light_choice.glsl"
#include "material.glsl"

// Light that could arrive at a point.
struct LightSample {
    vec3 wi;           // unit, towards the light
    vec3 radiance;     // radiance / pdf of wi per steradian, the light's probability included; 0: none
    float pdf;         // per steradian, the light's probability included; 0: a delta light, which no ray hits
    vec3 target;       // a point that shadow rays aim at, clear of the light's surface
    uint primitive;    // the light's surface, or kNoPrimitive
    float tMax;        // 1: the light is at `target`; infinity: it is infinitely far
};

const LightSample kNoLight = LightSample(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), kNoPrimitive, 1.0);

uint getLightKind(FlatLight light)
{
    return light.kind & kLightKindMask;
}

bool isDoubleSided(FlatLight light)
{
    return (light.kind & kDoubleSidedLight) != 0u;
}

#define isSphereLight(light) (hasFeature(kFeatureSphereLights) && getLightKind(light) == kSphereLight)
#define isRectangleLight(light) (hasFeature(kFeatureRectangleLights) && getLightKind(light) == kRectangleLight)

// Whether a sphere light is sampled by its cone, with sin^2 of the half angle; from within or on the surface it is sampled by area. `from`
// is relative to the centre.
bool seesCone(vec3 from, float radius, out float sin2)
{
    float distance2 = dot(from, from);
    sin2 = radius * radius / distance2;
    return sin2 < 1.0;
}

// Triangles and rectangles are sampled by solid angle above about this many steradians. Below it, the points of a light that is not seen
// edge-on are about as far away as each other, and sampling by area has as little noise.
const float kNear = 3e-4;

bool isNear(FlatLight light, vec3 p)
{
    vec3 from = light.position - p;
    return light.size > kNear * dot(from, from);
}

SphericalRectangle rectangleSeenFrom(FlatLight light, vec3 p)
{
    vec3 x = light.edge1 * light.versineInner, y = light.edge2 * light.versineOuter;  // reciprocal lengths
    return makeSphericalRectangle(p, light.position, x, y, dot(light.edge1, x), dot(light.edge2, y));
}

float computeSolidAngle(FlatLight light, vec3 p)
{
    float solidAngle = 0.0;
    if (isRectangleLight(light)) {
        solidAngle = rectangleSeenFrom(light, p).solidAngle;
    } else if (hasFeature(kFeatureTriangleLights)) {
        solidAngle = makeSphericalTriangle(p, light.position, light.edge1, light.edge2).solidAngle;
    }
    return solidAngle;
}

// Where on the light, in lengths of its edges; and the solid angle, if the light is near.
vec2 samplePolygon(FlatLight light, vec3 p, vec2 u, out float solidAngle)
{
    bool near = isNear(light, p);
    vec2 at = u;
    solidAngle = 0.0;
    if (isRectangleLight(light)) {
        SphericalRectangle rectangle = rectangleSeenFrom(light, p);
        at = near ? sampleSphericalRectangle(rectangle, u) : u;
        solidAngle = rectangle.solidAngle;
    } else if (hasFeature(kFeatureTriangleLights)) {
        SphericalTriangle triangle = makeSphericalTriangle(p, light.position, light.edge1, light.edge2);
        at = near ? sampleSphericalTriangle(triangle, u) : sampleTriangle(u);
        solidAngle = triangle.solidAngle;
    }
    return at;
}

// Density per steradian of a direction towards a point of `light` at distance t, which it meets at |cos| `cosine`; the light's
// probability included.
float pdfSurfaceLight(FlatLight light, float probability, LightContext context, float t, float cosine)
{
    float sin2;
    if (isSphereLight(light)) {
        if (seesCone(context.p - light.position, light.size, sin2)) {
            return probability * pdfCone(sin2);
        }
        return probability * t * t / (4.0 * kPi * light.size * light.size * cosine);
    }
    bool near = isNear(light, context.p);
    return probability * (near ? 1.0 : t * t) / (near ? computeSolidAngle(light, context.p) : light.size * cosine);
}

// Density per steradian with which choosing and sampling lights would have found the light that a ray has hit at distance t and |cos|
// `cosine`.
float pdfSurfaceLight(LightContext context, uint light, float t, float cosine)
{
    return pdfSurfaceLight(fetchLight(light), computeLightProbability(context, light), context, t, cosine);
}

// Density per steradian with which choosing and sampling lights would have found the environment in the direction wi. cosine: against the
// normal that lights were sampled for.
float pdfEnvironment(LightContext context, vec3 wi, float cosine)
{
    return computeLightProbability(context,
                                   render.environmentLight) * (hasEnvironmentMap() ? pdfEnvironmentMap(wi) : pdfCosineHemisphere(cosine));
}

// Whether the light's emission changes over its surface, by a texture, coverage or a coat.
#define isUneven(light) (hasFeature(kFeatureTextures | kFeatureAlpha | kFeatureClearcoat) && ((light).kind & kUnevenLight) != 0u)

// A sampled point of a surface light.
struct LightPoint {
    vec3 p;
    vec2 barycentric;
    float cosine;  // of the direction that its light leaves in
};

vec3 computeLightNormal(FlatLight light)
{
    return triangleNormalFromSides(light.edge1, light.edge2 - light.edge1, -light.edge2);
}

// The samplers of surface lights give the light's own intensity as radiance, not divided by the pdf (sampleSurfaceLight).
LightSample samplePolygonLight(FlatLight light, float probability, LightContext context, vec2 u, out LightPoint at)
{
    float solidAngle;
    vec2 barycentric = samplePolygon(light, context.p, u, solidAngle);
    vec3 point = trianglePoint(light.position, light.edge1, light.edge2, barycentric);
    vec3 n = computeLightNormal(light);
    vec3 towards = point - context.p;
    float distance2 = dot(towards, towards);
    vec3 wi = towards / sqrt(distance2);
    float facing = -dot(n, wi);
    float cosine = isDoubleSided(light) ? abs(facing) : facing;
    bool near = isNear(light, context.p);
    float pdf = probability * (near ? 1.0 : distance2) / (near ? solidAngle : light.size * cosine);
    vec3 target = offsetPoint(point, facing > 0.0 ? n : -n, triangleErrorBound(light.position, light.edge1, light.edge2, hasFeature(kFeatureLargeTriangles)));
    bool faces = cosine > 0.0 && (!near || solidAngle > 0.0);
    uint primitive = isRectangleLight(light) && barycentric.x + barycentric.y > 1.0 ? light.otherPrimitive : light.primitive;
    at = LightPoint(point, barycentric, cosine);
    return LightSample(faces ? wi : vec3(0.0), light.intensity, faces ? pdf : 0.0, target, primitive, 1.0);
}

// From outside: uniform in the cone.
LightSample sampleSphereCone(FlatLight light, float probability, vec3 outward, float sin2, vec2 u, out LightPoint at)
{
    vec3 local = sampleCone(u, sin2);
    // The point of the sphere in the sampled direction, by its angle at the centre (pbrt-v4, section 6.2.4). Only shadow rays aim at it. wi
    // must not be computed from it: next to the surface, the point is the receiver itself.
    float sinLocal2 = dot(local.xy, local.xy);
    float across = sinLocal2 / sqrt(sin2) + local.z * sqrt(max(0.0, 1.0 - sinLocal2 / sin2));
    float sinCenter = sqrt(max(0.0, (1.0 - across) * (1.0 + across)));
    float planar = sqrt(sinLocal2);
    vec2 azimuth = planar > 0.0 ? local.xy / planar : vec2(0.0);
    Frame frame = makeFrame(outward / length(outward));
    vec3 n = worldFromFrame(frame, vec3(azimuth * sinCenter, across));
    float pdf = probability * pdfCone(sin2);
    vec3 point = light.position + light.size * n;
    vec3 target = offsetPoint(point, n, sphereErrorBound(light.position, light.size));
    vec3 wi = worldFromFrame(frame, vec3(local.xy, -local.z));
    at = LightPoint(point, vec2(0.0), abs(dot(n, wi)));
    return LightSample(wi, light.intensity, pdf, target, light.primitive, 1.0);
}

// From within a sphere that emits inwards too: uniform over its area.
LightSample sampleSphereArea(FlatLight light, float probability, LightContext context, vec2 u, out LightPoint at)
{
    vec3 n = sampleSphere(u);
    vec3 point = light.position + light.size * n;
    vec3 towards = point - context.p;
    float lightDistance = length(towards);
    float cosine = dot(n, towards) / lightDistance;
    if (!(cosine > 0.0)) {
        return kNoLight;
    }
    float pdf = pdfSurfaceLight(light, probability, context, lightDistance, cosine);
    vec3 target = offsetPoint(point, -n, sphereErrorBound(light.position, light.size));
    at = LightPoint(point, vec2(0.0), cosine);
    return LightSample(towards / lightDistance, light.intensity, pdf, target, light.primitive, 1.0);
}

LightSample sampleSphereLight(FlatLight light, float probability, LightContext context, vec2 u, out LightPoint at)
{
    vec3 outward = context.p - light.position;
    float sin2;
    if (seesCone(outward, light.size, sin2)) {
        return sampleSphereCone(light, probability, outward, sin2, u, at);
    }
    return isDoubleSided(light) ? sampleSphereArea(light, probability, context, u, at) : kNoLight;
}

LightSample sampleSurfaceLight(FlatLight light, float probability, LightContext context, vec2 u)
{
    LightPoint at;
    LightSample s = kNoLight;
    if (isSphereLight(light)) {
        s = sampleSphereLight(light, probability, context, u, at);
    } else if (hasFeature(kFeatureTriangleLights | kFeatureRectangleLights)) {
        s = samplePolygonLight(light, probability, context, u, at);
    }
    if (isUneven(light) && s.pdf > 0.0) {
        s.radiance *= emissionFactor(fetchPlacedPrimitive(light.primitiveRef), at.p, at.barycentric, at.cosine);
    }
    s.radiance = s.pdf > 0.0 ? s.radiance / s.pdf : vec3(0.0);
    return s;
}

LightSample samplePunctualLight(FlatLight light, float probability, vec3 from)
{
    if (getLightKind(light) == kDirectionalLight) {
        return LightSample(-light.edge1, light.intensity / probability, 0.0, from - light.edge1, kNoPrimitive, kInfinity);
    }
    vec3 towards = light.position - from;
    float distance2 = dot(towards, towards);
    if (!(distance2 > 0.0)) {
        return kNoLight;
    }
    vec3 wi = towards / sqrt(distance2);
    float falloff = rangeFalloff(distance2, light.size);
    if (getLightKind(light) == kSpotLight) {
        falloff *= spotFalloff(versine(-wi, light.edge1), light.versineInner, light.versineOuter);
    }
    return LightSample(wi, light.intensity * falloff / distance2 / probability, 0.0, light.position, kNoPrimitive, 1.0);
}

// A constant environment is sampled by the cosine about the shading normal: on an open diffuse surface it has no variance.
LightSample sampleEnvironment(FlatLight light, float probability, LightContext context, vec2 u)
{
    vec3 local = sampleCosineHemisphere(u);
    float pdf = probability * pdfCosineHemisphere(local.z);
    if (!(pdf > 0.0)) {
        return kNoLight;
    }
    vec3 wi = worldFromFrame(makeFrame(context.ns), local);
    return LightSample(wi, light.intensity / pdf, pdf, context.p + wi, kNoPrimitive, kInfinity);
}

LightSample sampleEnvironmentMap(float probability, LightContext context, uvec2 bits)
{
    float pdf;
    vec3 wi = sampleEnvironmentMap(bits, pdf);
    pdf *= probability;
    return LightSample(wi, environmentRadiance(wi) / pdf, pdf, context.p + wi, kNoPrimitive, kInfinity);
}

// The density includes `probability`, with which the light was chosen. bits: two random words.
LightSample sampleLight(FlatLight light, float probability, LightContext context, uvec2 bits)
{
    uint kind = getLightKind(light);
    if (hasFeature(kFeatureTriangleLights | kFeatureRectangleLights | kFeatureSphereLights) && kind <= kSphereLight) {
        return sampleSurfaceLight(light, probability, context, unitFloat(bits));
    }
    if (hasEnvironment() && kind == kEnvironmentLight) {
        if (hasEnvironmentMap()) {
            return sampleEnvironmentMap(probability, context, bits);
        }
        return sampleEnvironment(light, probability, context, unitFloat(bits));
    }
    if (hasFeature(kFeaturePunctualLights) && kind >= kPointLight && kind <= kDirectionalLight) {
        return samplePunctualLight(light, probability, context.p);
    }
    return kNoLight;
}

#endif
