// A disk that emits on the side of its normal, sampled uniformly by area.
#ifndef GLIM_LIB_TEMPLATE_LIGHT
#define GLIM_LIB_TEMPLATE_LIGHT

#include "lib/frame.glsl"
#include "lib/warp.glsl"

struct TemplateLight {
    vec3 center;
    vec3 normal;  // unit
    float radius;
};

struct TemplateLightSample {
    vec3 wi;    // unit, from the point that is lit
    float far;  // how far away the light is there
    float pdf;  // per steradian; 0 behind the light
};

// The density of wi per steradian, seen from p; 0 if it misses the light or meets its back.
float pdfTemplateLight(TemplateLight light, vec3 p, vec3 wi)
{
    float cosine = -dot(light.normal, wi);
    float far = dot(light.normal, p - light.center) / cosine;
    vec3 across = p + far * wi - light.center;
    bool meets = cosine > 0.0 && far > 0.0 && dot(across, across) <= light.radius * light.radius;
    return meets ? far * far / (cosine * kPi * light.radius * light.radius) : 0.0;
}

// u in [0, 1)^2.
TemplateLightSample sampleTemplateLight(TemplateLight light, vec3 p, vec2 u)
{
    vec2 disk = light.radius * sampleDisk(u);
    Frame frame = makeFrame(light.normal);
    vec3 d = light.center + frame.x * disk.x + frame.y * disk.y - p;
    float far = length(d), cosine = -dot(light.normal, d) / far;
    return TemplateLightSample(d / far, far, cosine > 0.0 ? far * far / (cosine * kPi * light.radius * light.radius) : 0.0);
}

#endif
