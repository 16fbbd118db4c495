// Camera models that are not linear: from points of the film to directions, and back.
// OpenCV 4, "Camera Calibration and 3D Reconstruction", pinhole model; Kannala, Brandt, "A Generic Camera Model and Calibration Method for
// Conventional, Wide-Angle, and Fish-Eye Lenses", PAMI 2006, equation 6, as in OpenCV's module "fisheye".
#ifndef GLIM_LIB_PROJECTION
#define GLIM_LIB_PROJECTION

#include "portable.glsl"
#include "shared/scene_types.h"
#include "warp.glsl"

// More than the inversions below need (tests/kernels/projection_test.cpp).
const int kMaxNewtonSteps = 40, kMaxTangentialSteps = 12;

// (cos x, sin x) for |x| <= pi.
vec2 turnBy(float x)
{
    float fromAxis = abs(x);
    bool behind = fromAxis > 0.5 * kPi;
    vec2 turn = portableCosSin(behind ? kPi - fromAxis : fromAxis);
    return vec2(behind ? -turn.x : turn.x, x < 0.0 ? -turn.y : turn.y);
}

// A function of two variables at a point, and its derivatives.
struct Distorted {
    vec2 value;
    mat2 jacobian;
};

float computeDeterminant(mat2 m)
{
    return m[0].x * m[1].y - m[0].y * m[1].x;
}

// How many times as far from the middle a lens images a tangent of the angle from its axis as without radial distortion, and the derivative
// by the tangent's square.
vec2 distortRatio(FlatProjection p, float r2)
{
    float above = 1.0 + r2 * (p.radial.x + r2 * (p.radial.y + r2 * p.radial.z));
    float below = max(1.0 + r2 * (p.radial.w + r2 * (p.radial2.x + r2 * p.radial2.y)), 1e-6);  // by a pole it may round to below 0
    float ratio = above / below;
    float aboveSlope = p.radial.x + r2 * (2.0 * p.radial.y + 3.0 * r2 * p.radial.z);
    float belowSlope = p.radial.w + r2 * (2.0 * p.radial2.x + 3.0 * r2 * p.radial2.y);
    return vec2(ratio, (aboveSlope - ratio * belowSlope) / below);
}

// Where a lens with radial and tangential distortion images the direction with tangents `x`.
Distorted distortRadially(FlatProjection p, vec2 x)
{
    float r2 = dot(x, x), cross2 = 2.0 * x.x * x.y;
    vec2 ratio = distortRatio(p, r2), t = p.tangential;
    float slope = 2.0 * ratio.y, mixed = slope * x.x * x.y + 2.0 * (t.x * x.x + t.y * x.y);
    return Distorted(x * ratio.x + vec2(t.x * cross2 + t.y * (r2 + 2.0 * x.x * x.x), t.x * (r2 + 2.0 * x.y * x.y) + t.y * cross2),
                     mat2(ratio.x + slope * x.x * x.x + 2.0 * t.x * x.y + 6.0 * t.y * x.x, mixed,
                          mixed, ratio.x + slope * x.y * x.y + 6.0 * t.x * x.y + 2.0 * t.y * x.x));
}

// The distance from the middle at which a lens images a tangent of the angle from its axis, or a fisheye that angle, and its derivative;
// without tangential distortion.
vec2 distortDistance(FlatProjection p, uint model, float x)
{
    float x2 = x * x;
    if (model == kFisheye) {
        float value = 1.0 + x2 * (p.radial.x + x2 * (p.radial.y + x2 * (p.radial.z + x2 * p.radial.w)));
        float slope = 1.0 + x2 * (3.0 * p.radial.x + x2 * (5.0 * p.radial.y + x2 * (7.0 * p.radial.z + x2 * (9.0 * p.radial.w))));
        return vec2(x * value, slope);
    }
    vec2 ratio = distortRatio(p, x2);
    return vec2(x * ratio.x, ratio.x + 2.0 * x2 * ratio.y);
}

// The inverse: Newton's method, and bisection where it leaves what is known to hold the root. False if there is none: the field of view
// ends before.
bool undistortDistance(FlatProjection p, uint model, float distance, out float x)
{
    float low = 0.0, high = p.end, error = 0.0, rounding = 0.0;
    x = min(distance, high);
    for (int i = 0; i < kMaxNewtonSteps; ++i) {
        vec2 now = distortDistance(p, model, x);
        float off = now.x - distance;
        error = abs(off);
        rounding = 1e-6 * (1.0 + distance + x * max(now.y, 0.0));
        low = off < 0.0 ? x : low;
        high = off < 0.0 ? high : x;
        float next = now.y > 0.0 ? x - off / now.y : low;
        if (next == x && error <= rounding) {
            break;
        }
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return error <= rounding;
}

// Tangents of the direction that the lens images at `image`. False if there is none.
bool undistortRadially(FlatProjection p, vec2 image, out vec2 x)
{
    float distance = length(image), tangent;
    bool isSeen = undistortDistance(p, kRadialTangential, distance, tangent);
    x = distance > 0.0 ? image * (tangent / distance) : vec2(0.0);
    if (p.tangential == vec2(0.0)) {
        return isSeen;
    }
    float error = 0.0;
    for (int i = 0; i < kMaxTangentialSteps && isSeen; ++i) {
        Distorted now = distortRadially(p, x);
        vec2 off = now.value - image;
        error = max(abs(off.x), abs(off.y));
        float determinant = computeDeterminant(now.jacobian);
        isSeen = determinant > 0.0;
        if (error <= 1e-7 * (1.0 + distance) || !isSeen) {
            break;
        }
        mat2 j = now.jacobian;
        x -= vec2(j[1].y * off.x - j[1].x * off.y, j[0].x * off.y - j[0].y * off.x) / determinant;
    }
    return isSeen && error <= 1e-6 * (1.0 + distance);
}

// The point of the image plane that a point of the film shows, by all models but the spherical ones. False if it shows none.
bool planeFromFilm(FlatProjection p, uint model, vec2 film, out vec2 plane)
{
    plane = film + p.shift;
    bool isSeen = true;
    if (model == kRadialTangential) {
        vec2 tangents;
        isSeen = undistortRadially(p, plane * p.scale, tangents);
        plane = tangents / p.scale;
    }
    return isSeen;
}

// The inverse, with the area of the film per area of the plane; 0 where the film does not show the plane.
vec3 filmFromPlane(FlatProjection p, uint model, vec2 plane)
{
    float area = 1.0;
    if (model == kRadialTangential) {
        vec2 tangents = plane * p.scale;
        Distorted image = distortRadially(p, tangents);
        area = length(tangents) <= p.end ? max(computeDeterminant(image.jacobian), 0.0) : 0.0;
        plane = image.value / p.scale;
    }
    return vec3(plane - p.shift, area);
}

// The direction that a point of the film shows, by spherical models; x right, y up, z ahead. False if it shows none.
bool directionFromFilm(FlatProjection p, uint model, vec2 film, out vec3 direction)
{
    vec2 image = (film + p.shift) * p.scale;
    if (model == kEquirectangular) {
        vec2 longitude = turnBy(image.x), latitude = portableCosSin(image.y);
        direction = vec3(latitude.x * longitude.y, latitude.y, latitude.x * longitude.x);
        return true;
    }
    float distance = length(image), angle;
    bool isSeen = undistortDistance(p, model, distance, angle);
    vec2 turn = turnBy(angle);
    direction = vec3(distance > 0.0 ? image * (turn.y / distance) : vec2(0.0), turn.x);
    return isSeen;
}

// The inverse, with the area of the film per solid angle, 1/sr. `direction`: unit.
vec3 filmFromDirection(FlatProjection p, uint model, vec3 direction)
{
    vec2 image;
    float area;
    float sine = length(direction.xy);
    if (model == kEquirectangular) {
        float flat2 = length(direction.xz);
        image = vec2(portableAtan2(direction.x, direction.z), portableAtan2(direction.y, flat2));
        area = 1.0 / max(flat2, 1e-6);  // the poles are points of lines
    } else {
        float angle = portableAtan2(sine, direction.z);
        vec2 distance = distortDistance(p, model, angle);
        image = sine > 0.0 ? direction.xy * (distance.x / sine) : vec2(0.0);
        area = angle > p.end ? 0.0 : max(distance.y, 0.0) * (sine > 1e-6 ? distance.x / sine : 1.0);
    }
    return vec3(image / p.scale - p.shift, area / (p.scale.x * p.scale.y));
}

#endif
