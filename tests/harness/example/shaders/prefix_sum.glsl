// The sum of the values of a workgroup's threads up to and with this one (Hillis and Steele 1986). Each thread calls it.
shared uint sums[gl_WorkGroupSize.x];

uint prefixSum(uint value)
{
    uint own = gl_LocalInvocationID.x;
    sums[own] = value;
    barrier();
    for (uint step = 1u; step < gl_WorkGroupSize.x; step *= 2u) {
        uint before = own >= step ? sums[own - step] : 0u;
        barrier();
        sums[own] += before;
        barrier();
    }
    return sums[own];
}
