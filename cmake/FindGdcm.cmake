# SPDX-License-Identifier: BSD-3-Clause
# Gdcm::gdcm, the libraries that read files (Debian: libgdcm-dev). Its own CMake package requires every optional
# dependency.
find_path(GDCM_INCLUDE_DIR gdcmImageReader.h PATH_SUFFIXES gdcm-3.0 gdcm-3.1 gdcm)
find_library(GDCM_FILES_LIBRARY gdcmMSFF)
find_library(GDCM_ELEMENTS_LIBRARY gdcmDSED)
find_library(GDCM_COMMON_LIBRARY gdcmCommon)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gdcm REQUIRED_VARS GDCM_FILES_LIBRARY GDCM_ELEMENTS_LIBRARY GDCM_COMMON_LIBRARY
                                                     GDCM_INCLUDE_DIR)
if(Gdcm_FOUND AND NOT TARGET Gdcm::gdcm)
  add_library(Gdcm::gdcm INTERFACE IMPORTED)
  set_target_properties(
    Gdcm::gdcm
    PROPERTIES INTERFACE_LINK_LIBRARIES "${GDCM_FILES_LIBRARY};${GDCM_ELEMENTS_LIBRARY};${GDCM_COMMON_LIBRARY}"
               INTERFACE_INCLUDE_DIRECTORIES "${GDCM_INCLUDE_DIR}")
endif()
mark_as_advanced(GDCM_INCLUDE_DIR GDCM_FILES_LIBRARY GDCM_ELEMENTS_LIBRARY GDCM_COMMON_LIBRARY)
