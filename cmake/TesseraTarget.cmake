# SPDX-License-Identifier: BSD-3-Clause
# One library per directory: tessera_library(NAME SOURCES ... LINK ... PRIVATE_LINK ...), alias tessera::NAME. Without
# SOURCES it is header-only.
# Each target sees only the directories that it links: headers are staged per directory as include/<directory>, so that
# an include which the links do not allow fails to compile.

add_library(tessera_warnings INTERFACE)
# -pthread: MPI's targets use it, and all targets that share precompiled headers must agree.
target_compile_options(tessera_warnings INTERFACE -Wall -Wextra -Werror -pthread)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ spends a tenth of its time on garbage collection of heaps beyond 128 MB.
  target_compile_options(tessera_warnings INTERFACE --param=ggc-min-heapsize=1500000)
endif()
if(TESSERA_SANITIZE)
  target_compile_options(tessera_warnings INTERFACE -fsanitize=${TESSERA_SANITIZE} -fno-sanitize-recover=all
                                                    -fno-omit-frame-pointer)
  target_link_options(tessera_warnings INTERFACE -fsanitize=${TESSERA_SANITIZE})
endif()
if(TESSERA_SANITIZE MATCHES address)
  # Checks of scopes of vectors in registers make compiling a kernel four times as slow.
  # g++ 12 with ASan has a false warning inside std::regex; the release build keeps the warning.
  target_compile_options(tessera_warnings INTERFACE -fno-sanitize-address-use-after-scope
                                                    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(TESSERA_QUICK AND TESSERA_SANITIZE)
  # Checks at every pointer take two fifths of the compile time, and ASan detects most of the same errors on use. The
  # parsers' fuzz targets have them.
  target_compile_options(tessera_warnings INTERFACE -fno-sanitize=null,alignment,vptr,object-size)
  # The sanitizers' descriptions need a million relocations at each start, a quarter of the time of a short command.
  target_link_options(tessera_warnings INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
endif()
# For code whose speed users do not notice, which compiles in two thirds of the time: tests, the command line, reports.
add_library(tessera_optimize_1 INTERFACE)
if(TESSERA_QUICK)
  # clang compiles tests in half the time with it, g++ in five sixths.
  target_compile_options(tessera_optimize_1 INTERFACE -O0)
else()
  target_compile_options(tessera_optimize_1 INTERFACE $<$<CONFIG:Release>:-O1>)
endif()
# For code around the kernels: readers, writers, frames, the reference.
add_library(tessera_optimize_2 INTERFACE)
target_compile_options(tessera_optimize_2 INTERFACE $<$<CONFIG:Release>:-O2>)
# For the tests' own code. Linked after tessera_warnings, whose options it overrides.
add_library(tessera_test_options INTERFACE)
if(TESSERA_QUICK)
  target_compile_definitions(tessera_test_options INTERFACE TESSERA_QUICK)
endif()
if(TESSERA_QUICK AND TESSERA_SANITIZE)
  target_compile_options(tessera_test_options INTERFACE -fno-sanitize=undefined)
endif()
if(TESSERA_SANITIZE MATCHES thread AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # oneTBB's headers contain fences, which TSan does not support; g++ warns at each.
  target_compile_options(tessera_warnings INTERFACE -Wno-tsan)
endif()

# The headers that most sources include, parsed once: tessera_precompiled for libraries, tessera_unoptimized_precompiled
# for those that quick builds do not optimize, tessera_test_precompiled for the tests' programs, which have another kind
# of position-independent code. Sources still include what they use; CMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows missing
# includes. A source with its own code generation option (-ffp-contract) skips them: g++ would silently use the headers'
# option, and clang refuses them.
set(tessera_common_headers
    <algorithm> <array> <atomic> <bit> <chrono> <cmath> <condition_variable> <cstddef> <cstdint> <cstring> <exception>
    <filesystem> <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <ranges> <span> <stop_token> <string>
    <string_view> <thread> <utility> <vector> <fmt/format.h> <glm/geometric.hpp> <glm/mat3x3.hpp> <glm/vec2.hpp>
    <glm/vec3.hpp>)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "")
function(tessera_precompiled target)
  add_library(${target} OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${target} PRIVATE tessera_warnings glm::glm fmt::fmt)
  target_precompile_headers(${target} PRIVATE ${tessera_common_headers} ${ARGN})
endfunction()

function(tessera_stage_headers target folder)
  set(stage ${PROJECT_BINARY_DIR}/include/${folder})
  file(MAKE_DIRECTORY ${stage})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${stage}/${folder} SYMBOLIC)
  target_include_directories(${target} ${ARGN} ${stage})
endfunction()

function(tessera_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  if(ARG_SOURCES)
    add_library(tessera_${name} STATIC ${ARG_SOURCES})
    tessera_stage_headers(tessera_${name} ${name} PUBLIC)
    target_link_libraries(tessera_${name} PUBLIC ${ARG_LINK} PRIVATE tessera_warnings fmt::fmt ${ARG_PRIVATE_LINK})
    set(precompiled tessera_precompiled)
    if(TESSERA_QUICK AND "tessera_optimize_1" IN_LIST ARG_PRIVATE_LINK)
      set(precompiled tessera_unoptimized_precompiled) # compilers reject headers precompiled at another level
    endif()
    target_precompile_headers(tessera_${name} REUSE_FROM ${precompiled})
  else() # headers only
    add_library(tessera_${name} INTERFACE)
    tessera_stage_headers(tessera_${name} ${name} INTERFACE)
    target_link_libraries(tessera_${name} INTERFACE ${ARG_LINK})
  endif()
  add_library(tessera::${name} ALIAS tessera_${name})
endfunction()

# tessera_shaders(NAME FILES ...): the GLSL files of a directory as strings in <NAME>/shader_files.hpp, each named after
# its file: merge_lists.comp is tessera::NAME::shader_files::merge_lists_comp.
function(tessera_shaders name)
  set(header "#pragma once\n\n#include \"gl/shader.hpp\"\n\nnamespace tessera::${name}::shader_files {\n")
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    file(READ ${file} text)
    get_filename_component(identifier ${file} NAME)
    string(REPLACE "." "_" identifier ${identifier})
    string(APPEND header "inline constexpr gl::ShaderSource ${identifier}{\"${name}/${file}\", R\"glsl(${text})glsl\"};\n")
  endforeach()
  string(APPEND header "}\n")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/${name}-shaders/${name}/shader_files.hpp CONTENT "${header}" @ONLY)
  target_include_directories(tessera_${name} PRIVATE ${PROJECT_BINARY_DIR}/include/${name}-shaders)
endfunction()

# tessera_test(NAME [SLOW] [PROCESSES PATTERN] SOURCES ... LINK ...): a GoogleTest program, registered test by test. Its
# sources use different names for helpers, or a namespace named after the file, because a unity build compiles several
# together. All but SLOW ones are labelled fast, and built by the target fast_tests. Tests that match the GoogleTest
# pattern PROCESSES start processes and get that label: `ctest -L processes --repeat until-fail:20` shows whether their
# outcome depends on timing.
function(tessera_test name)
  cmake_parse_arguments(ARG "SLOW" "PROCESSES" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE tessera_warnings tessera_optimize_1 tessera_test_options ${ARG_LINK}
                                        fmt::fmt GTest::gtest GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM tessera_test_precompiled)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE TESSERA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  get_property(helpers GLOBAL PROPERTY tessera_helper_programs)
  if(helpers)
    add_dependencies(${name} ${helpers})
  endif()
  if(TESSERA_SANITIZE MATCHES thread)
    target_link_libraries(${name} PRIVATE tsan_onetbb)
  endif()
  if(ARG_SLOW)
    set(label slow)
  else()
    set(label fast)
    add_dependencies(fast_tests ${name})
  endif()
  # Time limits only detect hangs.
  set(others "*")
  if(ARG_PROCESSES)
    set(others "-${ARG_PROCESSES}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_FILTER "${others}" PROPERTIES TIMEOUT 1200 LABELS ${label})
  if(ARG_PROCESSES)
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_FILTER "${ARG_PROCESSES}" TEST_LIST ${name}_processes
                         PROPERTIES TIMEOUT 1200)
    # gtest_discover_tests() does not accept a list of labels.
    set(labels ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
    file(WRITE ${labels} "if(${name}_processes)
  set_tests_properties(\${${name}_processes} PROPERTIES LABELS \"${label};processes\")
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels})
  endif()
endfunction()
