#include <memory>
#include <nlohmann/json.hpp>

#include "io/foreign_file.hpp"
#include "io/mesh_formats.hpp"

namespace tessera::io {

bool has_gmsh() { return true; }

MeshBlocks read_by_gmsh(const std::filesystem::path& file, const char* reader, std::optional<std::size_t> time_step,
                        const BlockChoice& choice) {
  nlohmann::json request{{"reader", reader}, {"blocks", choice}};
  if (time_step) request["time_step"] = *time_step;
  HelperTask task;
  task.program = "tessera-read-gmsh";
  const ForeignFile opened = open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request));
  MeshBlocks result;
  result.format = opened.contents.format;
  result.notes = opened.contents.notes;
  result.block_names = opened.contents.block_names;
  result.blocks = blocks_of(opened, result.notes);
  return result;
}

}  // namespace tessera::io
