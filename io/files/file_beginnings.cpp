// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/file_beginnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "scene/error.hpp"

namespace tessera::io {
namespace {

constexpr std::string_view white_space = " \t\r\n\v\f";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(white_space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(white_space) - first + 1);
}

bool is_text(std::string_view text) { return text.find('\0') == std::string_view::npos; }

/// The first `count` lines that are neither blank nor begin with `comment`; the last line of a truncated text may be
/// incomplete.
std::vector<std::string_view> first_lines(std::string_view text, char comment, std::size_t count) {
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < count) {
    const std::size_t end = text.find('\n');
    const std::string_view line = without_blanks(text.substr(0, end));
    if (!line.empty() && line.front() != comment) lines.push_back(line);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return lines;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = without_blanks(line); !line.empty();) {
    const std::size_t end = std::min(line.find_first_of(white_space), line.size());
    words.push_back(line.substr(0, end));
    line = without_blanks(line.substr(end));
  }
  return words;
}

bool is_count(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Whether a line consists of KEY and the character `after`, with blanks between them, in upper or lower case.
bool is_key(std::string_view line, std::string_view key, char after) {
  if (line.size() < key.size() ||
      !std::equal(key.begin(), key.end(), line.begin(), [](char a, char b) { return a == (b & ~0x20); }))
    return false;
  const std::string_view rest = without_blanks(line.substr(key.size()));
  return rest.starts_with(after);
}

/// Returns the header size that is stored in a NIfTI or Analyze header, in either byte order, if it is 348 or 540 and
/// the text has at least as many bytes; otherwise 0.
std::size_t nifti_header_size(std::string_view text) {
  for (const std::size_t size : {348U, 540U}) {
    const char low = static_cast<char>(size & 255), high = static_cast<char>(size >> 8);
    const std::string_view first = text.substr(0, 4);
    if (text.size() >= size && (first == std::string{low, high, 0, 0} || first == std::string{0, 0, high, low}))
      return size;
  }
  return 0;
}

bool is_xml_of(const FileBeginning& file, std::initializer_list<std::string_view> types) {
  const std::string type = vtk_xml_type(file.text);
  return !type.empty() && std::find(types.begin(), types.end(), type) != types.end();
}

bool is_legacy_of(const FileBeginning& file, std::initializer_list<std::string_view> types) {
  const std::string type = vtk_legacy_type(file.text);
  return !type.empty() && std::find(types.begin(), types.end(), type) != types.end();
}

}  // namespace

bool looks_like_dicom(std::string_view beginning) {
  return beginning.size() >= 132 && beginning.substr(128, 4) == "DICM";
}

bool looks_like_amrex(std::string_view beginning) {
  const auto next = [&] {
    const std::size_t end = std::min(beginning.find('\n'), beginning.size());
    std::string_view line = beginning.substr(0, end);
    beginning.remove_prefix(std::min(end + 1, beginning.size()));
    const std::size_t first = line.find_first_not_of(white_space);
    if (first == std::string_view::npos) return std::string_view();
    return line.substr(first, line.find_last_not_of(white_space) + 1 - first);
  };
  constexpr std::int64_t most_fields = 1 << 16;
  const std::string_view version = next(), count = next();
  if (version.empty() || version.find_first_of(" \t") != std::string_view::npos || version.find('\0') != version.npos)
    return false;
  std::int64_t fields = 0;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), fields);
  if (error != std::errc() || end != count.data() + count.size() || fields < 1 || fields > most_fields) return false;
  for (std::int64_t f = 0; f < fields; ++f) {
    if (next().empty()) return false;
    if (beginning.empty()) return version.ends_with("-V1.1");  // the text ends among many fields
  }
  const std::string_view dimensions = next();
  return dimensions == "1" || dimensions == "2" || dimensions == "3";
}

bool begins_as_medit_text(std::string_view beginning) {
  const std::size_t first = beginning.find_first_not_of(" \t\r\n\v\f");
  return first < 64 && beginning.substr(first).starts_with("MeshVersionFormatted");
}

bool begins_as_medit_binary(std::string_view beginning) {
  constexpr char dimension_keyword = 3;
  const auto has = [&](std::size_t at, char value, bool is_big) {
    const std::array<char, 4> little = {value, 0, 0, 0}, big = {0, 0, 0, value};
    return at + 4 <= beginning.size() &&
           std::memcmp(beginning.data() + at, is_big ? big.data() : little.data(), 4) == 0;
  };
  // Other files also begin with a 1 and a small number, so the first keyword, the dimension, decides.
  for (const bool is_big : {false, true})
    for (const char version : {'\1', '\2', '\3', '\4'}) {
      const std::size_t dimension_at = version >= 3 ? 20 : 16;
      if (has(0, 1, is_big) && has(4, version, is_big) && has(8, dimension_keyword, is_big) &&
          (has(dimension_at, 2, is_big) || has(dimension_at, 3, is_big)))
        return true;
    }
  return false;
}

void require_no_utf16(std::string_view beginning, const std::string& source) {
  if (beginning.starts_with("\xff\xfe") || beginning.starts_with("\xfe\xff"))
    throw scene::bad_input(fmt::format("{}: it is text in UTF-16; save it in UTF-8", source));
}

std::string vtk_xml_type(std::string_view text) {
  if (constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(byte_order_mark))
    text.remove_prefix(byte_order_mark.size());
  const std::size_t element = text.find("<VTKFile");
  if (element == std::string_view::npos || !without_blanks(text.substr(0, element + 1)).starts_with('<')) return "";
  const std::size_t end = text.find('>', element);
  constexpr std::string_view word = "type";
  std::size_t key = text.find(word, element);
  while (key < end && (!without_blanks(text.substr(key - 1, 1)).empty() ||  // `type` may be the end of header_type
                       !without_blanks(text.substr(key + word.size())).starts_with('=')))
    key = text.find(word, key + 1);
  if (key == std::string_view::npos || key > end) return "";
  const std::size_t open = text.find_first_of("\"'", key);
  if (open == std::string_view::npos) return "";
  const std::size_t close = text.find(text[open], open + 1);
  return std::string(close == std::string_view::npos ? std::string_view() : text.substr(open + 1, close - open - 1));
}

std::string vtk_legacy_type(std::string_view text) {
  if (!text.starts_with("# vtk DataFile")) return "";
  const std::size_t at = text.find("DATASET");
  if (at == std::string_view::npos) return "";
  const auto words = words_of(text.substr(at + 7, 60));
  return words.empty() ? "" : std::string(words.front());
}

bool begins_as_vtu(const FileBeginning& file) { return is_xml_of(file, {"UnstructuredGrid", "PUnstructuredGrid"}); }
bool begins_as_vts(const FileBeginning& file) { return is_xml_of(file, {"StructuredGrid", "PStructuredGrid"}); }
bool begins_as_vtk_list(const FileBeginning& file) {
  return is_xml_of(file, {"vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection", "vtkPartitionedDataSet"});
}
bool begins_as_vtk_amr(const FileBeginning& file) {
  return is_xml_of(file, {"vtkOverlappingAMR", "vtkNonOverlappingAMR", "vtkHierarchicalBoxDataSet"});
}
bool begins_as_hyper_trees(const FileBeginning& file) { return is_xml_of(file, {"HyperTreeGrid", "PHyperTreeGrid"}); }
bool begins_as_amrex(const FileBeginning& file) { return looks_like_amrex(file.text); }
bool begins_as_enzo(const FileBeginning& file) {
  if (!is_text(file.text)) return false;
  const auto lines = first_lines(file.text, '#', 8);
  if (lines.empty()) return false;
  return is_key(lines[0], "BOUNDARYRANK", '=') ||
         (is_key(lines[0], "GRID", '=') &&
          std::any_of(lines.begin(), lines.end(), [](std::string_view line) { return is_key(line, "GRIDRANK", '='); }));
}
bool begins_as_vtk_surface(const FileBeginning& file) {
  return is_xml_of(file, {"PolyData"}) || is_legacy_of(file, {"POLYDATA"});
}
bool begins_as_vti(const FileBeginning& file) { return is_xml_of(file, {"ImageData", "PImageData"}); }
bool begins_as_vtr(const FileBeginning& file) { return is_xml_of(file, {"RectilinearGrid", "PRectilinearGrid"}); }
bool begins_as_pvd(const FileBeginning& file) { return is_xml_of(file, {"Collection"}); }
bool begins_as_file_series(const FileBeginning& file) {
  return without_blanks(file.text).starts_with('{') &&
         file.text.find("\"file-series-version\"") != std::string_view::npos;
}
bool begins_as_vtk_xml(const FileBeginning& file) { return file.text.find("<VTKFile") != std::string_view::npos; }

bool begins_as_legacy_mesh(const FileBeginning& file) {
  return file.text.starts_with("# vtk DataFile") && !begins_as_legacy_grid(file) && !begins_as_vtk_surface(file);
}
bool begins_as_legacy_grid(const FileBeginning& file) {
  return is_legacy_of(file, {"STRUCTURED_POINTS", "RECTILINEAR_GRID"});
}

/// Classic NetCDF files list their dimensions first.
bool begins_as_exodus(const FileBeginning& file) {
  return file.text.starts_with("CDF") &&
         (file.text.find("num_nodes") != std::string_view::npos || file.text.find("num_dim") != std::string_view::npos);
}
bool begins_as_minc(const FileBeginning& file) {
  return file.text.starts_with("CDF") && file.text.find("xspace") != std::string_view::npos &&
         file.text.find("yspace") != std::string_view::npos && file.text.find("zspace") != std::string_view::npos;
}
bool begins_as_netcdf(const FileBeginning& file) {
  return (file.text.starts_with("CDF\1") || file.text.starts_with("CDF\2") || file.text.starts_with("CDF\5")) &&
         !begins_as_exodus(file) && !begins_as_minc(file);
}
bool begins_as_hdf5(const FileBeginning& file) { return file.text.starts_with(hdf5_signature); }
/// The four bytes before "ADF" are "@(#)"; some of these bytes have the highest bit set.
bool begins_as_adf(const FileBeginning& file) {
  return file.text.size() > 4 && file.text.substr(4).starts_with("ADF Database Version");
}

bool begins_as_openfoam(const FileBeginning& file) {
  const std::size_t word = file.text.find("FoamFile");
  return word != std::string_view::npos && without_blanks(file.text.substr(word + 8)).starts_with('{');
}

bool begins_as_ensight(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '#', 2);
  return is_text(file.text) && lines.size() == 2 && lines[0] == "FORMAT" &&
         without_blanks(lines[1]).starts_with("type:");
}

bool begins_as_gmsh(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '\0', 1);
  if (lines.empty()) return false;
  if (lines[0] == "$MeshFormat" || lines[0] == "$NOD") return true;
  return lines[0] == "$Comments" && file.text.find("$MeshFormat") != std::string_view::npos;
}

/// ParaView's .p3d: JSON that names grids and solutions.
bool begins_as_plot3d_list(const FileBeginning& file) {
  return without_blanks(file.text).starts_with('{') && file.text.find("\"filenames\"") != std::string_view::npos &&
         file.text.find("\"xyz\"") != std::string_view::npos;
}
bool begins_as_su2(const FileBeginning& file) {
  if (!is_text(file.text)) return false;
  const auto lines = first_lines(file.text, '%', 1);
  return !lines.empty() && (is_key(lines[0], "NDIME", '=') || is_key(lines[0], "NZONE", '='));
}

bool begins_as_fluent(const FileBeginning& file) {
  const std::string_view text = without_blanks(file.text);
  if (!text.starts_with('(')) return false;
  const auto words = words_of(text.substr(1, 40));
  // The file consists of sections: a comment, whose quotes some writers omit, a header, dimensions, the machine that
  // wrote the file.
  return words.size() > 1 && is_count(words[0]) && words[0].size() <= 2 &&
         (words[0] == "0" || words[1].front() == '"' || words[1].front() == '(' ||
          (words[0] == "2" && (words[1].front() == '3' || words[1].front() == '2')));
}

bool begins_as_gambit(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '\0', 1);
  return !lines.empty() && lines[0].starts_with("CONTROL INFO");
}

bool begins_as_avs_ucd(const FileBeginning& file) {
  if (!is_text(file.text)) return false;
  const auto lines = first_lines(file.text, '#', 2);
  if (lines.size() < 2) return false;
  const auto counts = words_of(lines[0]), point = words_of(lines[1]);
  return counts.size() == 5 && std::all_of(counts.begin(), counts.end(), is_count) && point.size() == 4 &&
         is_count(point[0]);
}

bool begins_as_tecplot(const FileBeginning& file) {
  if (!is_text(file.text)) return false;
  const auto lines = first_lines(file.text, '#', 1);
  return !lines.empty() && (is_key(lines[0], "TITLE", '=') || is_key(lines[0], "VARIABLES", '='));
}

bool begins_as_stl(const FileBeginning& file) {
  if (file.text.size() >= 84) {
    std::uint32_t faces = 0;
    std::memcpy(&faces, file.text.data() + 80, sizeof faces);
    if (faces > 0 && file.size == 84 + 50 * std::uint64_t{faces}) return true;
  }
  const std::string_view text = without_blanks(file.text);
  if (!text.starts_with("solid") || !is_text(file.text)) return false;
  const auto lines = first_lines(text, '\0', 2);
  return lines.size() == 2 && lines[1].starts_with("facet");
}

bool begins_as_ply(const FileBeginning& file) {
  return file.text.starts_with("ply\n") || file.text.starts_with("ply\r") || file.text.starts_with("ply ");
}

bool begins_as_brick_file(const FileBeginning& file) { return file.text.starts_with("TESSBRK1"); }
bool begins_as_nrrd(const FileBeginning& file) { return file.text.starts_with("NRRD000"); }
bool begins_as_meta_image(const FileBeginning& file) {
  return file.text.starts_with("ObjectType") || file.text.starts_with("NDims") ||
         (file.text.starts_with("Comment") && file.text.find("NDims") != std::string_view::npos);
}

/// Checks for a header size in either byte order, and for NIfTI's magic word.
bool begins_as_nifti(const FileBeginning& file) {
  const auto has_magic = [&](std::size_t at, std::string_view first, std::string_view second) {
    const std::string_view magic = file.text.substr(at, 4);
    return magic == first || magic == second;
  };
  const std::size_t size = nifti_header_size(file.text);
  return (size == 348 && has_magic(344, {"n+1\0", 4}, {"ni1\0", 4})) ||
         (size == 540 && has_magic(4, {"n+2\0", 4}, {"ni2\0", 4}));
}
bool begins_as_dicom(const FileBeginning& file) { return looks_like_dicom(file.text); }
/// The header is like that of NIfTI, without the magic word.
bool begins_as_analyze(const FileBeginning& file) {
  if (begins_as_nifti(file) || nifti_header_size(file.text) != 348) return false;
  const auto dimensions = [&](std::size_t low) { return file.text[low] >= 1 && file.text[low] <= 7; };
  return (file.text[41] == 0 && dimensions(40)) || (file.text[40] == 0 && dimensions(41));
}

bool begins_as_xdmf(const FileBeginning& file) {
  return without_blanks(file.text).starts_with('<') && file.text.find("<Xdmf") != std::string_view::npos;
}
bool begins_as_binary_tecplot(const FileBeginning& file) { return file.text.starts_with("#!TDV"); }

bool begins_as_abaqus(const FileBeginning& file) {
  if (!is_text(file.text)) return false;
  const auto lines = first_lines(file.text, '\0', 1);
  if (lines.empty() || !lines[0].starts_with('*')) return false;
  std::string word(lines[0].substr(0, 9));
  std::transform(word.begin(), word.end(), word.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  constexpr std::array first_words = {"**",       "*heading", "*node",  "*part",  "*include",
                                      "*preprin", "*assembl", "*param", "*elset", "*nset"};
  return std::any_of(first_words.begin(), first_words.end(), [&](const char* w) { return word.starts_with(w); });
}

bool begins_as_medit(const FileBeginning& file) { return begins_as_medit_text(file.text); }
/// The file begins with the single number 1, like binary Medit.
bool begins_as_freesurfer(const FileBeginning& file) { return file.text.starts_with(std::string_view("\0\0\0\1", 4)); }
bool begins_as_meshb(const FileBeginning& file) { return begins_as_medit_binary(file.text); }
bool begins_as_mfem(const FileBeginning& file) {
  return file.text.starts_with("MFEM ") && first_lines(file.text, '#', 1)[0].find("mesh v") != std::string_view::npos;
}
bool begins_as_netgen(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '#', 1);
  return !lines.empty() && lines[0] == "mesh3d";
}
bool begins_as_nek5000(const FileBeginning& file) { return file.text.starts_with("#std "); }

bool begins_as_ls_dyna(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '$', 1);
  return is_text(file.text) && !lines.empty() && lines[0].substr(0, 8) == "*KEYWORD";
}
bool begins_as_frd(const FileBeginning& file) {
  return file.text.starts_with("    1C") && file.text.substr(0, 4096).find("\n    1U") != std::string_view::npos;
}
bool begins_as_step(const FileBeginning& file) { return without_blanks(file.text).starts_with("ISO-10303-21;"); }
bool begins_as_brep(const FileBeginning& file) {
  return without_blanks(file.text).starts_with("DBRep_DrawableShape") ||
         without_blanks(file.text).starts_with("CASCADE Topology");
}
bool begins_as_off(const FileBeginning& file) {
  const auto lines = first_lines(file.text, '#', 1);
  return is_text(file.text) && !lines.empty() && (lines[0] == "OFF" || lines[0] == "COFF" || lines[0] == "NOFF");
}
bool begins_as_gltf(const FileBeginning& file) { return file.text.starts_with("glTF"); }
bool begins_as_vdb(const FileBeginning& file) { return file.text.starts_with(std::string_view(" BDV\0\0\0\0", 8)); }
bool begins_as_nvdb(const FileBeginning& file) { return file.text.starts_with("NanoVDB"); }
bool begins_as_grib(const FileBeginning& file) {
  return file.text.size() > 8 && file.text.starts_with("GRIB") && (file.text[7] == 1 || file.text[7] == 2);
}
bool begins_as_hdf4(const FileBeginning& file) { return file.text.starts_with("\x0e\x03\x13\x01"); }
bool begins_as_fits(const FileBeginning& file) { return file.text.starts_with("SIMPLE  ="); }
bool begins_as_mrc(const FileBeginning& file) {
  return file.text.size() >= 1024 && file.text.substr(208, 3) == "MAP" && !is_text(file.text.substr(0, 208));
}
bool begins_as_amira(const FileBeginning& file) {
  return file.text.starts_with("# AmiraMesh") || file.text.starts_with("# Avizo");
}
bool begins_as_tiff(const FileBeginning& file) {
  return file.text.starts_with(std::string_view("II*\0", 4)) || file.text.starts_with(std::string_view("MM\0*", 4)) ||
         file.text.starts_with(std::string_view("II+\0", 4)) || file.text.starts_with(std::string_view("MM\0+", 4));
}
bool begins_as_numpy(const FileBeginning& file) { return file.text.starts_with("\x93NUMPY"); }

}  // namespace tessera::io
