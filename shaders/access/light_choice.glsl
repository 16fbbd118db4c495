// Chooses a light by what it may send to a point: finite lights by the light tree, infinite ones by power.
#ifndef GLIM_ACCESS_LIGHT_CHOICE
#define GLIM_ACCESS_LIGHT_CHOICE

#include "lib/hash.glsl"
#include "lib/light_importance.glsl"
#include "parameters.glsl"
#include "scene.glsl"

// The point that light arrives at: where lights are sampled, or the origin of a ray that has hit a light by chance.
struct LightContext {
    vec3 p;   // origin of shadow rays on ng's side: only by this offset is a point on a sphere light's wall inside the light
    vec3 ns;  // unit
    vec3 horizon;  // ns as PathState has it, to the same bits in both cases; 0 at a surface that transmits, which has no horizon
};

struct LightChoice {
    uint light;
    float probability;
};

float importanceOf(uint node, LightContext context)
{
    return lightImportance(fetchLightNode(node), context.p, context.horizon);
}

// Of at most kFewLights lights one in proportion to importance, by u in [0, 1); or, if `light` is one of them, that one. If none has any
// importance, all are alike.
LightChoice chooseOfFewLights(LightContext context, float u, uint light)
{
    float importances[kFewLights];
    float sum = 0.0;
    uint i = 0u;
    do {
        importances[i] = importanceOf(i, context);
        sum += importances[i];
    } while (++i < render.finiteLights);
    bool dark = !(sum > 0.0);
    sum = dark ? float(render.finiteLights) : sum;
    float below = 0.0, chosen = 0.0;
    uint at = 0u;
    i = 0u;
    do {
        float importance = dark ? 1.0 : importances[i];
        bool takes = light == kNoLightIndex ? importance > 0.0 && u * sum >= below : light == i;
        at = takes ? i : at;
        chosen = takes ? importance : chosen;
        below += importance;
    } while (++i < render.finiteLights);
    return LightChoice(at, chosen / sum);
}

// Share of the first of two nodes. Where neither has any importance, their powers count.
float shareOfFirst(LightNode first, LightNode second, LightContext context)
{
    float a = lightImportance(first, context.p, context.horizon), b = lightImportance(second, context.p, context.horizon);
    bool dark = !(a + b > 0.0);
    a = dark ? first.power : a;
    b = dark ? second.power : b;
    return a / (a + b);
}

// Levels of the tree that one random word is enough for: 24 bits, of which an even choice takes one.
const uint kLevelsPerWord = 8u;

// Walks down the tree to a light by random bits; or to `light`, if it is one.
LightChoice walkLightTree(LightContext context, uint bits, uint light)
{
    LightNode node = fetchLightNode(0u);
    float u = unitFloat(bits), probability = 1.0;
    uint level = 0u;
    do {
        uint child = node.child & ~kTwoSidedNode;
        LightNode first = fetchLightNode(child), second = fetchLightNode(child + 1u);
        float share = shareOfFirst(first, second, context);
        bool goesFirst = light == kNoLightIndex ? u < share : light < node.firstOfSecond;
        u = min(goesFirst ? u / share : (u - share) / (1.0 - share), 0.99999994);
        probability *= goesFirst ? share : 1.0 - share;
        node = goesFirst ? first : second;
        ++level;
        if (level % kLevelsPerWord == 0u) {
            u = unitFloat(hash4(uvec4(bits, level, 0u, 0u)).x);
        }
    } while ((node.child & ~kTwoSidedNode) != 0u);
    return LightChoice(node.firstOfSecond, probability);
}

LightChoice chooseByImportance(LightContext context, uint bits, uint light)
{
    bool few = hasFeature(kFeatureFewLights) && render.finiteLights <= kFewLights;
    LightChoice choice = LightChoice(0u, 1.0);
    if (few) {
        choice = chooseOfFewLights(context, unitFloat(bits), light);
    } else if (hasFeature(kFeatureLightTree)) {
        choice = walkLightTree(context, bits, light);
    }
    return choice;
}

// Probability of a finite light whose importance has the share `byImportance`.
float mixedProbability(float byImportance)
{
    return render.finiteShare * (kUniformShare / float(render.finiteLights) + (1.0 - kUniformShare) * byImportance);
}

// The first infinite light for which u is below the sum of probabilities; u in [finiteShare, 1).
LightChoice chooseInfiniteLight(float u)
{
    LightChoice choice = LightChoice(render.finiteLights - 1u, 0.0);
    float sum = render.finiteShare;
    bool more;
    do {
        ++choice.light;
        choice.probability = fetchLight(choice.light).probability;
        sum += choice.probability;
        more = u >= sum && choice.light + 1u < render.lightCount;
    } while (more);
    return choice;
}

// Two random words.
LightChoice chooseLight(LightContext context, uvec2 bits)
{
    float u = unitFloat(bits.y);
    LightChoice choice = LightChoice(0u, 1.0);
    if (hasFeature(kFiniteLights) && u < render.finiteShare) {
        choice.probability = render.finiteShare;
        if (choosesLights()) {
            bool uniform_ = u < kUniformShare * render.finiteShare;
            uint light = uniform_ ? chooseBin(bits.x, render.finiteLights) : kNoLightIndex;
            choice = chooseByImportance(context, bits.x, light);
            choice.probability = mixedProbability(choice.probability);
        }
    } else if (hasFeature(kInfiniteLights)) {
        choice = chooseInfiniteLight(u);
    }
    return choice;
}

// The probability with which chooseLight chooses a finite light, to the same bits.
float probabilityOfLight(LightContext context, uint light)
{
    return choosesLights() ? mixedProbability(chooseByImportance(context, 0u, light).probability) : render.finiteShare;
}

#endif
