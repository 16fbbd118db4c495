// Ray against capsule: all that is within a radius of a segment.
#ifndef GLIM_LIB_INTERSECT_CAPSULE
#define GLIM_LIB_INTERSECT_CAPSULE

#include "finite.glsl"
#include "intersect_sphere.glsl"

// Where a line is within something convex: t from x to y, or nothing if x > y.
const vec2 kNowhere = vec2(1.0, -1.0);

// Within `radius` of the place that the line, at t = 0, is `from` away from.
vec2 spanWithin(vec3 from, vec3 direction, float radius)
{
    float a = max(dot(direction, direction), kSmallestNormal);  // across the axis nothing may be left of it
    float middle = -dot(from, direction) / a;
    float apart = length(from + direction * middle);
    float discriminant = (radius - apart) * (radius + apart);
    if (!(discriminant >= 0.0)) {
        return kNowhere;
    }
    float reach = sqrt(discriminant / a);
    return vec2(middle - reach, middle + reach);
}

// The smallest root in (0, tMax], or -1, as of intersectSphere. A capsule is convex, so a line is within it from where it first is within
// one of its parts, the two balls and the cylinder between them, to where it last is. No part has an edge of its own that a ray could pass
// between. The ray is first moved near the segment by exact products, as there. A ray that starts outside and does not come nearer to the
// closest point of the segment meets nothing, whatever the rounding. `onSurface`: the ray starts on this capsule.
float intersectCapsule(vec3 origin, vec3 direction, vec3 base, vec3 axis, float radius, float tMax, bool onSurface)
{
    vec3 f = origin - base;
    float square = dot(axis, axis);
    vec3 apart = f - axis * clamp(dot(f, axis) / square, 0.0, 1.0);
    bool approaches = dot(apart, direction) < 0.0;
    bool outside = length(apart) >= radius;
    if (!approaches && (outside || onSurface)) {
        return -1.0;
    }
    float shift = upperBits(vec3(-dot(f - 0.5 * axis, direction) / dot(direction, direction))).x;
    vec3 high = upperBits(direction);
    vec3 near = (f + high * shift) + (direction - high) * shift;
    float along = dot(direction, axis) / square;
    float start = dot(near, axis) / square;
    vec2 body = spanWithin(near - axis * start, direction - axis * along, radius);
    vec2 slab = along == 0.0 ? (start >= 0.0 && start <= 1.0 ? body : kNowhere) : vec2(-start, 1.0 - start) / along;
    body = vec2(max(body.x, min(slab.x, slab.y)), min(body.y, max(slab.x, slab.y)));
    body = slab == kNowhere ? kNowhere : body;
    vec2 first = spanWithin(near, direction, radius);
    vec2 last = spanWithin(near - axis, direction, radius);
    float enters = min(body.x <= body.y ? body.x : kInfinity,
                       min(first.x <= first.y ? first.x : kInfinity, last.x <= last.y ? last.x : kInfinity)) + shift;
    float leaves = max(body.x <= body.y ? body.y : -kInfinity,
                       max(first.x <= first.y ? first.y : -kInfinity, last.x <= last.y ? last.y : -kInfinity)) + shift;
    bool nearSide = !onSurface && (outside || enters > 0.0);
    float t = nearSide ? max(enters, kSmallestNormal) : leaves;
    return enters <= leaves && t > 0.0 && t <= tMax ? t : -1.0;
}

#endif
