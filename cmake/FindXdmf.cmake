# SPDX-License-Identifier: BSD-3-Clause
# Xdmf::xdmf, XDMF's own library, and the dependencies of its headers (Debian: libxdmf-dev, libxml2-dev, libboost-dev).
# Its own CMake package names files that Debian puts elsewhere: there the library is in a directory of its HDF5 build.
find_path(XDMF_INCLUDE_DIR XdmfReader.hpp)
find_path(XDMF_BOOST_INCLUDE_DIR boost/shared_ptr.hpp)
find_path(XDMF_LIBXML_INCLUDE_DIR libxml/xmlexports.h PATH_SUFFIXES libxml2)
find_library(XDMF_LIBXML_LIBRARY xml2)
find_library(XDMF_LIBRARY Xdmf PATH_SUFFIXES xdmf/openmpi)
find_library(XDMF_CORE_LIBRARY XdmfCore PATH_SUFFIXES xdmf/openmpi)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Xdmf REQUIRED_VARS XDMF_LIBRARY XDMF_CORE_LIBRARY XDMF_INCLUDE_DIR
                                                     XDMF_BOOST_INCLUDE_DIR XDMF_LIBXML_INCLUDE_DIR XDMF_LIBXML_LIBRARY)
if(Xdmf_FOUND AND NOT TARGET Xdmf::xdmf)
  add_library(Xdmf::xdmf INTERFACE IMPORTED)
  set_target_properties(
    Xdmf::xdmf PROPERTIES INTERFACE_LINK_LIBRARIES "${XDMF_LIBRARY};${XDMF_CORE_LIBRARY};${XDMF_LIBXML_LIBRARY}"
                          INTERFACE_INCLUDE_DIRECTORIES "${XDMF_INCLUDE_DIR};${XDMF_BOOST_INCLUDE_DIR};${XDMF_LIBXML_INCLUDE_DIR}")
endif()
mark_as_advanced(XDMF_INCLUDE_DIR XDMF_BOOST_INCLUDE_DIR XDMF_LIBXML_INCLUDE_DIR XDMF_LIBXML_LIBRARY XDMF_LIBRARY XDMF_CORE_LIBRARY)
