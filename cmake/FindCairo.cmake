# SPDX-License-Identifier: BSD-3-Clause
# Cairo::cairo: the library, which programs link by its run-time name (Debian: libcairo2), and its headers
# (libcairo2-dev, or only those unpacked by scripts/install_packages.sh).
find_library(CAIRO_LIBRARY libcairo.so.2)
find_path(CAIRO_INCLUDE_DIR cairo.h PATH_SUFFIXES cairo HINTS ${TESSERA_UNPACKED_HEADERS})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cairo REQUIRED_VARS CAIRO_LIBRARY CAIRO_INCLUDE_DIR)
if(Cairo_FOUND AND NOT TARGET Cairo::cairo)
  add_library(Cairo::cairo INTERFACE IMPORTED)
  set_target_properties(Cairo::cairo PROPERTIES INTERFACE_LINK_LIBRARIES "-l:libcairo.so.2" INTERFACE_INCLUDE_DIRECTORIES
                                                                                           "${CAIRO_INCLUDE_DIR}")
endif()
mark_as_advanced(CAIRO_LIBRARY CAIRO_INCLUDE_DIR)
