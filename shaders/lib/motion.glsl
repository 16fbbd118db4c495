// Where something that moves is between two keys of its motion (shared/scene_types.h).
#ifndef GLIM_LIB_MOTION
#define GLIM_LIB_MOTION

#include "portable.glsl"
#include "shared/scene_types.h"

struct Movement {
    vec3 axis0, axis1, axis2;  // columns of the rotation
    vec3 stretch, shear;       // as in FlatMotionKey
    vec3 translation;
    vec3 pivot;
};

// Spherical linear interpolation (Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985).
vec4 turnBetween(FlatMotionKey from, vec4 to, float share)
{
    float a = 1.0 - share, b = share;
    if (from.inverseSine > 0.0) {
        a = portableCosSin(a * from.angle).y * from.inverseSine;
        b = portableCosSin(b * from.angle).y * from.inverseSine;
    }
    vec4 q = from.rotation * a + to * b;
    return q / length(q);
}

Movement moveBetween(FlatMotionKey from, FlatMotionKey to, vec3 pivot, float time)
{
    float share = to.time > from.time ? clamp((time - from.time) / (to.time - from.time), 0.0, 1.0) : 1.0;
    vec4 q = turnBetween(from, to.rotation, share);
    vec3 square = q.xyz * q.xyz, mixed = q.yzx * q.zxy, turned = q.xyz * q.w;
    return Movement(vec3(1.0 - 2.0 * (square.y + square.z), 2.0 * (mixed.z + turned.z), 2.0 * (mixed.y - turned.y)),
                    vec3(2.0 * (mixed.z - turned.z), 1.0 - 2.0 * (square.x + square.z), 2.0 * (mixed.x + turned.x)),
                    vec3(2.0 * (mixed.y + turned.y), 2.0 * (mixed.x - turned.x), 1.0 - 2.0 * (square.x + square.y)),
                    from.stretch + share * (to.stretch - from.stretch), from.shear + share * (to.shear - from.shear),
                    from.translation + share * (to.translation - from.translation), pivot);
}

vec3 turnVector(Movement m, vec3 v)
{
    return m.axis0 * v.x + m.axis1 * v.y + m.axis2 * v.z;
}

vec3 stretchVector(vec3 stretch, vec3 shear, vec3 v)
{
    return stretch * v + shear.zxy * v.yzx + shear.yzx * v.zxy;
}

vec3 moveVector(Movement m, vec3 v)
{
    return turnVector(m, stretchVector(m.stretch, m.shear, v));
}

vec3 movePoint(Movement m, vec3 p)
{
    return moveVector(m, p + m.pivot) + m.translation;
}

// The inverse of moveVector: the stretch's inverse is that of its cofactors.
vec3 takeVectorBack(Movement m, vec3 v)
{
    vec3 turned = vec3(dot(m.axis0, v), dot(m.axis1, v), dot(m.axis2, v));
    vec3 diagonal = m.stretch.yzx * m.stretch.zxy - m.shear * m.shear;
    vec3 others = m.shear.yzx * m.shear.zxy - m.stretch * m.shear;
    float determinant = m.stretch.x * diagonal.x + m.shear.z * others.z + m.shear.y * others.y;
    return stretchVector(diagonal, others, turned) / determinant;
}

vec3 takePointBack(Movement m, vec3 p)
{
    return takeVectorBack(m, p - m.translation) - m.pivot;
}

#endif
