// Orthonormal frames.
#ifndef GLIM_LIB_FRAME
#define GLIM_LIB_FRAME

struct Frame {
    vec3 x, y, z;
};

// A right-handed frame with the unit vector n as z. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
// The sign is taken from the bit, so that -0 and 0 both work (GLSL's sign(0) is 0).
Frame makeFrame(vec3 n)
{
    float s = (floatBitsToUint(n.z) >> 31u) != 0u ? -1.0 : 1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return Frame(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Flips the normal to the side of w.
vec3 faceForward(vec3 n, vec3 w)
{
    return dot(n, w) < 0.0 ? -n : n;
}

vec3 frameFromWorld(Frame frame, vec3 v)
{
    return vec3(dot(v, frame.x), dot(v, frame.y), dot(v, frame.z));
}

vec3 worldFromFrame(Frame frame, vec3 v)
{
    return frame.x * v.x + frame.y * v.y + frame.z * v.z;
}

// The unit vector along any non-zero finite v. v is scaled first, since squares of 1e25 or 1e-25 leave float's range.
vec3 normalizeSafely(vec3 v)
{
    vec3 a = abs(v);
    float largest = max(a.x, max(a.y, a.z));
    float scale = largest > 1e15 ? 8.271806125530277e-25 : largest < 1e-15 ? 1.2089258196146292e24 : 1.0;  // 2^-80, 2^80
    return normalize(v * scale);
}

#endif
