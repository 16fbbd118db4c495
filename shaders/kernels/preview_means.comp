// One thread is one pixel of the rectangle, or several where the device has too few threads. Of a film with more pixels than the rectangle
// it draws the mean of those that lie under the pixel and have samples; of depths, whose means are nothing, the one in the middle. If there
// are none, the earlier drawing stays. What two tiles share is drawn with the one that has its middle, by that one's pixels.
// Reads the film. Updates the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/display.glsl"
#include "lib/display.glsl"

// Pixels of the film, without the last column and row.
struct Box {
    uvec2 begin, end;
};

Box boxUnder(uvec2 at)
{
    uvec2 size = uvec2(pass.width, pass.height), film = uvec2(pass.filmWidth, pass.filmHeight);
    uvec2 begin = at * film / size;
    Box box = Box(begin, max(begin + 1u, (at + 1u) * film / size));
    uvec2 middle = (box.begin + box.end) / 2u;
    return kAov == kAovDepth ? Box(middle, middle + 1u) : box;
}

bool isOfTile(uvec2 film)
{
    return film.y * pass.filmWidth + film.x - pass.tileBegin < pass.tileCount;
}

void drawPixel(uvec2 at)
{
    Box box = boxUnder(at);
    if (!isOfTile((box.begin + box.end) / 2u)) {
        return;
    }
    PixelMoments sum = PixelMoments(0u, 0u, vec3(0.0), vec3(0.0), 0.0, vec3(0.0), vec3(0.0), 0.0, 0.0);
    float known = 0.0;
    for (uint y = box.begin.y; y < box.end.y; ++y) {
        for (uint x = box.begin.x; x < box.end.x; ++x) {
            if (!isOfTile(uvec2(x, y))) {
                continue;
            }
            PixelMoments pixel = computeShownMoments(y * pass.filmWidth + x - pass.tileBegin);
            if (pixel.count > 0u) {
                known += 1.0;
                sum.count += pixel.count;
                sum.mean += pixel.mean;
                sum.alpha += pixel.alpha;
                sum.albedo += pixel.albedo;
                sum.normal += pixel.normal;
                sum.depth += pixel.depth;
            }
        }
    }
    if (known == 0.0) {
        return;
    }
    float share = 1.0 / known;
    PixelMoments mean = PixelMoments(uint(round(float(sum.count) * share)), 0u, sum.mean * share, vec3(0.0), sum.alpha * share,
                                     sum.albedo * share, sum.normal * share, sum.depth, 0.0);
    uvec2 place = uvec2(pass.left, pass.top) + at;
    imageStore(picture, ivec2(place), vec4(overCheckers(drawnColor(mean, kAov, pass), place), 1.0));
}

void main()
{
    uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint pixel = gl_GlobalInvocationID.x; pixel < pass.width * pass.height; pixel += threads) {
        drawPixel(uvec2(pixel % pass.width, pixel / pass.width));
    }
}
