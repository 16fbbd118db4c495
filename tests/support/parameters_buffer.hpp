// The parameters of a render, for tests that dispatch its kernels themselves.
#pragma once

#include "host/gpu/buffer.hpp"
#include "shaders/shared/course_types.h"
#include "tests/harness/test_device.hpp"

namespace glim {

template <class Parameters>
Buffer parametersBuffer(const Parameters& parameters)
{
    Buffer buffer(testDevice(), "test's parameters", BufferKind::Storage, sizeof(Parameters));
    upload(buffer, std::span<const Parameters>(&parameters, 1));
    return buffer;
}

// The loop canary's number of steps is there.
inline RenderParameters anyParameters()
{
    RenderParameters parameters{};
    parameters.canarySteps = 3;
    return parameters;
}

}  // namespace glim
