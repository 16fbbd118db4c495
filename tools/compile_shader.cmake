# The only rule that makes SPIR-V: glslang, then NoContraction on every float operation, then spirv-val.
#
#   glim_embed_shaders(TARGET [UNMARKED] NAMESPACE name SOURCES a.comp b.comp ... INCLUDES folder ...)
#
# makes a static library with one `extern const EmbeddedShader` per file (host/gpu/embedded_shader.hpp), declared in
# the generated header `<name>.hpp` as glim::<name>::<file stem>. UNMARKED: without NoContraction, as the kernels of others are.
find_program(GLSLANG_VALIDATOR NAMES glslangValidator glslang REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

# In every folder, where the function is called.
set(GLIM_GLSL_OPTIONS --quiet -V --target-env vulkan1.2 CACHE INTERNAL "")

get_filename_component(root ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
add_executable(mark_floats ${root}/tools/mark_floats.cpp ${root}/host/spirv/builder.cpp ${root}/host/spirv/expand.cpp
    ${root}/host/spirv/mark.cpp ${root}/host/spirv/module.cpp)
target_include_directories(mark_floats PRIVATE ${root})
target_compile_features(mark_floats PRIVATE cxx_std_20)
target_link_libraries(mark_floats PRIVATE SPIRV-Tools)

function(glim_embed_shaders target)
    cmake_parse_arguments(ARG "UNMARKED" "NAMESPACE" "SOURCES;INCLUDES" ${ARGN})
    get_filename_component(root ${CMAKE_CURRENT_FUNCTION_LIST_DIR} DIRECTORY)
    set(includes "")
    foreach(folder IN LISTS ARG_INCLUDES)
        get_filename_component(folder ${folder} ABSOLUTE)
        list(APPEND includes -I${folder})
    endforeach()
    set(finish mark_floats)
    if(ARG_UNMARKED)
        set(finish ${CMAKE_COMMAND} -E copy)
    endif()
    set(directory ${CMAKE_CURRENT_BINARY_DIR}/${target})
    file(MAKE_DIRECTORY ${directory})
    set(header "#pragma once\n#include \"host/gpu/embedded_shader.hpp\"\nnamespace glim::${ARG_NAMESPACE} {\n")
    set(definitions "#include \"host/gpu/embedded_shader.hpp\"\n")
    set(compiled "")
    foreach(source IN LISTS ARG_SOURCES)
        get_filename_component(source ${source} ABSOLUTE)
        get_filename_component(stem ${source} NAME_WE)
        set(spirv ${directory}/${stem}.spv)
        # The depfile names the .plain file, and Ninja believes a depfile only if it names the first output.
        add_custom_command(
            OUTPUT ${spirv}.plain ${spirv}
            COMMAND ${GLSLANG_VALIDATOR} ${GLIM_GLSL_OPTIONS} ${includes} --depfile ${spirv}.d -o ${spirv}.plain ${source}
            COMMAND ${finish} ${spirv}.plain ${spirv}
            COMMAND ${SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${spirv}
            DEPFILE ${spirv}.d
            DEPENDS ${source} mark_floats
            COMMENT "Compiling ${stem}.comp" VERBATIM)
        string(CONFIGURE [[
asm(".section .rodata\n.balign 4\n@stem@_begin:\n.incbin \"@spirv@\"\n@stem@_end:\n.previous\n");
extern "C" const std::uint32_t @stem@_words[] asm("@stem@_begin");
extern "C" const std::uint32_t @stem@_wordsEnd[] asm("@stem@_end");
namespace glim::@ARG_NAMESPACE@ {
extern const EmbeddedShader @stem@;
const EmbeddedShader @stem@{"@stem@", @stem@_words, @stem@_wordsEnd};
}
]] definition @ONLY)
        string(APPEND definitions "${definition}")
        list(APPEND compiled ${spirv})
        string(APPEND header "extern const EmbeddedShader ${stem};\n")
    endforeach()
    file(CONFIGURE OUTPUT ${directory}/${ARG_NAMESPACE}.hpp CONTENT "${header}}\n" @ONLY)
    set(source ${directory}/${ARG_NAMESPACE}.cpp)  # one for all: the compiler takes longer to start than to compile it
    file(CONFIGURE OUTPUT ${source} CONTENT "${definitions}" @ONLY)
    set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${compiled}")
    add_library(${target} STATIC ${source})
    target_include_directories(${target} PUBLIC ${directory} ${root})
    target_compile_features(${target} PUBLIC cxx_std_20)
endfunction()
