// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/volume_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "io/files/input_file.hpp"
#include "io/text/xml_elements.hpp"
#include "io/volume/brick_file.hpp"
#include "io/vtk/vtk_xml_grid.hpp"
#include "scene/error.hpp"
#include "scene/number_type.hpp"
#include "system/atomic_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using scene::SampleType;

void write_values(const scene::SampleSource& source, system::AtomicFile& out) {
  const scene::Grid& grid = source.grid();
  const SampleType type = written_type(grid);
  const scene::SampleBox all = grid.geometry.all_samples();
  std::vector<std::byte> bytes;
  std::vector<double> values;
  for (std::int64_t k = 0; k < all.high[2]; ++k) {
    const scene::SampleBox slice{{0, 0, k}, {all.high[0], all.high[1], k + 1}};
    const auto count = static_cast<std::size_t>(slice.count());
    bytes.resize(count * scene::size_of(type));
    if (type == grid.type && grid.scale == 1 && grid.shift == 0) {
      source.read(slice, {.type = type}, bytes);
    } else {
      values.resize(count);
      source.read(slice, std::span<double>(values));
      for (double& v : values) v = grid.value(v);
      scene::convert_samples(reinterpret_cast<const std::byte*>(values.data()), SampleType::float64, 1, false,
                             slice.count(), bytes.data(), type);
    }
    out.write(bytes.data(), bytes.size());
  }
}

using TagWords = std::vector<std::pair<std::string, std::string>>;

/// Returns the strings of a VTK data set as field data: character codes, ended by 0.
std::string field_data_of(const TagWords& words) {
  if (words.empty()) return {};
  std::string text = "\n    <FieldData>\n";
  for (const auto& [name, word] : words) {
    text += fmt::format("      <DataArray type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">\n        ",
                        name);
    for (const char letter : word) text += fmt::format("{} ", static_cast<int>(static_cast<unsigned char>(letter)));
    text += "0\n      </DataArray>\n";
  }
  return text + "    </FieldData>";
}

/// Writes VTK XML with one appended raw array. The coordinates of a rectilinear grid are inline.
void write_vtk_volume(const scene::SampleSource& source, system::AtomicFile& out, bool rectilinear,
                      const TagWords& words) {
  const scene::Grid& grid = source.grid();
  const scene::GridGeometry& g = grid.geometry;
  const SampleType type = written_type(grid);
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", g.points[0] - 1, g.points[1] - 1, g.points[2] - 1);
  const bool point = g.association == scene::Association::point;
  const char* const kind = rectilinear ? "RectilinearGrid" : "ImageData";
  const std::string field = xml_escaped(grid.field_name.empty() ? "samples" : grid.field_name);
  std::string head = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n  <{} WholeExtent=\"{}\"",
      kind, kind, extent);
  if (!rectilinear) {
    const glm::dmat3& d = g.direction;  // VTK writes the matrix row by row
    head += fmt::format(" Origin=\"{} {} {}\" Spacing=\"{} {} {}\" Direction=\"{} {} {} {} {} {} {} {} {}\"",
                        g.origin.x, g.origin.y, g.origin.z, g.spacing.x, g.spacing.y, g.spacing.z, d[0][0], d[1][0],
                        d[2][0], d[0][1], d[1][1], d[2][1], d[0][2], d[1][2], d[2][2]);
  }
  head += fmt::format(">{}", field_data_of(words));
  const char* const section = point ? "PointData" : "CellData";
  head += fmt::format(
      "\n    <Piece Extent=\"{}\">\n      <{} Scalars=\"{}\">\n        <DataArray type=\"{}\" Name=\"{}\" "
      "format=\"appended\" offset=\"0\"/>\n      </{}>\n",
      extent, section, field, vtk_xml_type_name(scene::number_type_of(type)), field, section);
  if (rectilinear) {
    head += "      <Coordinates>\n";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      head += fmt::format("        <DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n          ", "xyz"[axis]);
      for (std::int64_t i = 0; i < g.points[axis]; ++i)
        head += fmt::format("{} ", g.lattice(axis, i) + g.origin[static_cast<int>(axis)]);
      head += "\n        </DataArray>\n";
    }
    head += "      </Coordinates>\n";
  }
  head += fmt::format("    </Piece>\n  </{}>\n  <AppendedData encoding=\"raw\">\n_", kind);
  out.write(head);
  const std::uint64_t bytes = static_cast<std::uint64_t>(g.all_samples().count()) * scene::size_of(type);
  out.write(&bytes, sizeof bytes);
  write_values(source, out);
  out.write("\n  </AppendedData>\n</VTKFile>\n");
}

void write_nrrd(const scene::SampleSource& source, system::AtomicFile& out, const TagWords& words) {
  const scene::GridGeometry& g = source.geometry();
  const SampleType type = written_type(source.grid());
  const auto word_of = [&](const char* name) {
    const auto found = std::ranges::find(words, name, &TagWords::value_type::first);
    return found == words.end() ? std::string() : found->second;
  };
  const std::string space = word_of("space");
  std::string head = fmt::format(
      "NRRD0004\ntype: {}\ndimension: 3\n{}\nsizes: {} {} {}\n", scene::listed_name(scene::number_type_of(type)),
      space.empty() ? "space dimension: 3" : fmt::format("space: {}", space), g.points[0], g.points[1], g.points[2]);
  head += "space directions:";
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 step = g.direction[axis] * g.spacing[axis];
    head += fmt::format(" ({},{},{})", step.x, step.y, step.z);
  }
  head +=
      fmt::format("\nspace origin: ({},{},{})\nendian: little\nencoding: raw\n", g.origin.x, g.origin.y, g.origin.z);
  if (const std::string unit = word_of("length unit"); !unit.empty())
    head += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", unit);
  if (const std::string unit = word_of("unit"); !unit.empty()) head += fmt::format("sample units: \"{}\"\n", unit);
  for (const char* key : {"modality", "intent"})
    if (const std::string word = word_of(key); !word.empty()) head += fmt::format("{}:={}\n", key, word);
  head += '\n';
  out.write(head);
  write_values(source, out);
}

/// Returns a property of the grid that the format cannot represent; null if it can represent everything.
const char* unsupported_property(const scene::GridGeometry& g, std::string_view extension) {
  const bool xml = extension == ".vti" || extension == ".vtr";
  if (extension == ".bricks") return nullptr;
  if (!xml && g.association == scene::Association::cell) return "that it is cell data";
  if (extension != ".vtr" && g.rectilinear()) return "where a rectilinear grid's points are";
  const bool is_turned = g.direction != glm::dmat3(1.0);
  return (extension == ".raw" || extension == ".vtr") && is_turned ? "how the grid is rotated" : nullptr;
}

/// Throws if the format cannot represent the grid.
void check_format(const scene::Grid& grid, const std::string& extension, const std::string& target) {
  const char* const what = unsupported_property(grid.geometry, extension);
  if (what == nullptr) return;
  std::vector<const char*> others;
  for (const char* other : {".vti", ".vtr", ".nrrd"})
    if (unsupported_property(grid.geometry, other) == nullptr) others.push_back(other);
  throw scene::bad_input(fmt::format("{}: {} cannot store {}; write {}{}.bricks", target, extension, what,
                                     fmt::join(others, ", "), others.empty() ? "" : " or "));
}

}  // namespace

SampleType written_type(const scene::Grid& grid) {
  if (grid.scale == 1 && grid.shift == 0) return grid.type;
  return scene::size_of(grid.type) < 4 || grid.type == SampleType::float32 ? SampleType::float32 : SampleType::float64;
}

bool is_volume_output(const std::filesystem::path& file) {
  const std::string extension = system::lower_extension(file);
  return extension == ".vti" || extension == ".vtr" || extension == ".nrrd" || extension == ".raw" ||
         extension == ".bricks";
}

void write_volume(const scene::SampleSource& source, const std::filesystem::path& file, int block, BodyAxes axes,
                  const VolumeTags& tags) {
  const std::string extension = system::lower_extension(file);
  if (extension == ".bricks") return write_bricks(source, file, block, axes, tags);
  check_format(source.grid(), extension, file.string());
  system::AtomicFile out(file);
  if (extension == ".vti" || extension == ".vtr")
    write_vtk_volume(source, out, extension == ".vtr", tag_words(axes, tags));
  else if (extension == ".nrrd")
    write_nrrd(source, out, tag_words(axes, tags));
  else
    write_values(source, out);
  out.commit();
}

}  // namespace tessera::io
