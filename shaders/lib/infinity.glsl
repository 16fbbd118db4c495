#ifndef GLIM_LIB_INFINITY
#define GLIM_LIB_INFINITY

// GLSL has no literal for it, and uintBitsToFloat is not a constant expression.
#define kInfinity uintBitsToFloat(0x7f800000u)

#endif
