// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-vtk: reads files with VTK and the libraries that come with it, in a process of its own
// (readers/common/serve.hpp), for the Tessera library that started it (io/foreign/client/helper_process.hpp).
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"

namespace tessera::readers {
namespace {

constexpr Reader readers[] = {
    Reader{"vtk_xml", read_vtk_xml},
    Reader{"vtk_legacy", read_vtk_legacy},
    Reader{"plot3d", read_plot3d},
    Reader{"stl", read_stl},
    Reader{"vtk_surface", read_vtk_surface},
    Reader{"exodus", read_exodus},
    Reader{"openfoam", read_openfoam},
    Reader{"ensight", read_ensight},
    Reader{"cgns", read_cgns},
    Reader{"vtk_hdf", read_hdf5},
    Reader{"avs_ucd", read_avs_ucd},
    Reader{"fluent", read_fluent},
    Reader{"gambit", read_gambit},
    Reader{"hdf5", read_hdf5},
    Reader{"netcdf", read_netcdf},
    Reader{"minc", read_minc},
    Reader{"enzo", read_enzo},
    Reader{"hyper_trees", read_hyper_trees},
};

}  // namespace
}  // namespace tessera::readers

int main() { tessera::readers::serve(tessera::readers::readers); }
