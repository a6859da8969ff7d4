# Cairo::cairo, the library itself (Debian: libcairo2) and our declarations of what is called of it.
find_library(CAIRO_LIBRARY libcairo.so.2)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cairo REQUIRED_VARS CAIRO_LIBRARY)
if(Cairo_FOUND AND NOT TARGET Cairo::cairo)
  add_library(Cairo::cairo INTERFACE IMPORTED)
  set_target_properties(Cairo::cairo PROPERTIES INTERFACE_LINK_LIBRARIES "-l:libcairo.so.2" INTERFACE_INCLUDE_DIRECTORIES
                                                                                           "${CMAKE_CURRENT_LIST_DIR}/cairo")
endif()
mark_as_advanced(CAIRO_LIBRARY)
