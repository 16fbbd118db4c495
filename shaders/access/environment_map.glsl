// Light from infinitely far by a latitude-longitude map (host/flatten/environment_map.hpp makes it). The radiance is interpolated between
// texel centres; at the poles it is that of the outermost row. Light is sampled by rows and columns of cells of about constant radiance.
#ifndef GLIM_ACCESS_ENVIRONMENT_MAP
#define GLIM_ACCESS_ENVIRONMENT_MAP

#include "lib/hash.glsl"
#include "lib/lat_long.glsl"
#include "parameters.glsl"
#include "scene.glsl"

layout(set = 0, binding = kBindEnvironment) uniform usamplerBuffer sceneEnvironment;  // environmentTexel
// All cells, then two texels for each of their rows.
layout(set = 0, binding = kBindEnvironmentCells) uniform usamplerBuffer sceneEnvironmentCells;

// Else the environment is constant.
#define hasEnvironmentMap() (hasFeature(kFeatureEnvironmentMap) && render.environmentSize.x > 0u)

// Three mantissas of 18 bits and an exponent.
vec3 environmentTexel(uint x, uint y)
{
    uvec2 bits = texelFetch(sceneEnvironment, int(y * render.environmentSize.x + x)).xy;
    uvec3 mantissa = uvec3(bits.x & 0x3ffffu, bits.x >> 18u | (bits.y & 0xfu) << 14u, bits.y >> 4u & 0x3ffffu);
    return vec3(mantissa) * uintBitsToFloat((bits.y >> 22u & 0xffu) << 23u);
}

// Between the world and the map: rotated about the y axis.
vec3 mapFromWorld(vec3 w)
{
    vec2 rotation = render.environmentRotation;
    return vec3(rotation.x * w.x - rotation.y * w.z, w.y, rotation.y * w.x + rotation.x * w.z);
}

vec3 worldFromMap(vec3 w)
{
    vec2 rotation = render.environmentRotation;
    return vec3(rotation.x * w.x + rotation.y * w.z, w.y, rotation.x * w.z - rotation.y * w.x);
}

// The map's radiance in the direction w, unit, in world space.
vec3 mapRadiance(vec3 w)
{
    vec2 size = vec2(render.environmentSize);
    vec2 at = latLongFromDirection(mapFromWorld(w)) * size - 0.5;
    vec2 below = floor(at);
    vec2 t = at - below;
    ivec2 first = ivec2(below), last = ivec2(render.environmentSize) - 1;
    uint left = uint(first.x < 0 ? last.x : first.x), right = uint(first.x >= last.x ? 0 : first.x + 1);
    uint top = uint(max(first.y, 0)), bottom = uint(min(first.y + 1, last.y));
    vec3 upper = mix(environmentTexel(left, top), environmentTexel(right, top), t.x);
    vec3 lower = mix(environmentTexel(left, bottom), environmentTexel(right, bottom), t.x);
    return mix(upper, lower, t.y);
}

// Radiance from the direction w, unit, in world space.
vec3 environmentRadiance(vec3 w)
{
    return render.environment * mapRadiance(w);
}

// Of it, what light paths carry, or else what is left for camera paths. The brightest directions have both.
vec3 splitEnvironmentRadiance(vec3 w, bool isBright)
{
    vec3 radiance = mapRadiance(w);
    float strongest = max(max(radiance.r, radiance.g), radiance.b);
    float dim = strongest > render.environmentSplit ? render.environmentSplit / strongest : 1.0;
    return render.environment * radiance * (isBright ? 1.0 - dim : dim);
}

// Density per steradian of sampleEnvironmentMap.
float pdfEnvironmentMap(vec3 w)
{
    uvec2 cells = render.environmentCells;
    uvec2 cell = min(uvec2(latLongFromDirection(mapFromWorld(w)) * vec2(cells)), cells - 1u);
    return uintBitsToFloat(texelFetch(sceneEnvironmentCells, int(cell.y * cells.x + cell.x)).z);
}

// The entry of a table of host/flatten/piecewise_constant.hpp that a random word falls to.
uint findEntry(uint first, uint count, uint word, uint stride, out uvec4 entry)
{
    uint range = texelFetch(sceneEnvironmentCells, int(first + stride * chooseBin(word, count))).w;
    uint low = range & 0xffffu, high = range >> 16u, middle;
    bool going;
    do {
        middle = (low + high) >> 1u;
        entry = texelFetch(sceneEnvironmentCells, int(first + stride * middle));
        going = searchesOn(entry, word, middle, low, high);
    } while (going);
    return middle;
}

// Where in the entry the word falls, in (0, 1).
float placeInEntry(uvec4 entry, uint word)
{
    return min((float(word - entry.x) + 0.5) / (float(entry.y - entry.x) + 1.0), 0.99999994);
}

// place: in [0, 1)^2, across the cell and down.
vec3 directionInCell(uint row, uint column, vec2 place)
{
    uvec2 cells = render.environmentCells;
    vec4 bounds = uintBitsToFloat(texelFetch(sceneEnvironmentCells, int(cells.x * cells.y + 2u * row + 1u)));
    float across = (float(column) + place.x) / float(cells.x);
    float q = bounds.x + (bounds.y - bounds.x) * place.y;
    return worldFromMap(directionFromLatLong(across, q, bounds.z != 0.0));
}

// A direction in world space and its density. u: two random words. Both are inverted, not drawn from an alias table: 64 Sobol' points then
// have .2 to .5 of the variance in light from a studio (tests/bench/EXPERIMENTS.md).
vec3 sampleEnvironmentMap(uvec2 u, out float pdf)
{
    uvec2 cells = render.environmentCells;
    uint firstRow = cells.x * cells.y;
    uvec4 rowEntry, cell;
    uint row = findEntry(firstRow, cells.y, u.x, 2u, rowEntry);
    uint column = findEntry(row * cells.x, cells.x, u.y, 1u, cell);
    pdf = uintBitsToFloat(cell.z);
    return directionInCell(row, column, vec2(placeInEntry(cell, u.y), placeInEntry(rowEntry, u.x)));
}

#endif
