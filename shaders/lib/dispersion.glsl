// Dispersion: a path that meets a dispersive medium goes on at one wavelength.
#ifndef GLIM_LIB_DISPERSION
#define GLIM_LIB_DISPERSION

// Cauchy's equation by the index at 587.6 nm and the spread (ior - 1) / Abbe number, as KHR_materials_dispersion gives it; at least 1.
float iorAt(float wavelength, float ior, float spread)
{
    return max(ior + spread * (523655.0 / (wavelength * wavelength) - 1.5168), 1.0);
}

struct Wavelength {
    float nm;
    vec3 color;  // of the path's throughput; its mean over u is 1
};

// One channel, and in it a wavelength about the channel's mean with a triangular density: rainbows without steps. u in [0, 1)^2. The means
// are those of the primaries of Rec.709.
Wavelength sampleWavelength(vec2 u)
{
    uint channel = min(uint(3.0 * u.x), 2u);
    float v = 3.0 * u.x - float(channel);  // with u.y, two numbers for the triangle
    float center = channel == 0u ? 611.0 : channel == 1u ? 549.0 : 465.0;
    vec3 color = vec3(channel == 0u ? 3.0 : 0.0, channel == 1u ? 3.0 : 0.0, channel == 2u ? 3.0 : 0.0);
    return Wavelength(center + 60.0 * (u.y + v - 1.0), color);
}

#endif
