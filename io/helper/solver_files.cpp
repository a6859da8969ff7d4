// What solvers write, by VTK's readers: all cell and point arrays, one time step.
#include <fmt/format.h>
#include <vtkAVSucdReader.h>
#include <vtkCGNSReader.h>
#include <vtkCommand.h>
#include <vtkDataObject.h>
#include <vtkDummyController.h>
#include <vtkEnSightReader.h>
#include <vtkFLUENTReader.h>
#include <vtkGAMBITReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkPOpenFOAMReader.h>
#include <vtkSmartPointer.h>
#include <vtkTecplotReader.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "io/gzip.hpp"
#include "io/helper/readers.hpp"
#include "io/helper/time_steps.hpp"
#include "io/helper/vtk_parts.hpp"
#include "io/helper/vtk_session.hpp"
#include "io/input_file.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

constexpr const char* write_anew = "the file is truncated or damaged, write it anew";

/// Reads with a reader that is ready but for its file's arrays, which `choose` turns on once they are known.
template <class Reader, class Choose>
ForeignContents read_by(Holdings& holdings, Reader& reader, const std::filesystem::path& file,
                        const nlohmann::json& request, const char* format, const Choose& choose) {
  const std::string source = file.string();
  ForeignContents contents;
  contents.format = format;
  const std::string warning = with_quiet_vtk(source, write_anew, [&] {
    reader.UpdateInformation();
    choose();
    update_at_step(reader, request, source, contents.time_step);
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  vtkDataObject* const data = reader.GetOutputDataObject(0);
  if (data == nullptr) throw scene::bad_input(fmt::format("{}: nothing can be read; write it anew", source));
  contents.parts = parts_of(holdings, *data, source);
  if (contents.parts.empty())
    throw scene::bad_input(fmt::format("{}: it holds no cells; check how it was written", source));
  return contents;
}

/// A reader of one file that reads all of it anyway.
template <class Reader>
ForeignContents read_plainly(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request,
                             const char* format) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  return read_by(holdings, *reader, file, request, format, [] {});
}

/// The meshes of a case, or of one of its processors: of all regions, if it has several.
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

/// Whether a case's lists have 64-bit integers, which its files say of themselves ("arch").
bool has_wide_labels(const std::filesystem::path& folder) {
  std::error_code unknown;
  for (const char* part : {".", "processor0"})
    for (const std::filesystem::path& mesh : meshes_of(folder / part))
      for (const char* name : {"owner", "owner.gz"}) {
        const std::filesystem::path file = mesh / name;
        if (!std::filesystem::is_regular_file(file, unknown)) continue;
        const std::string beginning = read_beginning(file, 4096);
        if (beginning.starts_with("\x1f\x8b")) {
          const auto text = inflate_beginning(std::as_bytes(std::span(beginning)), 2048);
          return std::string_view(reinterpret_cast<const char*>(text.data()), text.size()).find("label=64") !=
                 std::string_view::npos;
        }
        return beginning.find("label=64") != std::string::npos;
      }
  return false;
}

bool is_case(const std::filesystem::path& folder) {
  std::error_code unknown;
  return is_case_folder(folder) || std::filesystem::exists(folder / "processor0", unknown) ||
         std::filesystem::exists(folder / "processors", unknown);
}

/// The folder of the case that a file or folder is of: the one that it is in, or one of those above.
std::filesystem::path case_of(const std::filesystem::path& named) {
  std::error_code unknown;
  if (std::filesystem::is_directory(named, unknown)) return named;
  const std::filesystem::path own = named.has_parent_path() ? named.parent_path() : std::filesystem::path(".");
  std::filesystem::path folder = own;
  for (int level = 0; level < 4; ++level) {
    if (is_case(folder)) return folder;
    folder /= "..";
  }
  return own;
}

/// The first error of a Fluent reader but for its not finding values, without which a case is a mesh all the same.
class FluentErrors : public vtkCommand {
 public:
  static FluentErrors* New() { return new FluentErrors; }
  void Execute(vtkObject*, unsigned long, void* words) override {
    const std::string_view text = words != nullptr ? static_cast<const char*>(words) : "";
    if (!first.empty() || text.find("Could not open data file") != std::string_view::npos) return;
    const std::size_t message = text.find("): ");
    for (const char c : text.substr(message == std::string_view::npos ? 0 : message + 3, 200))
      first += c >= ' ' && c <= '~' ? c : ' ';
    if (first.empty()) first = "VTK reports an error";
  }

  std::string first;
};

}  // namespace

ForeignContents read_openfoam(Holdings& holdings, const std::filesystem::path& named, const nlohmann::json& request) {
  const std::filesystem::path folder = case_of(named);
  // The reader takes the case from a name in its folder, and asks for no such file.
  const std::filesystem::path file = is_case(folder) ? folder / "case.foam" : named;
  allow_for_folder(folder);
  vtkNew<vtkPOpenFOAMReader> reader;
  const vtkNew<vtkDummyController> alone;  // it takes the parts of a case for processes' and asks who it is
  reader->SetController(alone);
  reader->SetFileName(file.c_str());
  // processor0, processor1, ...: written by parallel runs, and not put together since.
  std::error_code unknown;
  const bool is_whole = !meshes_of(folder).empty();
  const bool is_decomposed = std::filesystem::exists(folder / "processor0", unknown) ||
                             std::filesystem::exists(folder / "processors", unknown);
  reader->SetCaseType(!is_whole && is_decomposed ? vtkPOpenFOAMReader::DECOMPOSED_CASE
                                                 : vtkPOpenFOAMReader::RECONSTRUCTED_CASE);
  reader->SetUse64BitLabels(has_wide_labels(folder));
  reader->CreateCellToPointOff();
  reader->DecomposePolyhedraOff();  // ours are conforming, one value a cell (polyhedron_split.hpp)
  return read_by(holdings, *reader, file, request, "OpenFOAM case", [&] {
    reader->EnableAllCellArrays();
    reader->EnableAllPointArrays();
  });
}

ForeignContents read_ensight(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
  vtkNew<vtkGenericEnSightReader> reader;
  reader->SetCaseFileName(file.c_str());
  reader->ReadAllVariablesOn();
  return read_by(holdings, *reader, file, request, "EnSight", [] {});
}

ForeignContents read_cgns(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  vtkNew<vtkCGNSReader> reader;
  reader->SetFileName(file.c_str());
  return read_by(holdings, *reader, file, request, "CGNS", [&] {
    reader->EnableAllBases();
    reader->EnableAllPointArrays();
    reader->EnableAllCellArrays();
  });
}

ForeignContents read_vtk_hdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  return read_plainly<vtkHDFReader>(holdings, file, request, "VTKHDF");
}

ForeignContents read_avs_ucd(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  return read_plainly<vtkAVSucdReader>(holdings, file, request, "AVS UCD");
}

ForeignContents read_fluent(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  // Its values lie beside it, by the name with which VTK looks for them.
  std::string data = file.string();
  data.replace(data.size() - std::min<std::size_t>(data.size(), 3), std::string::npos, "dat");
  std::error_code unknown;
  const bool has_data = std::filesystem::is_regular_file(data, unknown);
  has_data ? allow_for_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."))
           : allow_for(file);
  vtkNew<vtkFLUENTReader> reader;
  vtkNew<FluentErrors> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->SetFileName(file.c_str());
  ForeignContents contents;
  try {
    contents = read_by(holdings, *reader, file, request, "Fluent", [&] { reader->EnableAllCellArrays(); });
  } catch (const scene::Error&) {  // most often by its memory, for it does not mind where a file ends
    throw scene::bad_input(fmt::format("{}: VTK's reader cannot read it; export CGNS or EnSight", file.string()));
  }
  if (!errors->first.empty())
    throw scene::bad_input(fmt::format("{}: {}; {}", file.string(), errors->first, write_anew));
  std::erase_if(contents.notes,
                [](const std::string& note) { return note.find("open dat file") != std::string::npos; });
  if (!has_data) contents.notes.emplace_back("no .dat file lies beside the case: it has no field");
  return contents;
}

ForeignContents read_gambit(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  return read_plainly<vtkGAMBITReader>(holdings, file, request, "GAMBIT");
}

ForeignContents read_tecplot(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  return read_plainly<vtkTecplotReader>(holdings, file, request, "Tecplot (text)");
}

}  // namespace tessera::io::helper
