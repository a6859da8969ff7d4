# SPDX-License-Identifier: BSD-3-Clause
# The whole library, made of the objects that the directories' targets compile: libtessera.so, which exports the symbols
# marked TESSERA_EXPORT, and libtessera.a. In this build and installed: tessera::shared, tessera::static, and
# tessera::tessera, the shared one if both exist. tessera::mpi: additional dependencies of tessera/mpi.hpp.
set(folders scene system colormaps cells io integrals exchange projection gl sorting compositor volume reference frame api datasets annotation)
if(TESSERA_CAIRO)
  list(APPEND folders analysis)
endif()

# Dependencies of the objects: everything that the directories link except each other, and header-only targets.
set(objects)
set(links)
foreach(folder ${folders})
  get_target_property(type tessera_${folder} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    list(APPEND objects $<TARGET_OBJECTS:tessera_${folder}>)
    get_target_property(linked tessera_${folder} LINK_LIBRARIES)
    list(APPEND links ${linked})
  endif()
endforeach()
list(FILTER links EXCLUDE REGEX "^(\\$<LINK_ONLY:)?(tessera|glm::|nlohmann_json::)")
list(REMOVE_DUPLICATES links)

function(tessera_whole_library kind)
  string(TOUPPER ${kind} type)
  add_library(tessera_${kind} ${type} ${objects})
  add_library(tessera::${kind} ALIAS tessera_${kind})
  set_target_properties(tessera_${kind} PROPERTIES OUTPUT_NAME tessera EXPORT_NAME ${kind} LINKER_LANGUAGE CXX)
  target_compile_features(tessera_${kind} INTERFACE cxx_std_20)
  get_property(helpers GLOBAL PROPERTY tessera_helper_programs)
  if(helpers) # programs that the library starts
    add_dependencies(tessera_${kind} ${helpers})
  endif()
  target_include_directories(
    tessera_${kind} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                              $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include/generated>)
  target_link_libraries(tessera_${kind} PRIVATE $<BUILD_INTERFACE:tessera_warnings> ${links} INTERFACE glm::glm)
endfunction()

if(TESSERA_SHARED)
  tessera_whole_library(shared)
  # Instances of templates of the standard library and oneTBB are not exported either.
  set(exports ${CMAKE_CURRENT_LIST_DIR}/tessera.map)
  set_target_properties(
    tessera_shared
    PROPERTIES LINK_DEPENDS ${exports}
               VERSION ${PROJECT_VERSION}
               # Until 1.0 each minor version has its own interface.
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_link_options(tessera_shared PRIVATE -Wl,--version-script=${exports} -Wl,--as-needed)
endif()
if(TESSERA_STATIC)
  tessera_whole_library(static)
endif()

if(TESSERA_SHARED)
  add_library(tessera::tessera ALIAS tessera_shared)
elseif(TESSERA_STATIC)
  add_library(tessera::tessera ALIAS tessera_static)
endif()
if(TESSERA_MPI AND TARGET tessera::tessera)
  add_library(tessera_mpi INTERFACE)
  add_library(tessera::mpi ALIAS tessera_mpi)
  # Only MPI's C interface: its old C++ one requires another library.
  target_compile_definitions(tessera_mpi INTERFACE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
  target_link_libraries(tessera_mpi INTERFACE tessera::tessera MPI::MPI_C)
endif()
