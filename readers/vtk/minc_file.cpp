// SPDX-License-Identifier: BSD-3-Clause
// MINC 1, which is NetCDF, read by VTK's reader.
#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkMINCImageAttributes.h>
#include <vtkMINCImageReader.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtk_netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "io/files/input_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/netcdf/netcdf_size.hpp"
#include "readers/vtk/vtk_parts.hpp"
#include "readers/vtk/vtk_session.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Throws if a file is truncated. VTK's reader reads zeros beyond the end of the file.
void require_whole(const std::filesystem::path& file) {
  int id = 0;
  if (nc_open(file.c_str(), NC_NOWRITE, &id) != NC_NOERR)
    throw scene::bad_input(
        fmt::format("{}: it begins like a NetCDF file, but cannot be opened; {}", file.string(), write_again));
  const std::uint64_t least = least_netcdf_bytes(id), size = io::require_file(file);
  nc_close(id);
  if (size < least)
    throw scene::bad_input(
        fmt::format("{}: it has {} bytes, but needs at least {}; {}", file.string(), size, least, write_again));
}

/// Returns the times of a file's steps: from the variable `time` if it exists, otherwise from its start and step.
std::vector<double> minc_times(const std::filesystem::path& file, std::size_t count) {
  int id = 0, time = 0, dimensions = 0;
  if (count < 2 || nc_open(file.c_str(), NC_NOWRITE, &id) != NC_NOERR) return {};
  std::vector<double> times;
  if (nc_inq_varid(id, "time", &time) == NC_NOERR && nc_inq_varndims(id, time, &dimensions) == NC_NOERR) {
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    std::size_t length = 0;
    double start = 0, step = 0;
    if (dimensions == 1 && nc_inq_vardimid(id, time, ids.data()) == NC_NOERR &&
        nc_inq_dimlen(id, ids[0], &length) == NC_NOERR && length == count) {
      times.resize(count);
      if (nc_get_var_double(id, time, times.data()) != NC_NOERR) times.clear();
    } else if (dimensions == 0 && nc_get_att_double(id, time, "step", &step) == NC_NOERR) {
      if (nc_get_att_double(id, time, "start", &start) != NC_NOERR) start = 0;
      times = scene::even_times(start, step, count);
    }
  }
  nc_close(id);
  return times;
}

/// Corrects VTK's reader, which ignores attributes that are not doubles, and the sign of bytes.
class MincReader : public vtkMINCImageReader {
 public:
  static MincReader* New() { VTK_STANDARD_NEW_BODY(MincReader); }

 protected:
  int ReadMINCFileAttributes() override {
    int id = 0, image = 0;
    if (vtkMINCImageReader::ReadMINCFileAttributes() == 0) return 0;
    if (nc_open(GetFileName(), NC_NOWRITE, &id) != NC_NOERR) return 0;
    if (nc_inq_varid(id, "image", &image) == NC_NOERR) {
      find_sign();
      find_valid_range(id, image);
    }
    for (const int axis : {0, 1, 2}) find_cosines(id, axis);
    nc_close(id);
    return 1;
  }

 private:
  static bool read_attribute(int id, int variable, const char* name, std::span<double> numbers) {
    std::size_t length = 0;
    return nc_inq_attlen(id, variable, name, &length) == NC_NOERR && length == numbers.size() &&
           nc_get_att_double(id, variable, name, numbers.data()) == NC_NOERR;
  }

  void find_sign() {
    const char* const sign = ImageAttributes->GetAttributeValueAsString("image", "signtype");
    if (MINCImageType != NC_BYTE || sign == nullptr || !std::string_view(sign).starts_with("signed")) return;
    MINCImageTypeSigned = 1;
    ImageAttributes->SetDataType(VTK_SIGNED_CHAR);
    ImageAttributes->FindValidRange(ValidRange);
  }

  /// Real values vary from image-min to image-max while samples vary over the valid range.
  void find_valid_range(int id, int image) {
    if (MINCImageType == NC_FLOAT || MINCImageType == NC_DOUBLE) {  // floating-point samples are real values
      for (double* range : {ValidRange, ImageRange}) range[0] = 0, range[1] = 1;
      return;
    }
    std::array<double, 2> range{};
    if (!read_attribute(id, image, "valid_range", range)) return;
    const int bits = MINCImageType == NC_BYTE ? 8 : MINCImageType == NC_SHORT ? 16 : 32;
    for (double& end : range)
      if (end < 0 && MINCImageTypeSigned == 0) end += std::ldexp(1.0, bits);  // classic NetCDF has only signed numbers
    if (range[0] == range[1]) {
      nc_close(id);
      throw scene::bad_input(
          fmt::format("{}: its valid_range is {} to {}; write the file again", GetFileName(), range[0], range[1]));
    }
    ValidRange[0] = std::min(range[0], range[1]), ValidRange[1] = std::max(range[0], range[1]);
  }

  void find_cosines(int id, int axis) {
    constexpr std::array names = {"xspace", "yspace", "zspace"};
    int variable = 0;
    std::array<double, 3> cosines{};
    if (nc_inq_varid(id, names[static_cast<std::size_t>(axis)], &variable) != NC_NOERR ||
        !read_attribute(id, variable, "direction_cosines", cosines))
      return;
    for (int row = 0; row < 3; ++row) DirectionCosines->SetElement(row, axis, cosines[static_cast<std::size_t>(row)]);
  }
};

}  // namespace

io::ForeignContents read_minc(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  require_whole(file);
  const std::string source = file.string();
  io::ForeignContents contents;
  contents.format = "MINC 1";
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  vtkNew<MincReader> reader;
  const std::string warning = with_quiet_vtk(source, write_again, [&] {
    watch_progress(*reader);
    reader->SetFileName(source.c_str());
    reader->RescaleRealValuesOn();
    reader->UpdateInformation();
    const auto steps = static_cast<std::size_t>(std::max(reader->GetNumberOfTimeSteps(), 1));
    contents.time_step = scene::chosen_step(requested, steps, source);
    scene::set_times(contents.time_step, minc_times(file, steps));
    reader->SetTimeStep(static_cast<int>(contents.time_step.step));
    reader->Update();
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  contents.parts = parts_of(holdings, *reader->GetOutput(), source);
  io::ForeignPart& part = contents.parts.front();
  // The reader's origin is along the axes, and the reader does not apply the directions of the axes.
  const vtkMatrix4x4& cosines = *reader->GetDirectionCosines();
  const std::array<double, 3> along = part.origin;
  for (std::size_t row = 0; row < 3; ++row) {
    part.origin[row] = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double cosine = cosines.GetElement(static_cast<int>(row), static_cast<int>(axis));
      part.direction[3 * row + axis] = cosine;
      part.origin[row] += cosine * along[axis];
    }
  }
  return contents;
}

}  // namespace tessera::readers
