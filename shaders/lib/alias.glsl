// Drawing from an alias table (Walker 1977).
#ifndef GLIM_LIB_ALIAS
#define GLIM_LIB_ALIAS

// Uniform over [0, count): the upper word of bits * count. Unlike u * count with a 24-bit float, its bins differ by at most
// 2^-32 of the whole.
uint chooseBin(uint bits, uint count)
{
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

// The bin itself or its other, by an independent second number. A threshold of 2^32 - 1 always keeps: the host writes it
// only for bins whose `other` is the bin itself.
uint chooseAlias(uint bin, uint threshold, uint other, uint bits)
{
    return bits < threshold ? bin : other;
}

#endif
