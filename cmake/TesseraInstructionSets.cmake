# SPDX-License-Identifier: BSD-3-Clause
# Sets the instruction sets for which Highway compiles kernels: TESSERA_INSTRUCTION_SETS. Quick sanitizer builds, and
# those with ThreadSanitizer, which check threads and not lanes, have only AVX2.
if((TESSERA_QUICK AND TESSERA_SANITIZE) OR TESSERA_SANITIZE MATCHES thread)
  set(sets AVX2)
elseif(TESSERA_INSTRUCTION_SETS STREQUAL native)
  find_package(hwy REQUIRED)
  try_run(status is_compiled SOURCES ${CMAKE_CURRENT_LIST_DIR}/best_instruction_set.cpp LINK_LIBRARIES hwy::hwy
          RUN_OUTPUT_VARIABLE sets)
  if(NOT is_compiled OR NOT status EQUAL 0)
    message(FATAL_ERROR "The instruction set of this machine is not found: leave TESSERA_INSTRUCTION_SETS=native out")
  endif()
else()
  set(sets ${TESSERA_INSTRUCTION_SETS})
endif()
set(disabled HWY_SSSE3 HWY_SSE4 HWY_AVX2 HWY_AVX3)
list(TRANSFORM sets PREPEND HWY_ OUTPUT_VARIABLE enabled)
list(REMOVE_ITEM disabled ${enabled})
list(JOIN disabled "|" disabled)
add_compile_definitions(HWY_DISABLED_TARGETS=\(${disabled}\))
