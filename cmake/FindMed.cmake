# SPDX-License-Identifier: BSD-3-Clause
# Med::med, MED's library for C (Debian: libmedc-dev), which has no CMake package of its own, and HDF5's headers.
find_path(MED_INCLUDE_DIR med.h)
find_path(MED_HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/openmpi hdf5/mpich)
find_path(MED_MPI_INCLUDE_DIR mpi.h PATH_SUFFIXES ${CMAKE_LIBRARY_ARCHITECTURE}/openmpi ${CMAKE_LIBRARY_ARCHITECTURE}/mpi
          HINTS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openmpi/include)
find_library(MED_LIBRARY medC)
find_library(MED_HDF5_LIBRARY NAMES hdf5_openmpi hdf5_mpich)  # tests write files of old versions with it
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Med REQUIRED_VARS MED_LIBRARY MED_INCLUDE_DIR MED_HDF5_INCLUDE_DIR MED_MPI_INCLUDE_DIR)
if(Med_FOUND AND NOT TARGET Med::med)
  add_library(Med::med UNKNOWN IMPORTED)
  set_target_properties(Med::med PROPERTIES IMPORTED_LOCATION "${MED_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                            "${MED_INCLUDE_DIR};${MED_HDF5_INCLUDE_DIR};${MED_MPI_INCLUDE_DIR}")
endif()
mark_as_advanced(MED_INCLUDE_DIR MED_HDF5_INCLUDE_DIR MED_MPI_INCLUDE_DIR MED_LIBRARY MED_HDF5_LIBRARY)
