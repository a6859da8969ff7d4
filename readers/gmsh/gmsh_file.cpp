// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/gmsh/gmsh_blocks.hpp"
#include "readers/gmsh/gmsh_view_names.hpp"
#include "readers/gmsh/unv_check.hpp"
#include "scene/error.hpp"
#include "system/descriptor.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Returns the first error in Gmsh's log. The name passed to Gmsh is replaced by the file's name.
std::string first_error(std::vector<std::string> log, const std::string& given, const std::string& source) {
  for (std::string& line : log) {
    constexpr std::string_view mark = "Error: ";
    if (!line.starts_with(mark)) continue;
    line.erase(0, mark.size());
    if (const std::size_t at = line.find(given); at != std::string::npos) line.replace(at, given.size(), source);
    return printable_ascii(std::string_view(line).substr(0, 160));
  }
  return "";
}

/// Reads a file. Returns false if the library failed on partitions, so that the caller may try the file without them.
bool merge(const std::string& given, const std::string& source, bool is_last_try = true) {
  static bool is_ready = false;
  if (!is_ready) {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    is_ready = true;
  }
  gmsh::clear();
  allow_for(source);  // called after loading the library, whose memory does not count for the file
  gmsh::logger::start();
  bool failed = false;
  try {
    gmsh::merge(given);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {  // Gmsh throws objects of any type
    failed = true;
  }
  std::vector<std::string> log;
  gmsh::logger::get(log);
  const bool gave_up_at_partitions = std::any_of(log.begin(), log.end(), [](const std::string& line) {
    return line.starts_with("Error: No mesh elements were found");
  });
  const std::string error = first_error(std::move(log), given, source);
  gmsh::logger::stop();
  if (gave_up_at_partitions && !is_last_try) return false;
  if (failed || !error.empty())
    throw scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it again", source,
                                       error.empty() ? "Gmsh cannot read it" : "Gmsh reports " + error));
  return true;
}

/// Throws if the file ends between two sections, which Gmsh accepts.
void require_last_section(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  std::string end(static_cast<std::size_t>(std::min<std::streamoff>(size, 256)), '\0');
  in.seekg(size - static_cast<std::streamoff>(end.size()));
  in.read(end.data(), static_cast<std::streamsize>(end.size()));
  end.resize(end.find_last_not_of(ascii_blanks) + 1);
  const std::size_t line = end.find_last_of("\r\n");
  const std::string_view words = std::string_view(end).substr(line == std::string::npos ? 0 : line + 1);
  if (!words.starts_with("$End") && words != "$ENDELM" && words != "$ENDNOD")
    throw scene::bad_input(fmt::format(
        "{}: its last section is not closed by a line $End...; it is truncated, write it again", file.string()));
}

bool has_values(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  return mapped.text().find("\n$NodeData") != std::string_view::npos ||
         mapped.text().find("\n$ElementData") != std::string_view::npos;
}

io::ForeignContents contents_of_model(Holdings& holdings, const std::string& source, const nlohmann::json& request,
                                      const char* format, const std::filesystem::path& listed) {
  io::ForeignContents contents;
  contents.format = format;
  std::optional<std::size_t> time_step;
  if (const auto step = request.find("time_step"); step != request.end()) time_step = step->get<std::size_t>();
  const std::vector<GmshView> views = gmsh_views(time_step, source, contents.notes, contents.time_step);
  GmshBlocks read = gmsh_blocks(views, request.value("blocks", cells::BlockChoice()), listed, source, contents.notes);
  for (cells::CellBlock& block : read.blocks) contents.parts.push_back(hold_block(holdings, std::move(block)));
  contents.block_names = std::move(read.names);
  gmsh::clear();
  if (contents.parts.empty())
    throw scene::bad_input(fmt::format(
        "{}: it holds no cells of volume; give a mesh of tetrahedra, hexahedra, prisms or pyramids", source));
  return contents;
}

}  // namespace

io::ForeignContents read_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string(), beginning = io::read_beginning(file, 16);
  if (!beginning.starts_with("$MeshFormat") && !beginning.starts_with("$NOD") && !beginning.starts_with("$Comments"))
    throw scene::bad_input(fmt::format("{}: it does not begin with $MeshFormat; write the file again", source));
  require_last_section(file);
  // Gmsh gets a name without an extension, because it would trust the extension of another format.
  system::Descriptor opened(::open(source.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened.is_open()) throw scene::bad_input(fmt::format("{}: it cannot be opened; check its permissions", source));
  if (system::Descriptor quoted = with_quoted_view_names(file); quoted.is_open()) opened = std::move(quoted);
  const auto path_of = [](const system::Descriptor& copy) { return fmt::format("/proc/self/fd/{}", copy.get()); };
  try {
    if (!merge(path_of(opened), source, false)) {
      if (system::Descriptor copy = without_partitions(path_of(opened)); copy.is_open()) opened = std::move(copy);
      merge(path_of(opened), source);
    }
  } catch (const std::bad_alloc&) {
    if (!has_values(file)) throw;
    throw memory_error(source,
                       "its values need more memory than a file of its size should: Gmsh's library allocates memory "
                       "for every number up to the largest node or element number; number nodes and elements from 1");
  }
  return contents_of_model(holdings, source, request, "Gmsh", file);
}

io::ForeignContents read_by_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string(), extension = file.extension().string();
  if (extension != ".unv" && extension != ".UNV")  // the only capitalizations that Gmsh accepts
    throw scene::bad_input(
        fmt::format("{}: Gmsh's library recognizes these files by their names only; unpack it, if it is packed, and "
                    "have its name end in .unv",
                    source));
  require_read_unv(file);
  merge(source, source);
  return contents_of_model(holdings, source, request, "I-DEAS universal", {});
}

}  // namespace tessera::readers
