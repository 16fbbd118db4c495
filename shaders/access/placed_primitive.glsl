// Primitive references of hits. Those of instances are the references of their mesh, to be placed in the scene (scene_types.h).
#ifndef GLIM_ACCESS_PLACED_RECORD
#define GLIM_ACCESS_PLACED_RECORD

#include "parameters.glsl"
#include "scene.glsl"

struct PlacedPrimitive {
    PrimitiveRef ref;  // as the buffer has it, but with the primitive id of the hit
    uint triangle;  // index in the buffer of triangles; not of spheres
    uint instance;  // that places it, or kNoInstance
};

// The instance that has the reference, by binary search.
uint findInstance(uint ref)
{
    uint low = 0u, high = render.instanceCount;
    do {
        uint middle = (low + high) >> 1u;
        bool begins = texelFetch(sceneInstances, int(middle * kInstanceTexels)).w <= ref;
        low = begins ? middle : low;
        high = begins ? high : middle;
    } while (high - low > 1u);
    return low;
}

vec3 placePoint(InstanceData instance, vec3 p)
{
    return instance.column0 * p.x + instance.column1 * p.y + instance.column2 * p.z + instance.translation;
}

vec3 placeVector(InstanceData instance, vec3 v)
{
    return instance.column0 * v.x + instance.column1 * v.y + instance.column2 * v.z;
}

// Places a normal by the inverse transpose, up to a positive factor: the cofactors with the determinant's sign.
vec3 placeNormal(InstanceData instance, vec3 n)
{
    vec3 placed = cross(instance.column1, instance.column2) * n.x + cross(instance.column2, instance.column0) * n.y +
                  cross(instance.column0, instance.column1) * n.z;
    return instance.mirrors != 0u ? -placed : placed;
}

// Of a hit; or of any reference of the buffer, as long as that is not a shared mesh's.
PlacedPrimitive fetchPlacedPrimitive(uint ref)
{
    if (hasFeature(kFeatureInstances) && ref >= render.firstInstanceRef) {
        uint index = findInstance(ref);
        InstanceData instance = fetchInstance(index);
        PrimitiveRef mesh = fetchPrimitiveRef(ref - instance.firstRef);
        uint triangle = getPrimitive(mesh);
        mesh.t0.w += instance.firstPrimitive;
        return PlacedPrimitive(mesh, triangle, index);
    }
    PrimitiveRef own = fetchPrimitiveRef(ref);
    return PlacedPrimitive(own, getPrimitive(own), kNoInstance);
}

// Vertex 0 and the sides to the other two. Sides are placed by themselves: far from the origin their ends round more.
struct PlacedTriangle {
    vec3 v0;
    vec3 e1, e2;
};

PlacedTriangle placedTriangle(PlacedPrimitive placed)
{
    vec3 v0 = toFloats(placed.ref.t0);
    PlacedTriangle triangle = PlacedTriangle(v0, toFloats(placed.ref.t1) - v0, toFloats(placed.ref.t2) - v0);
    if (hasFeature(kFeatureInstances) && placed.instance != kNoInstance) {
        InstanceData instance = fetchInstance(placed.instance);
        triangle = PlacedTriangle(placePoint(instance, v0), placeVector(instance, triangle.e1), placeVector(instance, triangle.e2));
    }
    return triangle;
}

#endif
