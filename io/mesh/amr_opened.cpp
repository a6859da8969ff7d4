// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/amr_opened.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/files/file_beginnings.hpp"
#include "io/files/inflated_file.hpp"
#include "io/text/text_file.hpp"
#include "io/text/xml_elements.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t most_blocks = 1u << 20;

std::shared_ptr<HelperProcess> helper_for(const InputFile& file) {
  HelperTask task;
  task.format = file.format;
  return std::make_shared<HelperProcess>(std::move(task));
}

void require_room(const OpenedAmr& amr, const std::filesystem::path& file) {
  if (amr.files.size() >= most_blocks)
    throw scene::bad_input(fmt::format("{}: it lists more than {} blocks; write fewer", file.string(), most_blocks));
}

}  // namespace

OpenedAmr open_amr_list(const InputFile& input) {
  const std::filesystem::path& file = input.path;
  OpenedAmr amr;
  const auto helper = helper_for(input);
  amr.format = "VTK XML AMR";
  bool is_list = false;
  each_xml_element(read_text_file(file), file.string(), [&](const XmlElement& element) {
    if (element.name == "vtkOverlappingAMR" || element.name == "vtkNonOverlappingAMR" ||
        element.name == "vtkHierarchicalBoxDataSet")
      is_list = true;
    const std::string* const listed = element.name == "DataSet" ? element.find("file") : nullptr;
    if (listed == nullptr || listed->empty()) return;
    const std::filesystem::path block = file.parent_path() / *listed;
    require_room(amr, file);
    ForeignFile opened = open_foreign(helper, block, {{"reader", "vtk_xml"}, {"type", "ImageData"}});
    for (ForeignPart& part : opened.contents.parts) part.name = listed->c_str();
    amr.add(std::move(opened));
  });
  if (!is_list)
    throw scene::bad_input(
        fmt::format("{}: it is not a list of AMR blocks, vtkOverlappingAMR or vtkNonOverlappingAMR; "
                    "check what it is",
                    file.string()));
  return amr;
}

OpenedAmr open_hyper_trees(const InputFile& input) {
  const std::filesystem::path& file = input.path;
  OpenedAmr amr;
  const auto helper = helper_for(input);
  if (vtk_xml_type(input.beginning) != "PHyperTreeGrid") {
    amr.add(open_foreign(helper, file, {{"reader", "hyper_trees"}}));
    return amr;
  }
  require_uncompressed(file);
  each_xml_element(read_text_file(file), file.string(), [&](const XmlElement& element) {
    if (element.name != "Piece") return;
    const std::string* const piece = element.find("Source");
    if (piece == nullptr || piece->empty())
      throw scene::bad_input(
          fmt::format("{}: piece {} has no Source; write the file again", file.string(), amr.files.size()));
    require_room(amr, file);
    ForeignFile opened = open_foreign(helper, file.parent_path() / *piece, {{"reader", "hyper_trees"}});
    for (ForeignPart& part : opened.contents.parts) part.name = piece->c_str();
    amr.add(std::move(opened));
  });
  amr.format = "VTK XML HyperTreeGrid in pieces";
  return amr;
}

}  // namespace tessera::io
