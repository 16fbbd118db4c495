# What makes kernels' SPIR-V: what is kept on disk of another one is not used.
#
#   glim_add_specializer(TARGET)
#
# makes specializer.h, of which host/gpu/specialize.cpp knows it, for a library that has that file.
function(glim_add_specializer target)
    get_filename_component(root ${CMAKE_CURRENT_FUNCTION_LIST_DIR} DIRECTORY)
    file(GLOB sources CONFIGURE_DEPENDS ${root}/host/spirv/*.?pp ${root}/host/gpu/specialize.?pp ${root}/host/gpu/arithmetic.?pp)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/generated/specializer.h)
    add_custom_command(
        OUTPUT ${header}
        COMMAND ${CMAKE_COMMAND} -DNAME=GLIM_SPECIALIZER "-DSOURCES=${sources}" -DOUTPUT=${header} -P ${root}/tools/write_digest.cmake
        DEPENDS ${sources} ${root}/tools/write_digest.cmake
        VERBATIM)
    target_sources(${target} PRIVATE ${header})
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
endfunction()
