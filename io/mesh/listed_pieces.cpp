// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/listed_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>

#include "cells/block_choice.hpp"
#include "io/files/file_beginnings.hpp"
#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "io/foreign/client/foreign_file.hpp"
#include "io/text/text_file.hpp"
#include "io/text/xml_elements.hpp"
#include "io/vtk/vtk_xml_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

bool is_any_of(std::string_view type, std::span<const std::string_view> types) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

constexpr std::string_view in_pieces = "PUnstructuredGrid";
constexpr std::array<std::string_view, 3> lists = {"vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection",
                                                   "vtkPartitionedDataSet"};
constexpr std::array<std::string_view, 2> surfaces = {"PolyData", "PPolyData"};
constexpr std::array<std::string_view, 7> volumes = {"UnstructuredGrid", "StructuredGrid",   "PStructuredGrid",
                                                     "RectilinearGrid",  "PRectilinearGrid", "ImageData",
                                                     "PImageData"};

void require_listed(const ListedPiece& piece) {
  std::error_code unknown;
  if (!std::filesystem::exists(piece.file, unknown) && !unknown)
    throw scene::bad_input(
        fmt::format("{}: there is no such file, but {} lists it; put the file there", piece.file.string(), piece.list));
}

void add_pieces_of_whole(const std::filesystem::path& file, const std::string& block, PieceList& list) {
  const std::string source = file.string();
  std::size_t count = 0;
  each_xml_element(read_text_file(file), source, [&](const XmlElement& element) {
    if (element.name != "Piece") return;
    const std::string* const name = element.find("Source");
    if (name == nullptr || name->empty())
      throw scene::bad_input(fmt::format("{}: piece {} has no Source; write the file again", source, count));
    list.pieces.push_back({file.parent_path() / *name, source, block, ""});
    ++count;
  });
}

void add_block(ListedPiece listed, const cells::BlockChoice& choice, PieceList& list) {
  if (!cells::is_chosen(choice, listed.block)) {  // the file of the block is not inspected, so it may be a surface
    list.block_names.push_back(listed.block);
    return;
  }
  require_listed(listed);
  listed.type = vtk_xml_type(read_beginning(listed.file, 4096));
  const bool is_wanted = list.with_surfaces && listed.type == surfaces.front();
  if (is_any_of(listed.type, surfaces) && !is_wanted) {
    list.surface_names.push_back(std::move(listed.block));
    return;
  }
  list.block_names.push_back(listed.block);
  if (listed.type == in_pieces) return add_pieces_of_whole(listed.file, listed.block, list);
  if (!is_any_of(listed.type, volumes) && !is_wanted)
    throw scene::bad_input(fmt::format("{}: it is a block of {} and its type is '{}', not a mesh or grid; leave it out",
                                       listed.file.string(), listed.list, listed.type));
  list.pieces.push_back(std::move(listed));
}

void add_blocks(const std::filesystem::path& file, const cells::BlockChoice& choice, PieceList& list) {
  std::vector<std::string> path;  // stack of block names, from the outermost to the innermost
  std::size_t count = 0;
  each_xml_element(read_text_file(file), file.string(), [&](const XmlElement& element) {
    const std::string* const own = element.find("name");
    path.resize(element.parents.size());
    path.push_back(own != nullptr ? *own : "");
    if (element.name != "DataSet") return;
    const std::string* const listed = element.find("file");
    if (listed == nullptr || listed->empty()) return;  // an empty block, which a rank may write
    std::string name;
    for (const std::string& word : path)
      if (!word.empty()) name += (name.empty() ? "" : "/") + word;
    if (name.empty()) name = std::to_string(count);
    ++count;
    add_block({file.parent_path() / *listed, file.string(), std::move(name), ""}, choice, list);
  });
  if (!list.surface_names.empty()) list.notes.push_back(cells::note_on_surfaces("block", list.surface_names));
}

void require_piece(const ListedPiece& piece) {
  const std::string source = piece.file.string(), beginning = read_beginning(piece.file, 4096);
  const std::string type = vtk_xml_type(beginning);
  if (type.empty()) {
    require_no_utf16(beginning, source);
    throw scene::bad_input(fmt::format(
        "{}: it is a piece of {}, but does not begin like a VTK XML file; write the file again", source, piece.list));
  }
  if (type != "UnstructuredGrid")
    throw scene::bad_input(
        fmt::format("{}: it is a piece of {}, but its type is '{}', not 'UnstructuredGrid'; write both again", source,
                    piece.list, type));
}

}  // namespace

bool lists_pieces(const InputFile& file) {
  const std::string type = vtk_xml_type(file.beginning);
  return type == in_pieces || is_any_of(type, lists);
}

PieceList piece_list(const InputFile& input, const cells::BlockChoice& choice, bool with_surfaces) {
  const std::filesystem::path& file = input.path;
  require_uncompressed(file);
  PieceList list;
  list.with_surfaces = with_surfaces;
  list.of = input.format;
  if (vtk_xml_type(input.beginning) != in_pieces) {
    list.format = "VTK XML multi-block";
    add_blocks(file, choice, list);
    if (choice.empty() && list.block_names.empty() && !list.surface_names.empty())
      throw scene::bad_input(
          fmt::format("{}: it lists surfaces only ({}), without volume cells; give a mesh and draw these files in it "
                      "with `surface`, or give one of the files, which is filled with cells if it is closed",
                      file.string(), list.surface_names.front() + (list.surface_names.size() > 1 ? ", ..." : "")));
    return list;
  }
  list.format = "VTK XML parallel unstructured grid";
  if (const std::string extension = system::lower_extension(file); !extension.empty() && extension != ".pvtu")
    list.notes.push_back(fmt::format("the file is a {}, read as {}", extension.substr(1), list.format));
  add_pieces_of_whole(file, "", list);
  return list;
}

namespace {

/// Opens a piece in this process, or by VTK's readers if it uses features not supported here.
ForeignFile open_piece(const ListedPiece& piece, const std::string& type, const PieceList& list,
                       std::shared_ptr<HelperProcess>& helper) {
  if (!type.starts_with('P'))
    if (std::optional<ForeignFile> opened = open_vtk_xml(piece.file)) return *std::move(opened);
  if (!helper) {
    HelperTask task;
    task.format = list.of;
    helper = std::make_shared<HelperProcess>(std::move(task));
  }
  return open_foreign(helper, piece.file, {{"reader", "vtk_xml"}, {"type", type}, {"surfaces", list.with_surfaces}});
}

}  // namespace

cells::MeshBlocks read_pieces(const PieceList& list, std::size_t first, std::size_t last,
                              const ReadProgressFunction& progress) {
  cells::MeshBlocks result{{}, list.notes, list.format, list.block_names, list.surface_names};
  std::shared_ptr<HelperProcess> helper;
  for (std::size_t k = first; k < last; ++k) {
    const ListedPiece& piece = list.pieces[k];
    const bool of_whole = piece.type.empty();
    if (of_whole) require_listed(piece);
    if (of_whole) require_piece(piece);
    ForeignFile opened = open_piece(piece, of_whole ? "UnstructuredGrid" : piece.type, list, helper);
    cells::add_notes(opened.contents.notes, result.notes);
    if (!of_whole)
      for (ForeignPart& part : opened.contents.parts) part.name = piece.block;
    for (cells::CellBlock& block : blocks_of(opened, result.notes, GridsAre::hexahedra)) {
      block.name = piece.block;
      if (of_whole) block.source = piece.file.string();
      result.blocks.push_back(std::move(block));
    }
    if (progress)
      progress({ReadProgress::Stage::reading, static_cast<double>(k + 1 - first) / static_cast<double>(last - first)});
  }
  return result;
}

}  // namespace tessera::io
