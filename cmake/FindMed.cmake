# SPDX-License-Identifier: BSD-3-Clause
# Med::med, MED's library for C (Debian: libmedc-dev), which has no CMake package of its own.
find_path(MED_INCLUDE_DIR med.h)
find_library(MED_LIBRARY medC)
find_package(Hdf5Mpi QUIET)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Med REQUIRED_VARS MED_LIBRARY MED_INCLUDE_DIR Hdf5Mpi_FOUND)
if(Med_FOUND AND NOT TARGET Med::med)
  add_library(Med::med UNKNOWN IMPORTED)
  set_target_properties(Med::med PROPERTIES IMPORTED_LOCATION "${MED_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                            "${MED_INCLUDE_DIR}" INTERFACE_LINK_LIBRARIES Hdf5Mpi::hdf5)
endif()
mark_as_advanced(MED_INCLUDE_DIR MED_LIBRARY)
