// Chooses a light by what it may send to a point: finite lights by the light tree, infinite ones by power.
#ifndef GLIM_ACCESS_LIGHT_CHOICE
#define GLIM_ACCESS_LIGHT_CHOICE

#include "lib/hash.glsl"
#include "lib/light_importance.glsl"
#include "light_cluster.glsl"
#include "parameters.glsl"
#include "scene.glsl"

// The point that light arrives at: where lights are sampled, or the origin of a ray that has hit a light by chance.
struct LightContext {
    vec3 p;   // origin of shadow rays on ng's side: only by this offset is a point on a sphere light's wall inside the light
    vec3 ns;  // unit
    vec3 receiverNormal;  // ns as PathState has it, to the same bits in both cases; 0 at a surface that transmits, where both sides count
    uint sight;           // what a guide knows of lights there (shared/guide_types.h); 0: nothing
};

uint childCount(LightNode node)
{
    return (node.children & ~(kTwoSidedNode | kClusterNode)) >> kLightChildBits;
}

// Levels of the tree that one random word is enough for: 24 bits, of which a choice among eight takes three.
const uint kLevelsPerWord = 4u;

// Walks down the tree to a light by random bits; or to `light`, if it is one.
LightChoice walkLightTree(LightContext context, uint bits, uint light)
{
    LightNode node = fetchLightNode(0u);
    float u = unitFloat(bits), probability = 1.0;
    bool draws = light == kNoLightIndex;
    uint level = 0u, sibling = 0u, part = 0u;
    if (!isSmallCluster(node, context.p)) {
    do {
        uint first = node.children & ((1u << kLightChildBits) - 1u), count = childCount(node);
        float importances[kMaxLightChildren];
        float sum = 0.0, chosen = 0.0, before = 0.0;
        uint at = 0u, i = 0u;
        do {
            LightNode child = fetchLightNode(first + i);
            float importance = lightImportance(child, context.p, context.receiverNormal);
            importance *= kGuided && level == 0u ? computeSight(context.sight, i) : 1.0;
            importances[i] = importance;
            sum += importance;
            bool takes = !draws && child.firstLight <= light;
            at = takes ? i : at;
            chosen = takes ? importance : chosen;
        } while (++i < count);
        bool dark = !(sum > 0.0);  // none has any importance: all are alike
        sum = dark ? float(count) : sum;
        chosen = dark ? 1.0 : chosen;
        float below = 0.0, target = u * sum;
        i = 0u;
        do {
            float importance = dark ? 1.0 : importances[i];
            bool takes = draws && importance > 0.0 && target >= below;
            at = takes ? i : at;
            chosen = takes ? importance : chosen;
            before = takes ? below : before;
            below += importance;
        } while (++i < count);
        u = min((target - before) / chosen, 0.99999994);
        probability *= chosen / sum;
        sibling = at + 1u < count ? first + at + 1u : sibling;
        node = fetchLightNode(first + at);
        part = level == 0u ? at : part;
        ++level;
        if (level % kLevelsPerWord == 0u) {
            u = unitFloat(hash4(uvec4(bits, level, 0u, 0u)).x);
        }
    } while (childCount(node) > 0u && !isSmallCluster(node, context.p));
    }
    LightChoice choice = LightChoice(node.firstLight, probability, part);
    if (hasFeature(kFeatureLightClusters) && childCount(node) > 0u) {
        uint end = sibling > 0u ? fetchLightNode(sibling).firstLight : render.finiteLights;
        LightCluster cluster = LightCluster(node.firstLight, end, context.p - node.center);
        choice = chooseInCluster(cluster, u, light);
        choice.probability *= probability;
        choice.part = part;
    }
    return choice;
}

// Probability of choosing among the finite lights: their importance against that of the infinite ones. Neither has less than .1 where there
// are both: something may be in the way of the other.
float finiteShareAt(LightContext context)
{
    float share = hasFeature(kFiniteLights) && render.finiteLights > 0u ? 1.0 : 0.0;
    if (hasFeature(kFeatureLightTree) && hasFeature(kInfiniteLights) && render.infiniteImportance > 0.0 && share > 0.0) {
        float importance = lightImportance(fetchLightNode(0u), context.p, context.receiverNormal);
        float infinite = render.infiniteImportance;
        if (kGuided) {
            importance *= computeSight(context.sight, kSightOfFinite);
            infinite *= computeSight(context.sight, kSightOfInfinite);
        }
        share = 0.1 + 0.8 * importance / (importance + infinite);
    }
    return share;
}

// The probability of a finite light that has the share `byImportance` of all finite lights' importance.
float mixedProbability(float finiteShare, float byImportance)
{
    return finiteShare * (kUniformShare / float(render.finiteLights) + (1.0 - kUniformShare) * byImportance);
}

// The first infinite light for which u in [0, 1) is below the sum of probabilities.
LightChoice chooseInfiniteLight(float u)
{
    LightChoice choice = LightChoice(render.finiteLights - 1u, 0.0, kSightOfInfinite);
    float sum = 0.0;
    bool more;
    do {
        ++choice.light;
        choice.probability = fetchLight(choice.light).probability;
        sum += choice.probability;
        more = u >= sum && choice.light + 1u < render.lightCount;
    } while (more);
    return choice;
}

// Of sampling a light at all. Paths that learn always do, or no guide would know of a light again that one has called dark.
float sampleShareAt(LightContext context)
{
    return kGuided && !kLearns ? lightSampleShare(context.sight) : 1.0;
}

// Two random words.
LightChoice chooseLight(LightContext context, uvec2 bits)
{
    float sampleShare = sampleShareAt(context);
    float u = unitFloat(bits.y) / sampleShare, finiteShare = finiteShareAt(context);
    LightChoice choice = LightChoice(0u, 1.0, 0u);
    bool finite = !hasFeature(kInfiniteLights) || (hasFeature(kFiniteLights) && u < finiteShare);
    if (finite) {
        choice.probability = finiteShare;
        if (hasFeature(kFeatureLightTree)) {
            bool isUniform = u < kUniformShare * finiteShare;
            uint light = isUniform ? chooseBin(bits.x, render.finiteLights) : kNoLightIndex;
            choice = walkLightTree(context, bits.x, light);
            choice.probability = mixedProbability(finiteShare, choice.probability);
        }
    } else {
        choice = chooseInfiniteLight((u - finiteShare) / (1.0 - finiteShare));
        choice.probability *= 1.0 - finiteShare;
    }
    choice.probability *= u < 1.0 ? sampleShare : 0.0;
    return choice;
}

// The probability with which chooseLight chooses a light, to the same bits.
float computeLightProbability(LightContext context, uint light)
{
    float finiteShare = finiteShareAt(context), sampleShare = sampleShareAt(context);
    if (hasFeature(kInfiniteLights) && light >= render.finiteLights) {
        return fetchLight(light).probability * (1.0 - finiteShare) * sampleShare;
    }
    float share = hasFeature(kFeatureLightTree) ? mixedProbability(finiteShare, walkLightTree(context, 0u, light).probability) : finiteShare;
    return share * sampleShare;
}

#endif
