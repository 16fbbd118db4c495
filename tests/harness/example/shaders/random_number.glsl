// Random numbers by PCG-RXS-M-XS of 32 bits (O'Neill 2014).
uint randomBits(inout uint state)
{
    state = state * 747796405u + 2891336453u;
    uint word = (state >> ((state >> 28u) + 4u) ^ state) * 277803737u;
    return word >> 22u ^ word;
}

// In [0, 1): a multiple of 2^-24.
float randomNumber(inout uint state)
{
    return float(randomBits(state) >> 8u) * 5.9604644775390625e-8;
}
