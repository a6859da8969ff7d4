// SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM cases, read by VTK's reader: whole, or a share of the processors' directories of a decomposed one.
#include <fmt/format.h>
#include <vtkCollection.h>
#include <vtkDummyController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPOpenFOAMReader.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "cells/block_choice.hpp"
#include "cells/mesh_blocks.hpp"
#include "cells/part_range.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/opened_files.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/time_steps.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"
#include "system/gzip.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Reads the part of one processor at a time, while VTK's own reader appends all parts.
class ProcessorReader : public vtkPOpenFOAMReader {
 public:
  static ProcessorReader* New();

  /// Number of parts; valid after UpdateInformation().
  [[nodiscard]] int processors() const { return Readers->GetNumberOfItems(); }

  /// Selects the part that the next update reads; initially all parts are selected.
  void choose(int processor) {
    chosen_ = processor;
    Modified();
  }

 protected:
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override {
    if (chosen_ < 0) return vtkPOpenFOAMReader::RequestData(request, inputs, outputs);
    const vtkNew<vtkCollection> all;
    for (int k = 0; k < processors(); ++k) all->AddItem(Readers->GetItemAsObject(k));
    Readers->RemoveAllItems();
    Readers->AddItem(all->GetItemAsObject(chosen_));
    const int result = vtkPOpenFOAMReader::RequestData(request, inputs, outputs);
    Readers->RemoveAllItems();
    for (int k = 0; k < all->GetNumberOfItems(); ++k) Readers->AddItem(all->GetItemAsObject(k));
    return result;
  }

 private:
  int chosen_ = -1;
};
vtkStandardNewMacro(ProcessorReader);

/// Returns the meshes of a case, or of one of its processors; those of all regions, if there are several.
std::vector<std::filesystem::path> meshes_of(const std::filesystem::path& folder) {
  std::error_code unknown;
  std::vector<std::filesystem::path> meshes;
  const auto add = [&](const std::filesystem::path& of) {
    if (std::filesystem::is_directory(of / "polyMesh", unknown)) meshes.push_back(of / "polyMesh");
  };
  add(folder / "constant");
  for (std::filesystem::directory_iterator entry(folder / "constant", unknown), end; !unknown && entry != end;
       entry.increment(unknown))
    add(entry->path());
  return meshes;
}

/// Whether the lists of a case have 64-bit integers, as its files state ("arch").
bool has_wide_labels(const std::filesystem::path& folder) {
  std::error_code unknown;
  for (const char* part : {".", "processor0"})
    for (const std::filesystem::path& mesh : meshes_of(folder / part))
      for (const char* name : {"owner", "owner.gz"}) {
        const std::filesystem::path file = mesh / name;
        if (!std::filesystem::is_regular_file(file, unknown)) continue;
        const std::string beginning = io::read_beginning(file, 4096);
        if (beginning.starts_with("\x1f\x8b")) {
          const auto text = system::inflate_beginning(std::as_bytes(std::span(beginning)), 2048);
          return std::string_view(reinterpret_cast<const char*>(text.data()), text.size()).find("label=64") !=
                 std::string_view::npos;
        }
        return beginning.find("label=64") != std::string::npos;
      }
  return false;
}

/// Throws for a text file with a compact list of faces. Text files written by OpenFOAM itself have a list for each
/// face.
void refuse_compact_text(const std::filesystem::path& faces, const std::string& source) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(faces, unknown)) return;
  std::string header = io::read_beginning(faces, 4096);
  header.resize(std::min(header.size(), header.find('}')));
  std::istringstream words(header);
  bool is_text = false, is_compact = false;
  for (std::string key, value; words >> key;) {
    if (key == "format" && words >> value) is_text = value.starts_with("ascii");
    if (key == "class" && words >> value) is_compact = value.starts_with("faceCompactList");
  }
  if (is_text && is_compact)
    throw scene::bad_input(
        fmt::format("{}: {} is a faceCompactList in text, which VTK's reader does not support; write the case again "
                    "with foamFormatConvert",
                    source, faces.lexically_normal().string()));
}

/// Throws if a file of a mesh is missing. VTK's reader would act as if there were no mesh, or as if the file were
/// damaged.
void require_mesh_files(const std::filesystem::path& folder, const std::string& source) {
  std::error_code unknown;
  for (const char* part : {".", "processor0"})
    for (const std::filesystem::path& mesh : meshes_of(folder / part)) {
      for (const char* name : {"points", "faces", "owner", "neighbour"})
        if (!std::filesystem::exists(mesh / name, unknown) &&
            !std::filesystem::exists(mesh / (std::string(name) + ".gz"), unknown))
          throw scene::bad_input(fmt::format("{}: its mesh needs {}, but there is no such file; put it there", source,
                                             (mesh / name).lexically_normal().string()));
      refuse_compact_text(mesh / "faces", source);
    }
}

/// Whether a case's subdirectory of this name has files of the case: `system`, `constant`, or the directory of a
/// processor or of a time.
bool belongs_to_case(const std::string& subdirectory) {
  return subdirectory == "system" || subdirectory == "constant" || subdirectory.starts_with("processor") ||
         number_of<double>(subdirectory).has_value();
}

/// Throws if a file that VTK's reader may open is a pipe, which would block the reader. Files directly in the directory
/// of the case are not read. Files of the case are protected from being replaced by outputs.
void require_regular_files(const std::filesystem::path& folder, const std::string& source) {
  std::error_code unknown;
  std::filesystem::recursive_directory_iterator entry(folder, unknown);
  for (; !unknown && entry != std::filesystem::recursive_directory_iterator(); entry.increment(unknown)) {
    std::error_code gone;
    if (entry.depth() > 0 && entry->exists(gone) && !entry->is_regular_file(gone) && !entry->is_directory(gone))
      throw scene::bad_input(
          fmt::format("{}: {} is not a regular file; remove it", source, entry->path().lexically_normal().string()));
    if (entry.depth() > 0 && entry->is_regular_file(gone) &&
        belongs_to_case(entry->path().lexically_relative(folder).begin()->string()))
      note_named_file(entry->path());
  }
}

bool is_case(const std::filesystem::path& folder) {
  std::error_code unknown;
  return io::is_case_folder(folder) || std::filesystem::exists(folder / "processor0", unknown) ||
         std::filesystem::exists(folder / "processors", unknown);
}

/// Returns the directory of the case to which a file or directory belongs: `named` itself, its parent directory, or a
/// directory above that.
std::filesystem::path case_of(const std::filesystem::path& named) {
  std::error_code unknown;
  if (std::filesystem::is_directory(named, unknown)) return named;
  std::filesystem::path own = named.has_parent_path() ? named.parent_path() : std::filesystem::path(".");
  std::filesystem::path folder = own;
  for (int level = 0; level < 4; ++level) {
    if (is_case(folder)) return folder;
    folder /= "..";
  }
  return own;
}

/// Returns the number of processor directories of a case, as VTK counts them.
int processor_folders(const std::filesystem::path& folder) {
  std::error_code unknown;
  int count = 0;
  for (std::filesystem::directory_iterator entry(folder, unknown), end; !unknown && entry != end;
       entry.increment(unknown)) {
    const std::string name = entry->path().filename().string();
    constexpr std::string_view begin = "processor";
    if (name.starts_with(begin) && name.size() > begin.size() && entry->is_directory(unknown) &&
        name.find_first_not_of("0123456789", begin.size()) == std::string::npos)
      ++count;
  }
  return count;
}

/// Returns the names of the patches of all regions. Omits patches between processors, and groups of patches, which are
/// not separate surfaces. Must be called after UpdateInformation().
std::vector<std::string> patches_of(vtkOpenFOAMReader& reader) {
  std::vector<std::string> patches;
  for (int k = 0; k < reader.GetNumberOfPatchArrays(); ++k) {
    const std::string name = reader.GetPatchArrayName(k);
    if (name.find("group/") != std::string::npos) continue;
    const std::size_t slash = name.rfind('/');
    const std::string own = slash == std::string::npos ? name : name.substr(slash + 1);
    if (own != "internalMesh" && !own.starts_with("procBoundary")) patches.push_back(own);
  }
  return cells::distinct_names(std::move(patches));
}

/// Reads the processors of the request's share one by one. The blocks of all shares, in order, are thus the blocks of
/// the complete case.
void read_processors(Holdings& holdings, ProcessorReader& reader, const std::filesystem::path& folder,
                     const std::string& source, const nlohmann::json& request, io::ForeignContents& contents) {
  const int processors = reader.processors(), part = request.value("part", 0), parts = request.value("parts", 1);
  if (const int folders = processor_folders(folder); processors != folders)
    throw scene::bad_input(fmt::format(
        "{}: of its {} processor directories, only {} can be read; run reconstructPar, or decomposePar again", source,
        folders, processors));
  const auto count = static_cast<std::uint64_t>(processors);
  const std::uint64_t last = cells::first_of_part(count, part + 1, parts);
  for (std::uint64_t k = cells::first_of_part(count, part, parts); k < last; ++k) {
    reader.choose(static_cast<int>(k));
    update_at_step(reader, request, source, contents.time_step);
    if (vtkDataObject* const data = reader.GetOutputDataObject(0); data != nullptr)
      for (io::ForeignPart& made : parts_of(holdings, *data, source)) contents.parts.push_back(std::move(made));
  }
}

}  // namespace

io::ForeignContents read_openfoam(Holdings& holdings, const std::filesystem::path& named,
                                  const nlohmann::json& request) {
  const std::filesystem::path folder = case_of(named);
  const std::string source = named.string();
  // The reader determines the case from a name in its directory, and does not require that a file of this name exists.
  const std::filesystem::path file = is_case(folder) ? folder / "case.foam" : named;
  allow_for_folder(folder);
  const vtkNew<ProcessorReader> reader;
  const vtkNew<vtkDummyController> alone;  // the reader needs a rank to select its part of the case
  reader->SetController(alone);
  reader->SetFileName(file.c_str());
  // A case is decomposed if it has directories processor0, processor1, ... of a parallel run, but no reconstructed
  // mesh.
  std::error_code unknown;
  const bool is_whole = !meshes_of(folder).empty();
  const bool is_decomposed = !is_whole && (std::filesystem::exists(folder / "processor0", unknown) ||
                                           std::filesystem::exists(folder / "processors", unknown));
  if (!is_decomposed && !std::filesystem::is_directory(folder / "constant", unknown))
    throw scene::bad_input(fmt::format(
        "{}: there is no mesh of OpenFOAM next to it, constant/polyMesh or processor0/constant/polyMesh; move "
        "it into the directory of a case, or name that directory",
        source));
  require_mesh_files(folder, source);
  require_regular_files(folder, source);
  reader->SetCaseType(is_decomposed ? vtkPOpenFOAMReader::DECOMPOSED_CASE : vtkPOpenFOAMReader::RECONSTRUCTED_CASE);
  reader->SetUse64BitLabels(has_wide_labels(folder));
  reader->CreateCellToPointOff();
  reader->DecomposePolyhedraOff();  // cells/polyhedron_split.hpp decomposes polyhedra instead: conforming, one value
                                    // per cell
  io::ForeignContents contents;
  contents.format = "OpenFOAM case";
  if (!is_decomposed && request.value("part", 0) > 0) return contents;
  const std::string warning = with_quiet_vtk(source, write_again, [&] {
    reader->UpdateInformation();
    reader->EnableAllCellArrays();
    reader->EnableAllPointArrays();
    if (request.value("surfaces", false))
      reader->EnableAllPatchArrays();  // otherwise only the volume is enabled
    else if (contents.surface_names = patches_of(*reader); !contents.surface_names.empty())
      contents.notes.push_back(cells::note_on_surfaces("patch", contents.surface_names));
    if (is_decomposed) return read_processors(holdings, *reader, folder, source, request, contents);
    update_at_step(*reader, request, source, contents.time_step);
    if (vtkDataObject* const data = reader->GetOutputDataObject(0); data != nullptr)
      contents.parts = parts_of(holdings, *data, source);
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  if (contents.parts.empty() && request.value("parts", 1) == 1)
    throw scene::bad_input(fmt::format("{}: it holds no cells; check how it was written", source));
  return contents;
}

}  // namespace tessera::readers
