// Sums of 64 bits in two words, the lower one first.
#ifndef GLIM_LIB_ADD64
#define GLIM_LIB_ADD64

uvec2 add64(uvec2 a, uvec2 b)
{
    uint carry;
    uint low = uaddCarry(a.x, b.x, carry);
    return uvec2(low, a.y + b.y + carry);
}

#endif
