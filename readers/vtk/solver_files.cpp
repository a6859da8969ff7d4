// SPDX-License-Identifier: BSD-3-Clause
// Files of solvers, read by VTK's readers: all cell and point arrays, one time step. OpenFOAM is in openfoam_file.cpp.
#include <fmt/format.h>
#include <vtkAVSucdReader.h>
#include <vtkCGNSReader.h>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkEnSightReader.h>
#include <vtkFLUENTReader.h>
#include <vtkGAMBITReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "readers/common/hdf5_references.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/cgns_zones.hpp"
#include "readers/vtk/ensight_case.hpp"
#include "readers/vtk/ensight_step.hpp"
#include "readers/vtk/ensight_values.hpp"
#include "readers/vtk/linear_only.hpp"
#include "readers/vtk/odd_numbers.hpp"
#include "readers/vtk/time_steps.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Reads with a prepared reader. `choose` enables the file's arrays once they are known. If the reader supports shares
/// of a file, reads the request's `part` of `parts`, which may be empty. `correct` corrects errors of the reader in the
/// result.
template <class Reader, class Choose>
io::ForeignContents read_by(Holdings& holdings, Reader& reader, const std::filesystem::path& file,
                            const nlohmann::json& request, const char* format, const Choose& choose,
                            const std::function<void(vtkDataObject&)>& correct = nullptr) {
  const std::string source = file.string();
  io::ForeignContents contents;
  contents.format = format;
  const std::string warning = with_quiet_vtk(source, write_again, [&] {
    reader.UpdateInformation();
    choose();
    update_at_step(reader, request, source, contents.time_step);
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  vtkDataObject* const data = reader.GetOutputDataObject(0);
  if (data == nullptr) throw scene::bad_input(fmt::format("{}: nothing can be read; write the file again", source));
  if (correct) correct(*data);
  contents.parts = parts_of(holdings, *data, source);
  if (contents.parts.empty() && request.value("parts", 1) == 1)
    throw scene::bad_input(fmt::format("{}: it holds no cells; check how it was written", source));
  return contents;
}

/// The first error of a Fluent reader. Errors about missing values are ignored: a case without values is still a mesh.
class FluentErrors : public vtkCommand {
 public:
  static FluentErrors* New() { return new FluentErrors; }
  void Execute(vtkObject*, unsigned long, void* words) override {
    const std::string_view text = words != nullptr ? static_cast<const char*>(words) : "";
    if (!first.empty() || text.find("Could not open data file") != std::string_view::npos) return;
    first = words_for_users(text);
    if (first.empty()) first = "VTK's reader fails on it";
  }

  std::string first;
};

/// Returns the file of values next to the case, with the name for which VTK searches.
std::filesystem::path fluent_values_of(const std::filesystem::path& file) {
  std::string name = file.string();
  name.replace(name.size() - std::min<std::size_t>(name.size(), 3), std::string::npos, "dat");
  return name;
}

/// Returns the text of a .dat file with a blank added at the end of each list of values in text form; no value if all
/// lists end with a blank. Needed because VTK's reader treats the last character before the parenthesis as a blank.
std::string spaced_fluent_values(std::string_view text) {
  constexpr std::string_view binary_end = "End of Binary Section";
  std::string spaced;
  std::size_t copied = 0;
  for (std::size_t at = text.find('('); at != std::string_view::npos; at = text.find('(', at)) {
    const std::size_t blank = std::min(text.find_first_of(" (", at + 1), text.size());
    const std::string_view index = text.substr(at + 1, blank - at - 1);
    if (index.size() > 3) {  // the condition by which the reader identifies binary sections
      const std::size_t end = text.find(binary_end, at);
      if (end == std::string_view::npos) break;
      at = end + binary_end.size();
      continue;
    }
    std::size_t values_end = 0;
    for (std::size_t depth = 0; at < text.size(); ++at) {
      if (text[at] == '(') ++depth;
      if (text[at] == ')' && depth == 2) values_end = at;
      if (text[at] == ')' && --depth == 0) break;
    }
    if (index == "300" && at < text.size() && !is_blank(text[values_end - 1])) {
      spaced.append(text.substr(copied, values_end - copied)).append(" ");
      copied = values_end;
    }
  }
  return copied == 0 ? std::string() : spaced.append(text.substr(copied));
}

class FluentReader : public vtkFLUENTReader {
 public:
  static FluentReader* New() { VTK_STANDARD_NEW_BODY(FluentReader); }

 protected:
  bool OpenDataFile(const char* file) override {
    std::error_code unknown;  // not set for a pipe of that name, which would block the reader
    if (!std::filesystem::is_regular_file(fluent_values_of(file), unknown)) return false;
    if (!vtkFLUENTReader::OpenDataFile(file)) return false;
    std::string spaced = spaced_fluent_values(io::WholeFile(fluent_values_of(file)).text());
    if (spaced.empty()) return true;
    delete FluentDataFile;
    FluentDataFile = new std::istringstream(std::move(spaced));
    return true;
  }
};

/// The sections of a Fluent file that precede its first binary section.
struct FluentSections {
  int dimensions = 3;
  std::string untyped;  ///< zone of the first section of cells that does not state their type, as a hexadecimal number
};

FluentSections fluent_sections(const std::filesystem::path& file) {
  constexpr std::size_t most = 1 << 20;
  const std::string text = io::read_beginning(file, most);
  FluentSections found;
  for (std::size_t at = 0, depth = 0; at < text.size(); ++at) {
    if (text[at] == '"') {
      at = std::min(text.find('"', at + 1), text.size());
    } else if (text[at] == ')') {
      depth -= depth > 0 ? 1 : 0;
    } else if (text[at] == '(' && depth++ == 0) {
      std::string words = text.substr(at + 1, 200);
      std::replace(words.begin(), words.end(), '(', ' ');
      std::istringstream section(words.substr(0, words.find(')')));
      int kind = 0;
      if (!(section >> kind)) continue;
      if (kind >= 2000) break;
      if (kind == 2) section >> found.dimensions;
      std::vector<std::string> rest;
      for (std::string word; section >> word;) rest.push_back(word);
      if (kind == 12 && rest.size() == 4 && rest[0] != "0" && found.untyped.empty()) found.untyped = rest[0];
    }
  }
  return found;
}

/// Throws for a two-dimensional mesh, and for a section of cells that does not state their type, which VTK's reader
/// would leave uninitialized.
void require_solid_cells(const std::filesystem::path& file) {
  const FluentSections sections = fluent_sections(file);
  if (sections.dimensions == 2)
    throw scene::bad_input(fmt::format(
        "{}: it is a two-dimensional Fluent mesh, which has no volume to render; give a three-dimensional mesh",
        file.string()));
  if (!sections.untyped.empty())
    throw scene::bad_input(
        fmt::format("{}: the section of cells of zone {} does not state the types of its cells; export CGNS or "
                    "EnSight, or the case again",
                    file.string(), sections.untyped));
}

/// Corrects the order of corners. GAMBIT numbers the corners of a quadrangle row by row, also in bricks and pyramids:
/// (0, 0), (1, 0), (0, 1), (1, 1). VTK's reader treats them as listed around the quadrangle, which makes
/// self-intersecting cells. Some programs do list them around it, so the order with fewer self-intersecting cells is
/// used.
void order_gambit_corners(vtkDataObject& data) {
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(&data);
  if (grid == nullptr || grid->GetPoints() == nullptr) return;
  const vtkNew<vtkIdList> corners;
  std::vector<vtkIdType> with_quadrangles;
  std::int64_t crossed = 0;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
    if (const int type = grid->GetCellType(cell); type != VTK_HEXAHEDRON && type != VTK_PYRAMID) continue;
    grid->GetCellPoints(cell, corners);
    std::array<glm::dvec3, 4> p;
    const vtkIdType* const ids = corners->GetPointer(0);
    const auto is_there = [&](vtkIdType v) { return v >= 0 && v < grid->GetNumberOfPoints(); };
    if (corners->GetNumberOfIds() < 5 || !std::all_of(ids, ids + 4, is_there)) continue;
    for (std::size_t k = 0; k < 4; ++k) grid->GetPoint(ids[k], &p[k].x);
    crossed += glm::dot(p[1] - p[0], p[2] - p[3]) < 0 ? 1 : -1;
    with_quadrangles.push_back(cell);
  }
  if (crossed <= 0) return;
  for (const vtkIdType cell : with_quadrangles) {
    grid->GetCellPoints(cell, corners);
    for (vtkIdType first = 0; first + 4 <= corners->GetNumberOfIds(); first += 4)
      std::swap(*corners->GetPointer(first + 2), *corners->GetPointer(first + 3));
    grid->GetCells()->ReplaceCellAtId(cell, corners);
  }
}

/// Returns the case files that a master file for several servers lists, each with a part of the mesh; or the file
/// itself.
std::vector<std::filesystem::path> ensight_cases(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::vector<std::filesystem::path> cases;
  bool is_master = false;
  for (std::string line; std::getline(text, line) && cases.size() < 65536;) {
    std::istringstream words(line);
    std::string key, value;
    words >> key >> value;
    if (key == "type:" && value == "master_server") is_master = true;
    if (is_master && key == "casefile:" && !value.empty()) cases.push_back(file.parent_path() / value);
  }
  if (!is_master) return {file};
  if (cases.empty())
    throw scene::bad_input(
        fmt::format("{}: it is a list of EnSight's servers without a `casefile:`; {}", file.string(), write_again));
  return cases;
}

/// Whether a requested field ("point:NAME", "NAME:0", ...) names this variable.
bool asks_for(std::string_view field, const std::string& name) {
  for (const std::string_view side : {"point:", "cell:"})
    if (field.starts_with(side)) field.remove_prefix(side.size());
  return field == name || (field.starts_with(name) && field.substr(name.size()).starts_with(':'));
}

/// Disables variables that have no file at the requested step. Throws if the geometry or the requested field is
/// missing.
void leave_out_missing(vtkGenericEnSightReader& reader, const EnsightCase& described, double time,
                       const std::string& source, const nlohmann::json& request, std::vector<std::string>& notes) {
  for (const EnsightCase::Missing& gone : described.missing(time)) {
    if (gone.variable.empty())
      throw scene::bad_input(
          fmt::format("{}: it names {}, but there is no such file; put it there", source, gone.file));
    if (asks_for(request.value("field", ""), gone.variable))
      throw scene::bad_input(
          fmt::format("{}: {} of the requested time step is in {}, but there is no such file; put it there, or choose "
                      "another `field` or `time_step`",
                      source, gone.variable, gone.file));
    gone.of_points ? reader.SetPointArrayStatus(gone.variable.c_str(), 0)
                   : reader.SetCellArrayStatus(gone.variable.c_str(), 0);
    notes.push_back(
        fmt::format("{} is left out: its file {}, which the case names, is missing", gone.variable, gone.file));
  }
}

struct CutFile {
  EnsightCase::Values values;
  std::string place;
};

/// Returns the variables whose files end too early. For text files, VTK's reader fills the missing values with zeros;
/// for other files, it fails without naming the file.
std::vector<CutFile> cut_files(vtkGenericEnSightReader& reader, const std::vector<EnsightCase::Values>& variables,
                               vtkDataObject& data, std::vector<std::string>& notes) {
  std::vector<CutFile> found;
  for (const EnsightCase::Values& values : variables) {
    EnsightValues in_file = values_in(reader, data, values);
    if (!in_file.absent.empty())
      notes.push_back(fmt::format("{} is blank in {} of the case's parts, such as {}: {} has no values for them",
                                  values.variable, in_file.absent.size(), quote(in_file.absent.front()),
                                  values.file_name));
    if (!in_file.end.empty()) found.push_back({values, std::move(in_file.end)});
  }
  return found;
}

std::string note_on(const CutFile& cut) {
  return fmt::format("{} is left out: {} is truncated, it ends {}", cut.values.variable, cut.values.file_name,
                     cut.place);
}

void require_not_asked_for(const std::vector<CutFile>& cut, const std::filesystem::path& file,
                           const nlohmann::json& request) {
  for (const CutFile& each : cut)
    if (asks_for(request.value("field", ""), each.values.variable))
      throw scene::bad_input(
          fmt::format("{}: {} of the requested time step is in {}, which ends {}; copy it there again, or choose "
                      "another `field` or `time_step`",
                      file.string(), each.values.variable, each.values.file_name, each.place));
}

/// Selects the requested step of a case with file sets.
scene::TimeStepRead step_in_file_sets(const EnsightCase& described, nlohmann::json& request,
                                      const std::string& source) {
  std::optional<std::size_t> requested;
  if (request.contains("time_step")) requested = request["time_step"].get<std::size_t>();
  request.erase("time_step");
  std::vector<double> times = described.times();
  scene::TimeStepRead read = scene::chosen_step(requested, times.size(), source);
  scene::set_times(read, std::move(times));
  return read;
}

io::ForeignContents read_case(Holdings& holdings, const std::filesystem::path& file, nlohmann::json request) {
  const std::string source = file.string();
  const EnsightCase described(file);
  described.require_regular_files(source);
  std::optional<scene::TimeStepRead> step;
  std::optional<EnsightStep> apart;
  double time = 0;
  if (described.has_file_sets()) {
    step = step_in_file_sets(described, request, source);
    if (step->step < step->times.size()) time = step->times[step->step];
    apart.emplace(described, time);
  }
  const std::string case_file = apart ? apart->case_file().string() : source;
  std::vector<std::string> notes, blank;
  std::vector<EnsightCase::Values> variables;
  std::vector<CutFile> cut;
  const auto read = [&](bool has_variables) {
    const vtkNew<vtkGenericEnSightReader> reader;
    reader->SetCaseFileName(case_file.c_str());
    reader->ReadAllVariablesOn();
    const auto leave_out = [&](const EnsightCase::Values& values) {
      values.of_points ? reader->SetPointArrayStatus(values.variable.c_str(), 0)
                       : reader->SetCellArrayStatus(values.variable.c_str(), 0);
    };
    const auto choose = [&] {
      notes.clear();
      if (!apart) time = asked_time(*reader, request, source);
      leave_out_missing(*reader, described, time, source, request, notes);
      variables = apart ? apart->values() : described.values(time);
      for (const CutFile& each : cut) leave_out(each.values);
      for (const EnsightCase::Values& values : variables)
        if (ends_with_part(values)) leave_out(values);
      if (has_variables) return;
      reader->GetPointDataArraySelection()->DisableAllArrays();
      reader->GetCellDataArraySelection()->DisableAllArrays();
    };
    return read_by(holdings, *reader, file, request, "EnSight", choose, [&](vtkDataObject& data) {
      blank.clear();
      std::vector<CutFile> found = cut_files(*reader, variables, data, blank);
      if (cut.empty()) cut = std::move(found);
      for (const CutFile& each : cut) remove_values(data, each.values);
    });
  };
  io::ForeignContents contents;
  try {
    contents = read(true);
  } catch (const scene::Error&) {  // perhaps a binary file ends early; reading without variables shows which file
    try {
      read(false);
    } catch (const scene::Error&) {
      cut.clear();
    }
    if (cut.empty()) throw;
    require_not_asked_for(cut, file, request);
    contents = read(true);
  }
  require_not_asked_for(cut, file, request);
  if (step) contents.time_step = *step;
  std::move(notes.begin(), notes.end(), std::back_inserter(contents.notes));
  std::move(blank.begin(), blank.end(), std::back_inserter(contents.notes));
  std::ranges::transform(cut, std::back_inserter(contents.notes), note_on);
  return contents;
}

}  // namespace

io::ForeignContents read_ensight(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
  const std::vector<std::filesystem::path> cases = ensight_cases(file);
  io::ForeignContents contents;
  for (const std::filesystem::path& each : cases) {
    if (!std::filesystem::is_regular_file(each))
      throw scene::bad_input(fmt::format("{}: it lists {}, but there is no such file; put it there", file.string(),
                                         each.filename().string()));
    io::ForeignContents some = read_case(holdings, each, request);
    if (std::string note = note_on_ensight6(each); !note.empty()) some.notes.push_back(std::move(note));
    if (cases.size() > 1)
      for (io::ForeignPart& part : some.parts)
        part.name = each.stem().string() + (part.name.empty() ? "" : "/" + part.name);
    if (&each == &cases.front()) {
      contents = std::move(some);
      continue;
    }
    std::move(some.parts.begin(), some.parts.end(), std::back_inserter(contents.parts));
    std::move(some.notes.begin(), some.notes.end(), std::back_inserter(contents.notes));
  }
  return contents;
}

io::ForeignContents read_cgns(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  if (io::read_beginning(file, 8).starts_with("\x89HDF"))  // often links to files of other directories
    require_sound_references(file, ReferencesMay::point_anywhere);
  if (auto contents = read_cgns_zones(holdings, file, request)) return std::move(*contents);
  vtkNew<vtkCGNSReader> reader;
  reader->SetFileName(file.c_str());
  return read_by(holdings, *reader, file, request, "CGNS", [&] {
    reader->EnableAllBases();
    reader->EnableAllPointArrays();
    reader->EnableAllCellArrays();
  });
}

io::ForeignContents read_avs_ucd(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  OddNumbers odd(file);
  const vtkNew<vtkAVSucdReader> reader;
  reader->SetFileName(odd.file_name().c_str());
  return read_by(
      holdings, *reader, file, request, "AVS UCD", [] {}, [&](vtkDataObject& data) { odd.restore(&data); });
}

io::ForeignContents read_fluent(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  require_solid_cells(file);
  std::error_code unknown;
  const bool has_data = std::filesystem::is_regular_file(fluent_values_of(file), unknown);
  has_data ? allow_for_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."))
           : allow_for(file);
  vtkNew<FluentReader> reader;
  vtkNew<FluentErrors> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->SetFileName(file.c_str());
  io::ForeignContents contents;
  try {
    contents = read_by(holdings, *reader, file, request, "Fluent", [&] { reader->EnableAllCellArrays(); });
  } catch (const scene::Error&) {  // usually memory runs out, because the reader does not check for the end of a file
    throw scene::bad_input(fmt::format("{}: VTK's reader cannot read it; export CGNS or EnSight", file.string()));
  }
  if (!errors->first.empty()) throw error_of_vtk(file.string(), errors->first, write_again);
  std::erase_if(contents.notes,
                [](const std::string& note) { return note.find("open dat file") != std::string::npos; });
  if (!has_data) contents.notes.emplace_back("there is no .dat file next to the case, so it has no field");
  return contents;
}

io::ForeignContents read_gambit(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  require_linear_gambit(file);
  const vtkNew<vtkGAMBITReader> reader;
  reader->SetFileName(file.c_str());
  return read_by(
      holdings, *reader, file, request, "GAMBIT", [] {}, order_gambit_corners);
}

}  // namespace tessera::readers
