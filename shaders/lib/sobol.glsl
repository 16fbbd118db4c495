// Owen-scrambled Sobol' points in two dimensions. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.
#ifndef GLIM_LIB_SOBOL
#define GLIM_LIB_SOBOL

// Laine-Karras permutation with Vegdahl's constants ("Building a Better LK Hash", 2021): each bit is flipped by a hash of
// the bits below it.
uint permuteLaineKarras(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Owen's nested uniform scramble of the digits of x * 2^-32.
uint scrambleOwen(uint x, uint seed)
{
    return bitfieldReverse(permuteLaineKarras(bitfieldReverse(x), seed));
}

// Point `index` of the first two Sobol' dimensions, as 32-bit fractions: the van der Corput sequence and the one whose
// generator matrix is Pascal's triangle modulo 2. That matrix is the fifth Kronecker power of [1 1; 0 1], hence five steps.
uvec2 sobolPoint(uint index)
{
    uint y = index;
    y ^= (y >> 1u) & 0x55555555u;
    y ^= (y >> 2u) & 0x33333333u;
    y ^= (y >> 4u) & 0x0f0f0f0fu;
    y ^= (y >> 8u) & 0x00ff00ffu;
    y ^= (y >> 16u) & 0x0000ffffu;
    return uvec2(bitfieldReverse(index), bitfieldReverse(y));
}

// Point `index` of the sequence with the order and both coordinates scrambled; any aligned run of 2^m indices is a
// (0, m, 2)-net.
uvec2 scrambledSobolPoint(uint index, uvec3 seeds)
{
    uvec2 point = sobolPoint(scrambleOwen(index, seeds.x));
    return uvec2(scrambleOwen(point.x, seeds.y), scrambleOwen(point.y, seeds.z));
}

#endif
