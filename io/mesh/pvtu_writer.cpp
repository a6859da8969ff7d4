// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/pvtu_writer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "io/mesh/mesh_reader.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

std::filesystem::path waiting_name(const std::filesystem::path& file, int piece) {
  return file.parent_path() / fmt::format(".tessera-{}-piece{}.part", ::getpid(), piece);
}

}  // namespace

std::filesystem::path pvtu_piece_name(const std::filesystem::path& file, int piece) {
  return file.parent_path() / fmt::format("{}_{:04}.vtu", file.stem().string(), piece);
}

PvtuWriter::PvtuWriter(std::filesystem::path file, const scene::TetMeshView& like) : file_(std::move(file)) {
  const std::string name = like.field_name.empty() ? "scalar" : xml_escaped(std::string(like.field_name));
  const std::string scalar = fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"/>\n", name);
  const bool point = like.association == scene::Association::point;
  std::string cell = point ? "" : scalar;
  if (!like.original_cell.empty()) cell += "      <PDataArray type=\"Int64\" Name=\"OriginalCellId\"/>\n";
  arrays_ = fmt::format("    <PPointData{}>\n{}    </PPointData>\n    <PCellData{}>\n{}    </PCellData>\n",
                        point ? fmt::format(" Scalars=\"{}\"", name) : "", point ? scalar : "",
                        point ? "" : fmt::format(" Scalars=\"{}\"", name), cell);
}

PvtuWriter::~PvtuWriter() {
  std::error_code ignored;
  for (const auto& file : left_over_) std::filesystem::remove(file, ignored);
}

void PvtuWriter::add(const scene::TetMesh& piece) {
  left_over_.push_back(waiting_name(file_, pieces_));
  write_vtu(piece, left_over_.back());
  ++pieces_;
}

void PvtuWriter::commit() {
  system::AtomicFile list_file(file_);
  list_file.write(list());
  for (int p = 0; p < pieces_; ++p) {
    const auto name = pvtu_piece_name(file_, p);
    std::error_code error;
    std::filesystem::rename(left_over_[static_cast<std::size_t>(p)], name, error);
    if (error)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("{}: cannot be written: {}; check the directory", name.string(), error.message()));
    left_over_[static_cast<std::size_t>(p)] = name;
  }
  list_file.commit();
  left_over_.clear();
}

std::string PvtuWriter::list() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PUnstructuredGrid GhostLevel=\"0\">\n" +
      arrays_ +
      "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n";
  for (int p = 0; p < pieces_; ++p)
    text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escaped(pvtu_piece_name(file_, p).filename().string()));
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace tessera::io
