// One thread is some samples of the light that arrives at one receiver: a point in the air, or a point of a surface that is
// looked up as the renderer does. The host knows the irradiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light.glsl"
#include "access/traverse.glsl"
#include "primitive_met.glsl"

struct Case {
    vec3 point;
    float height;  // of the ray that looks the surface up along -normal; 0: in the air
    vec3 normal;
};

struct Result {
    float sum;           // over the samples, of the irradiance that each estimates (red)
    float least, most;   // of the samples
    float pdf;           // of the last one
    float pdfError;      // largest relative difference to the density computed for the point that the direction meets
    uint compared;       // samples in it
    uint elsewhere;      // samples whose direction did not meet the light that was sampled
    float surfaceError;  // distance of the surface that was looked up from the point asked for
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

struct Receiver {
    SurfaceInteraction surface;
    float error;
};

Receiver makeReceiver(Case c)
{
    if (c.height == 0.0) {
        return Receiver(SurfaceInteraction(c.point, vec3(0.0), c.normal, c.normal, vec2(0.0), true, 0u, kNoPrimitive, 0u, 0u, kNoInstance), 0.0);
    }
    PathRay ray = PathRay(c.point + c.normal * c.height, kNoPrimitive, -c.normal, 0u);
    PathHit hit = traceClosest(ray);
    SurfaceInteraction surface = makeSurfaceInteraction(ray, hit);
    return Receiver(surface, length(surface.p - c.point));
}

// As sampleDirectLight does it, for a white receiver: the irradiance that the sample stands for.
float estimate(Receiver receiver, LightSample light)
{
    float cosine = dot(light.wi, receiver.surface.ns);
    if (!(cosine > 0.0) || light.radiance.r == 0.0) {
        return 0.0;
    }
    vec3 origin = offsetRayOrigin(receiver.surface, light.wi);
    bool infinite = light.tMax > 1.0;
    ShadowRay shadow = ShadowRay(origin, receiver.surface.primitive, infinite ? light.wi : light.target - origin, light.primitive,
                                 vec3(0.0), light.tMax);
    return isUnoccluded(shadow) ? light.radiance.r * cosine : 0.0;
}

// The pdf that a path computes for a light that its ray hits by chance.
void comparePdf(Receiver receiver, LightSample light, inout Result result)
{
    vec3 origin = offsetRayOrigin(receiver.surface, light.wi);
    PathHit hit = traceClosest(PathRay(origin, receiver.surface.primitive, light.wi, 0u));
    if (primitiveMet(hit) != light.primitive) {
        ++result.elsewhere;
        return;
    }
    SurfaceInteraction met = makeSurfaceInteraction(PathRay(origin, receiver.surface.primitive, light.wi, 0u), hit);
    float cosine = abs(dot(met.ng, light.wi));
    // Nearer to grazing the rounding of the directions alone is more than the tolerance.
    if (cosine > 3e-3) {
        LightContext context = LightContext(origin, receiver.surface.ns, receiver.surface.ns, 0u);
        float pdf = pdfSurfaceLight(context, met.light - 1u, hit.t, cosine);
        result.pdfError = max(result.pdfError, abs(pdf - light.pdf) / light.pdf);
        ++result.compared;
    }
}

// `sampleCount` threads for each receiver, each with `maxBounces` samples.
void main()
{
    Case c = cases[TEST_THREAD / pass.sampleCount];
    Receiver receiver = makeReceiver(c);
    Result result = Result(0.0, kInfinity, 0.0, 0.0, 0.0, 0u, 0u, receiver.error);
    for (uint i = 0u; i < render.maxBounces; ++i) {
        uvec4 a = hash4(uvec4(TEST_THREAD, i, 0u, render.seed));
        // At the point itself, for which the host knows the irradiance; makeLightContext moves it by its error bound.
        LightContext context = LightContext(receiver.surface.p, receiver.surface.ns, receiver.surface.ns, 0u);
        LightChoice choice = chooseLight(context, a.xy);
        LightSample light = sampleLight(fetchLight(choice.light), choice.probability, context, a.zw);
        float one = estimate(receiver, light);
        EXPECT_TRUE(one >= 0.0 && !isinf(one));
        EXPECT_TRUE(light.radiance.r == 0.0 || abs(dot(light.wi, light.wi) - 1.0) < 1e-6);
        EXPECT_TRUE(light.pdf >= 0.0 && !isinf(light.pdf));
        result.sum += one;
        result.least = min(result.least, one);
        result.most = max(result.most, one);
        result.pdf = light.pdf;
        if (light.primitive != kNoPrimitive && dot(light.wi, receiver.surface.ng) > 0.0) {
            comparePdf(receiver, light, result);
        }
    }
    results[TEST_THREAD] = result;
    endTest();
}
