# SPDX-License-Identifier: Apache-2.0
# One static library a floor; the libraries behind each door; the warnings that are errors.

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(embree 3 REQUIRED)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-0.1)
pkg_check_modules(TINYGLTF REQUIRED IMPORTED_TARGET tinygltf)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)

set(tsuya_warnings -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wvla -Wundef -Werror)
set(tsuya_c_warnings -Wstrict-prototypes -Wmissing-prototypes)

function(tsuya_compile_options target)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include)
    target_compile_definitions(${target} PRIVATE _GNU_SOURCE TSUYA_VERSION="${PROJECT_VERSION}")
    target_compile_options(${target} PRIVATE ${tsuya_warnings} $<$<COMPILE_LANGUAGE:C>:${tsuya_c_warnings}>
                                             -ffp-contract=off -fno-math-errno -fvisibility=hidden)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
        # No FMA but where it is asked for by name: the same bits on every machine.
        target_compile_options(${target} PRIVATE -march=${TSUYA_ARCH} -mno-fma)
    endif()
    if(TSUYA_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${TSUYA_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
        target_link_options(${target} PRIVATE -fsanitize=${TSUYA_SANITIZE})
    endif()
endfunction()

# Sources that call fused operations by name (base/simd.h, fmaf): as instructions, where the build's machines have them.
# Nothing else fuses: -ffp-contract stays off. The answer is kept by the target, which may be set anew.
include(CheckCSourceCompiles)
string(MAKE_C_IDENTIFIER "tsuya_has_fma_${TSUYA_ARCH}" tsuya_has_fma)
set(CMAKE_REQUIRED_FLAGS "-march=${TSUYA_ARCH}")
check_c_source_compiles("#ifndef __FMA__
#error
#endif
int main(void) { return 0; }" ${tsuya_has_fma})
unset(CMAKE_REQUIRED_FLAGS)
function(tsuya_use_fma)
    if(${tsuya_has_fma})
        set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "-mfma")
    endif()
endfunction()

# tsuya_floor(name DEPENDS floors... LIBRARIES targets...): library tsuya_<name> of every source below <name>/.
function(tsuya_floor name)
    cmake_parse_arguments(floor "" "" "DEPENDS;LIBRARIES" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${name}/*.c ${name}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/image/oiio/") # a module
    if(NOT sources)
        add_library(tsuya_${name} INTERFACE)
        return()
    endif()
    add_library(tsuya_${name} STATIC ${sources})
    tsuya_compile_options(tsuya_${name})
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
        # Kernels built a second time; who calls them asks the CPU first.
        set(wide ${sources})
        list(FILTER wide INCLUDE REGEX "_avx512\\.c$")
        set_source_files_properties(${wide} PROPERTIES COMPILE_OPTIONS
            "-mavx512f;-mavx512dq;-mavx512bw;-mavx512vl;-mavx512cd;-mfma")
        set(base ${sources})
        list(FILTER base INCLUDE REGEX "_base\\.c$")
        tsuya_use_fma(${base})
    endif()
    target_link_libraries(tsuya_${name} PRIVATE ${floor_LIBRARIES})
    foreach(dependency ${floor_DEPENDS})
        target_link_libraries(tsuya_${name} PUBLIC tsuya_${dependency})
    endforeach()
endfunction()

# What is loaded on demand, beside the programs: tsuya_module(name sources... LIBRARIES targets...).
function(tsuya_module name)
    cmake_parse_arguments(module "" "" "LIBRARIES" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${module_UNPARSED_ARGUMENTS})
    add_library(tsuya_${name} MODULE ${sources})
    tsuya_compile_options(tsuya_${name})
    target_include_directories(tsuya_${name} PRIVATE image)
    target_link_libraries(tsuya_${name} PRIVATE ${module_LIBRARIES})
endfunction()

# Text files as strings of the program: tsuya_embed(name files...) sets <name>_source to a source that defines
# `const char ty_<name>_<extension>[]` for each.
function(tsuya_embed name)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}_text.c)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE inputs)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DNAME=${name} "-DINPUTS=${inputs}" -DOUTPUT=${output} -P
                ${PROJECT_SOURCE_DIR}/cmake/tsuya_embed.cmake
        DEPENDS ${inputs} ${PROJECT_SOURCE_DIR}/cmake/tsuya_embed.cmake
        VERBATIM)
    set(${name}_source ${output} PARENT_SCOPE)
endfunction()
