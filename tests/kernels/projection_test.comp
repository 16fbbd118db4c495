// One thread is one point of the film and one direction. Result: the direction that the film's point shows, and where the film shows the
// other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/projection.glsl"

struct Case {
    FlatProjection projection;
    vec2 film;
    vec3 direction;  // unit; x right, y up, z ahead
};

struct Result {
    vec3 direction;
    uint isSeen;
    vec3 film;  // and the film's area per solid angle
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        FlatProjection p = c.projection;
        Result result;
        bool isSeen;
        if (p.model >= kFisheye) {
            isSeen = directionFromFilm(p, p.model, c.film, result.direction);
            result.film = filmFromDirection(p, p.model, c.direction);
        } else {
            vec2 plane;
            isSeen = planeFromFilm(p, p.model, c.film, plane);
            result.direction = normalize(vec3(plane * p.scale, 1.0));
            vec3 film = filmFromPlane(p, p.model, c.direction.xy / (c.direction.z * p.scale));
            float cosine = c.direction.z;
            result.film = vec3(film.xy, film.z / (p.scale.x * p.scale.y * cosine * cosine * cosine));
        }
        result.isSeen = uint(isSeen);
        EXPECT_NEAR(dot(result.direction, result.direction), 1.0, 1e-6);
        results[TEST_THREAD] = result;
    }
    endTest();
}
