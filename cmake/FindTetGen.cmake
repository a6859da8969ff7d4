# SPDX-License-Identifier: BSD-3-Clause
# TetGen::tet, TetGen's library (Debian: libtet1.5-dev), which has no CMake package of its own.
find_path(TETGEN_INCLUDE_DIR tetgen.h)
find_library(TETGEN_LIBRARY tet)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TetGen REQUIRED_VARS TETGEN_LIBRARY TETGEN_INCLUDE_DIR)
if(TetGen_FOUND AND NOT TARGET TetGen::tet)
  add_library(TetGen::tet UNKNOWN IMPORTED)
  set_target_properties(TetGen::tet PROPERTIES IMPORTED_LOCATION "${TETGEN_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                                                                     "${TETGEN_INCLUDE_DIR}")
endif()
mark_as_advanced(TETGEN_INCLUDE_DIR TETGEN_LIBRARY)
