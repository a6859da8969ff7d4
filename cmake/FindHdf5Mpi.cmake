# SPDX-License-Identifier: BSD-3-Clause
# Hdf5Mpi::hdf5, the build of HDF5 for MPI, and the headers of MPI, which its headers include (Debian:
# libhdf5-openmpi-dev). The libraries of MED and XDMF use this build.
find_path(HDF5MPI_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/openmpi hdf5/mpich)
find_path(HDF5MPI_MPI_INCLUDE_DIR mpi.h PATH_SUFFIXES ${CMAKE_LIBRARY_ARCHITECTURE}/openmpi ${CMAKE_LIBRARY_ARCHITECTURE}/mpi
          HINTS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openmpi/include)
find_library(HDF5MPI_LIBRARY NAMES hdf5_openmpi hdf5_mpich)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Hdf5Mpi REQUIRED_VARS HDF5MPI_LIBRARY HDF5MPI_INCLUDE_DIR HDF5MPI_MPI_INCLUDE_DIR)
if(Hdf5Mpi_FOUND AND NOT TARGET Hdf5Mpi::hdf5)
  add_library(Hdf5Mpi::hdf5 UNKNOWN IMPORTED)
  set_target_properties(Hdf5Mpi::hdf5 PROPERTIES IMPORTED_LOCATION "${HDF5MPI_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES
                                                 "${HDF5MPI_INCLUDE_DIR};${HDF5MPI_MPI_INCLUDE_DIR}")
endif()
mark_as_advanced(HDF5MPI_INCLUDE_DIR HDF5MPI_MPI_INCLUDE_DIR HDF5MPI_LIBRARY)
