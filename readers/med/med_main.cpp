// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-med: reads MED by its own library, as tessera-read-vtk does for other formats. A separate program,
// because that library uses another build of HDF5, for MPI, than VTK's.
#include <nlohmann/json.hpp>

#include "io/files/inflated_file.hpp"
#include "readers/common/hdf5_references.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/med/med_file.hpp"

namespace tessera::readers {
namespace {

io::ForeignContents read_med(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  io::require_real_name(file);
  allow_for(file);
  require_sound_references(file, ReferencesMay::point_below);
  const MedFile opened(file);
  std::optional<std::size_t> time_step;
  if (const auto step = request.find("time_step"); step != request.end()) time_step = step->get<std::size_t>();
  io::ForeignContents contents;
  contents.format = "MED";
  std::vector<MedMesh> meshes = med_meshes(opened, contents.notes);
  add_med_fields(opened, time_step, meshes, contents.notes, contents.time_step);
  for (MedMesh& mesh : meshes) contents.parts.push_back(hold_block(holdings, std::move(mesh.block)));
  return contents;
}

}  // namespace
}  // namespace tessera::readers

int main() {
  using namespace tessera::readers;
  constexpr Reader readers[] = {{"med", read_med}};
  serve(readers);
}
