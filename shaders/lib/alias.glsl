// Drawing from an alias table (Walker 1977).
#ifndef GLIM_LIB_ALIAS
#define GLIM_LIB_ALIAS

// Uniform over [0, count): the upper word of bits * count. Probabilities of two values differ by at most 2^-32. With u * count from a
// 24-bit float they would differ by more.
uint chooseBin(uint bits, uint count)
{
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

// Returns the bin or its alias `other`, by an independent second number. A threshold of 2^32 - 1 always returns the bin: the host writes it
// only where `other` is the bin itself.
uint chooseAlias(uint bin, uint threshold, uint other, uint bits)
{
    return bits < threshold ? bin : other;
}

#endif
