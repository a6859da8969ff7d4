#include <gtest/gtest.h>

#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/volume_reader.hpp"

namespace tessera::io {
namespace {

TEST(WithoutVtk, WhatNeedsItIsRefusedByNameWithTheOptionThatBringsIt) {
  const test::TemporaryFolder folder;
  for (const char* name : {"m.vtu", "m.PVTU", "m.vts", "m.vtr", "m.vtk", "m.ex2", "m.e", "m.xyz", "m.stl"})
    test::expect_bad_input([&] { read_mesh(folder.write(name, "<VTKFile type=\"UnstructuredGrid\">")); },
                           {std::string(name) + ": ", " files need VTK", "TESSERA_VTK=ON"});
  test::expect_bad_input([&] { open_volume(folder.write("v.vti", "<VTKFile type=\"ImageData\">")); },
                         {"v.vti: VTK XML image data files need VTK", "TESSERA_VTK=ON"});
}

}  // namespace
}  // namespace tessera::io
