# What the harness needs of glim, and nothing else: a copy of these files and of this folder is enough. Of these folders and files alone
# tests/host/includes_test.cpp lets it include, and tests/tools/harness_test.py builds such a copy.
set(KERNEL_HARNESS_SOURCES
    host/atomic_file.cpp host/digest.cpp host/json.cpp host/memory.cpp host/message.cpp host/measure/confidence.cpp
    host/gpu/arithmetic.cpp host/gpu/buffer.cpp host/gpu/cache_file.cpp host/gpu/commands.cpp host/gpu/device.cpp host/gpu/device_class.cpp
    host/gpu/instance.cpp host/gpu/kernel.cpp host/gpu/pipeline_cache.cpp host/gpu/replaced_kernels.cpp host/gpu/reused.cpp
    host/gpu/specialize.cpp host/gpu/storage_image.cpp
    host/spirv/adverse.cpp host/spirv/builder.cpp host/spirv/exact.cpp host/spirv/expand.cpp host/spirv/import.cpp host/spirv/mark.cpp
    host/spirv/module.cpp)
set(KERNEL_HARNESS_HEADERS
    host/atomic_file.hpp host/digest.hpp host/error.hpp host/fingerprint.hpp host/json.hpp host/memory.hpp host/message.hpp
    host/message_id.hpp host/text.hpp host/measure/confidence.hpp
    host/gpu/arithmetic.hpp host/gpu/buffer.hpp host/gpu/cache_file.hpp host/gpu/commands.hpp host/gpu/device.hpp host/gpu/device_class.hpp
    host/gpu/embedded_shader.hpp host/gpu/instance.hpp host/gpu/kernel.hpp host/gpu/owned.hpp host/gpu/pipeline_cache.hpp
    host/gpu/replaced_kernels.hpp host/gpu/reused.hpp host/gpu/specialize.hpp host/gpu/storage_image.hpp
    host/spirv/adverse.hpp host/spirv/builder.hpp host/spirv/exact.hpp host/spirv/expand.hpp host/spirv/import.hpp host/spirv/mark.hpp
    host/spirv/module.hpp)
set(KERNEL_HARNESS_SHADERS
    shaders/kernels/adverse_arithmetic.comp shaders/kernels/exact_arithmetic.comp shaders/lib/adverse.glsl shaders/lib/canary.glsl
    shaders/lib/exact.glsl shaders/shared/vocabulary.h)
set(KERNEL_HARNESS_RULES
    tools/compile_shader.cmake tools/mark_floats.cpp tools/specializer.cmake tools/write_digest.cmake)
