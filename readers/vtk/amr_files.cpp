// SPDX-License-Identifier: BSD-3-Clause
// Blocks of several refinement levels written by simulations, read by VTK's readers.
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <vtkAMREnzoReader.h>
#include <vtkAMRFlashReader.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkOverlappingAMR.h>
#include <vtkUniformGrid.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "readers/common/readers.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Records failures of HDF5's functions during the lifetime of this object, because VTK's readers ignore them. While
/// the readers only test whether something exists, they disable the recording.
///
/// Uses the older of HDF5's interfaces, through which VTK saves and restores the handler.
class Hdf5Failures {
 public:
  Hdf5Failures() { H5Eset_auto1(note, &count_); }
  ~Hdf5Failures() { H5Eset_auto1(nullptr, nullptr); }
  Hdf5Failures(const Hdf5Failures&) = delete;
  Hdf5Failures& operator=(const Hdf5Failures&) = delete;

  [[nodiscard]] bool any() const { return count_ > 0; }

 private:
  static herr_t note(void* count) {
    ++*static_cast<std::size_t*>(count);
    return 0;
  }
  std::size_t count_ = 0;
};

/// Makes a reader read all levels, all blocks and all cell data.
template <class Reader>
io::ForeignContents read_blocks(Holdings& holdings, Reader& reader, const std::string& source) {
  io::ForeignContents contents;
  contents.has_levels = true;
  const Hdf5Failures failures;
  const std::string warning = with_quiet_vtk(
      source, write_again,
      [&] {
        reader.SetMaxLevel(1 << 20);
        reader.SetFileName(source.c_str());
        reader.UpdateInformation();
        for (int k = 0; k < reader.GetNumberOfCellArrays(); ++k)
          reader.SetCellArrayStatus(reader.GetCellArrayName(k), 1);
        reader.Update();
        auto* const blocks = vtkOverlappingAMR::SafeDownCast(reader.GetOutputDataObject(0));
        if (blocks == nullptr) return;
        for (unsigned level = 0; level < blocks->GetNumberOfLevels(); ++level)
          for (unsigned b = 0; b < blocks->GetNumberOfDataSets(level); ++b) {
            vtkUniformGrid* const block = blocks->GetDataSet(level, b);
            const std::string name = fmt::format("level {} block {}", level, b);
            if (block == nullptr)
              throw scene::bad_input(fmt::format("{}: {} cannot be read; {}", source, name, write_again));
            // The array that marks covered cells is removed, because VTK assumes that blocks nest. Which cells are
            // covered is computed again.
            block->GetCellData()->RemoveArray("vtkGhostType");
            std::vector<io::ForeignPart> parts = parts_of(holdings, *block, source);
            for (io::ForeignPart& part : parts) {
              part.name = name;
              contents.parts.push_back(std::move(part));
            }
          }
      },
      {"Inconsistent spacing", "tracer particles", "data does not exist in file"});
  if (failures.any())
    throw scene::bad_input(fmt::format("{}: HDF5 cannot read all files that belong to it; {}", source, write_again));
  // Warnings of these readers mean a damaged file, except for spacings whose last bits differ from block to block,
  // particles, and fields that some blocks do not have.
  if (!warning.empty()) throw scene::bad_input(fmt::format("{}: {}; {}", source, warning, write_again));
  if (contents.parts.empty()) throw scene::bad_input(fmt::format("{}: it holds no blocks; {}", source, write_again));
  return contents;
}

/// Whether a line names the grid that follows one of the earlier grids: Pointer: Grid[1]->NextGridThisLevel = 2.
bool is_pointer(const std::string& line, std::size_t grids) {
  unsigned grid = 0, next = 0;
  int end = 0;
  for (const char* form :
       {"Pointer: Grid[%9u]->NextGridThisLevel = %9u %n", "Pointer: Grid[%9u]->NextGridNextLevel = %9u %n"})
    if (std::sscanf(line.c_str(), form, &grid, &next, &end) == 2 && static_cast<std::size_t>(end) == line.size() &&
        grid >= 1 && grid <= grids)
      return true;
  return false;
}

/// Whether a line consists of KEY = and three numbers, or one word.
bool has_values(const std::string& line, bool three_numbers) {
  std::istringstream words(line);
  std::string key, equals, value;
  words >> key >> equals;
  if (equals != "=") return false;
  if (!three_numbers) return static_cast<bool>(words >> value);
  std::array<double, 3> numbers{};
  return static_cast<bool>(words >> numbers[0] >> numbers[1] >> numbers[2]);
}

/// Throws if a grid is incomplete. VTK's reader would search without end for anything that a grid lacks.
void require_grids(const std::filesystem::path& hierarchy) {
  constexpr std::array keys{"Grid",          "GridStartIndex", "GridEndIndex",     "GridLeftEdge",
                            "GridRightEdge", "BaryonFileName", "NumberOfParticles"};
  std::ifstream file(hierarchy);
  std::size_t grids = 0, next = 0, number = 0;
  const auto refuse = [&](const std::string& what) {
    return scene::bad_input(fmt::format("{}: line {}: {}; {}", hierarchy.string(), number, what, write_again));
  };
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string key = line.substr(0, line.find(' '));
    if (key == "Pointer:" && !is_pointer(line, grids)) throw refuse("it does not state which grid comes next");
    const auto* const known = std::find(keys.begin(), keys.end(), key);
    if (known == keys.end()) continue;
    if (*known != keys[next]) throw refuse(fmt::format("it has {} where {} is required", key, keys[next]));
    if (!has_values(line, next >= 1 && next <= 4)) throw refuse(fmt::format("{} has no values", key));
    if (next == 0) ++grids;
    next = (next + 1) % keys.size();
  }
  if (grids == 0 || next != 0)
    throw refuse(fmt::format("the file ends after {} grids where {} is required", grids, keys[next]));
}

}  // namespace

io::ForeignContents read_flash(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json&) {
  allow_for(file);
  const vtkNew<vtkAMRFlashReader> reader;
  io::ForeignContents contents = read_blocks(holdings, *reader, file.string());
  contents.format = "FLASH";
  return contents;
}

io::ForeignContents read_enzo(Holdings& holdings, const std::filesystem::path& named, const nlohmann::json&) {
  std::filesystem::path file = named;
  if (file.extension() == ".boundary") file.replace_extension(".hierarchy");
  if (file.extension() != ".hierarchy")
    throw scene::bad_input(
        fmt::format("{}: the name of an Enzo data set has to end with .hierarchy; rename it", named.string()));
  std::filesystem::path parameters = file;
  parameters.replace_extension();
  for (const std::filesystem::path& needed : {file, parameters})
    if (std::error_code unknown; !std::filesystem::is_regular_file(needed, unknown))
      throw scene::bad_input(fmt::format("{}: {}, which belongs to it, does not exist; put that file next to it",
                                         named.string(), needed.filename().string()));
  allow_for_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."), true);
  require_grids(file);
  // The limit of open files is raised, because VTK's reader never closes the files that it opens.
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) == 0) {
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
  }
  const vtkNew<vtkAMREnzoReader> reader;
  reader->SetConvertToCGS(0);  // unconverted; the reader confuses the factors of ten fields or more
  io::ForeignContents contents = read_blocks(holdings, *reader, file.string());
  contents.format = "Enzo";
  return contents;
}

}  // namespace tessera::readers
