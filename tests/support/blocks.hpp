// The blocks that samples are summed in.
#pragma once

#include "shaders/shared/limits.h"

#include <cstdint>

namespace glim::test {

// Of the block that the sample is in.
inline std::uint32_t blockEnd(std::uint32_t sample)
{
    const std::uint32_t size = blockSamples(sample);
    return (sample / size + 1) * size;
}

}  // namespace glim::test
