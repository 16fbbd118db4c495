// Records of hits. Those of instances are the records of their mesh, to be placed in the scene (scene_types.h).
#ifndef GLIM_ACCESS_PLACED_RECORD
#define GLIM_ACCESS_PLACED_RECORD

#include "parameters.glsl"
#include "scene.glsl"

struct PlacedRecord {
    Record record;  // as the buffer has it, but with the primitive id of the hit
    uint triangle;  // index in the buffer of triangles; not of spheres
    uint instance;  // that places it, or kNoInstance
};

// The instance that has the record, by binary search.
uint findInstance(uint record)
{
    uint low = 0u, high = render.instanceCount;
    do {
        uint middle = (low + high) >> 1u;
        bool begins = texelFetch(sceneInstances, int(middle * kInstanceTexels)).w <= record;
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

// Of a hit; or of any record of the buffer, as long as that is not a shared mesh's.
PlacedRecord fetchPlacedRecord(uint record)
{
    if (hasFeature(kFeatureInstances) && record >= render.firstInstanceRecord) {
        uint index = findInstance(record);
        InstanceData instance = fetchInstance(index);
        Record mesh = fetchRecord(record - instance.firstRecord);
        uint triangle = primitiveOf(mesh);
        mesh.t0.w += instance.firstPrimitive;
        return PlacedRecord(mesh, triangle, index);
    }
    Record own = fetchRecord(record);
    return PlacedRecord(own, primitiveOf(own), kNoInstance);
}

// Vertex 0 and the sides to the other two. Sides are placed by themselves: far from the origin their ends round more.
struct PlacedTriangle {
    vec3 v0;
    vec3 e1, e2;
};

PlacedTriangle placedTriangle(PlacedRecord placed)
{
    vec3 v0 = floatsOf(placed.record.t0);
    PlacedTriangle triangle = PlacedTriangle(v0, floatsOf(placed.record.t1) - v0, floatsOf(placed.record.t2) - v0);
    if (hasFeature(kFeatureInstances) && placed.instance != kNoInstance) {
        InstanceData instance = fetchInstance(placed.instance);
        triangle = PlacedTriangle(placePoint(instance, v0), placeVector(instance, triangle.e1), placeVector(instance, triangle.e2));
    }
    return triangle;
}

#endif
