# SPDX-License-Identifier: BSD-3-Clause
# Minc::minc, MINC's library (Debian: libminc-dev), whose own CMake package requires the dependencies of its programs.
find_path(MINC_INCLUDE_DIR minc2.h)
find_library(MINC_LIBRARY minc2)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Minc REQUIRED_VARS MINC_LIBRARY MINC_INCLUDE_DIR)
if(Minc_FOUND AND NOT TARGET Minc::minc)
  add_library(Minc::minc UNKNOWN IMPORTED)
  set_target_properties(Minc::minc PROPERTIES IMPORTED_LOCATION "${MINC_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                                                                 "${MINC_INCLUDE_DIR}")
endif()
mark_as_advanced(MINC_INCLUDE_DIR MINC_LIBRARY)
