// NetCDF grids by VTK's reader of the CF conventions ("NetCDF Climate and Forecast Metadata Conventions").
#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkNetCDFCFReader.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkStructuredGrid.h>
#include <vtk_netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "io/helper/netcdf_size.hpp"
#include "io/helper/readers.hpp"
#include "io/helper/time_steps.hpp"
#include "io/helper/vtk_parts.hpp"
#include "io/helper/vtk_session.hpp"
#include "io/input_file.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

constexpr const char* write_anew = "the file is truncated or damaged, write it anew";

/// An open file, for what VTK's reader does not say of its variables.
class NetcdfFile {
 public:
  explicit NetcdfFile(const std::filesystem::path& file) {
    if (nc_open(file.c_str(), NC_NOWRITE, &id_) != NC_NOERR)
      throw scene::bad_input(
          fmt::format("{}: it begins as NetCDF and cannot be opened; {}", file.string(), write_anew));
    const std::uint64_t least = least_netcdf_bytes(id_), size = require_file(file);
    if (size < least) {
      nc_close(id_);
      throw scene::bad_input(
          fmt::format("{}: it has {} bytes of at least {}; {}", file.string(), size, least, write_anew));
    }
  }
  ~NetcdfFile() { nc_close(id_); }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// Numbers of a variable's attribute; none if it has none, or text.
  [[nodiscard]] std::vector<double> numbers(const char* variable, const char* attribute) const {
    int id = 0;
    nc_type type = NC_NAT;
    std::size_t count = 0;
    constexpr std::size_t most = 1000;
    if (nc_inq_varid(id_, variable, &id) != NC_NOERR || nc_inq_att(id_, id, attribute, &type, &count) != NC_NOERR ||
        type == NC_CHAR || type > NC_UINT64 || count > most)
      return {};
    std::vector<double> values(count);
    if (nc_get_att_double(id_, id, attribute, values.data()) != NC_NOERR) values.clear();
    return values;
  }

  /// A variable's attribute that is text; empty if it has none.
  [[nodiscard]] std::string text(const std::string& variable, const char* attribute) const {
    int id = 0;
    std::size_t length = 0;
    constexpr std::size_t most = 1000;
    nc_type type = NC_NAT;
    if (nc_inq_varid(id_, variable.c_str(), &id) != NC_NOERR ||
        nc_inq_att(id_, id, attribute, &type, &length) != NC_NOERR || type != NC_CHAR || length > most)
      return "";
    std::string value(length, '\0');
    if (nc_get_att_text(id_, id, attribute, value.data()) != NC_NOERR) return "";
    return value.substr(0, value.find('\0'));
  }

  /// All numbers of a variable, of which there have to be `count`; none if it has others.
  [[nodiscard]] std::vector<double> values(const std::string& variable, std::size_t count) const {
    int id = 0, dimensions = 0;
    if (nc_inq_varid(id_, variable.c_str(), &id) != NC_NOERR || nc_inq_varndims(id_, id, &dimensions) != NC_NOERR)
      return {};
    std::vector<int> ids(static_cast<std::size_t>(dimensions));
    double all = nc_inq_vardimid(id_, id, ids.data()) == NC_NOERR ? 1 : 0;
    for (const int dimension : ids) {
      std::size_t length = 0;
      nc_inq_dimlen(id_, dimension, &length);
      all *= static_cast<double>(length);
    }
    std::vector<double> values(count);
    if (all != static_cast<double>(count) || nc_get_var_double(id_, id, values.data()) != NC_NOERR) values.clear();
    return values;
  }

  /// Whether a variable is of bytes with a sign, which NetCDF's are unless an attribute says otherwise.
  [[nodiscard]] bool has_signed_bytes(const char* variable) const {
    int id = 0;
    nc_type type = NC_NAT;
    std::size_t length = 0;
    std::array<char, 8> word{};
    if (nc_inq_varid(id_, variable, &id) != NC_NOERR || nc_inq_vartype(id_, id, &type) != NC_NOERR || type != NC_BYTE)
      return false;
    return nc_inq_attlen(id_, id, "_Unsigned", &length) != NC_NOERR || length >= word.size() ||
           nc_get_att_text(id_, id, "_Unsigned", word.data()) != NC_NOERR || std::string_view(word.data()) != "true";
  }

  /// Whether one of its variables is in degrees of longitude or latitude.
  [[nodiscard]] bool has_degrees() const {
    int count = 0;
    nc_inq_nvars(id_, &count);
    for (int v = 0; v < count; ++v) {
      std::array<char, 64> units{};
      std::size_t length = 0;
      if (nc_inq_attlen(id_, v, "units", &length) != NC_NOERR || length >= units.size() ||
          nc_get_att_text(id_, v, "units", units.data()) != NC_NOERR)
        continue;
      const std::string_view text(units.data());
      if (text.starts_with("degree") && (text.find('E') != std::string_view::npos || text.ends_with("_east") ||
                                         text.find('N') != std::string_view::npos || text.ends_with("_north")))
        return true;
    }
    return false;
  }

 private:
  int id_ = -1;
};

/// VTK's reader, to which a dimension is time by its variable's units alone; others (of WRF's files) have no such
/// variable, and a name.
class GridReader final : public vtkNetCDFCFReader {
 public:
  static GridReader* New() {
    auto* const made = new GridReader;
    made->InitializeObjectBase();
    return made;
  }

 protected:
  int IsTimeDimension(int file, int dimension) override {
    if (vtkNetCDFCFReader::IsTimeDimension(file, dimension) != 0) return 1;
    std::array<char, NC_MAX_NAME + 1> name{};
    if (nc_inq_dimname(file, dimension, name.data()) != NC_NOERR) return 0;
    const std::string_view text(name.data());
    return text == "time" || text == "Time" || text == "TIME" || text == "t" ? 1 : 0;
  }
};

/// Variables of the same dimensions, time aside: one grid.
struct GridOfVariables {
  std::string dimensions;  ///< as VTK writes them, "(lev, lat, lon)"
  std::vector<std::string> names;
};

std::size_t count_of(const std::string& dimensions) {
  return dimensions.find(',') == std::string::npos
             ? (dimensions.size() > 2 ? 1 : 0)
             : static_cast<std::size_t>(std::count(dimensions.begin(), dimensions.end(), ',')) + 1;
}

/// All grids with variables of three dimensions.
std::vector<GridOfVariables> grids_of(vtkNetCDFCFReader& reader) {
  std::vector<GridOfVariables> grids;
  for (int k = 0; k < reader.GetNumberOfVariableArrays(); ++k) {
    const std::string dimensions = reader.GetVariableDimensions()->GetValue(k);
    if (count_of(dimensions) != 3) continue;
    auto grid =
        std::find_if(grids.begin(), grids.end(), [&](const GridOfVariables& g) { return g.dimensions == dimensions; });
    if (grid == grids.end()) grid = grids.insert(grids.end(), {dimensions, {}});
    grid->names.emplace_back(reader.GetVariableArrayName(k));
  }
  return grids;
}

/// Whether a field as it is asked for ("point:NAME", "NAME:0", ...) is this variable.
bool means(std::string_view field, const std::string& name) {
  for (const std::string_view side : {"point:", "cell:"})
    if (field.starts_with(side) && field != name) field.remove_prefix(side.size());
  return field == name || (field.starts_with(name) && field.substr(name.size()).starts_with(':'));
}

/// The grid that has the field; else the one with the most variables, the first of several. A note names the others.
const GridOfVariables& choose_grid(const std::vector<GridOfVariables>& grids, const std::string& field,
                                   std::vector<std::string>& notes) {
  const GridOfVariables* chosen = &grids.front();
  for (const GridOfVariables& grid : grids)
    if (grid.names.size() > chosen->names.size()) chosen = &grid;
  for (const GridOfVariables& grid : grids)
    if (std::any_of(grid.names.begin(), grid.names.end(), [&](const std::string& n) { return means(field, n); }))
      chosen = &grid;
  for (const GridOfVariables& grid : grids)
    if (&grid != chosen)
      notes.push_back(fmt::format("another grid, {}, has {}{}: name one by `field` to have it", grid.dimensions,
                                  grid.names.front(), grid.names.size() > 1 ? ", ..." : ""));
  return *chosen;
}

/// What is to be done with a variable's values as VTK gives them.
struct Mending {
  bool signed_bytes = false;    ///< VTK takes them for unsigned ones
  double scale = 1, shift = 0;  ///< which VTK has applied
  std::vector<double> missing;  ///< as they became; VTK knows the floats that equal _FillValue alone
  [[nodiscard]] bool is_packed() const { return scale != 1 || shift != 0; }
};

Mending mending_of(const NetcdfFile& file, const std::string& name, bool is_float32) {
  const auto first_of = [&](const char* attribute, double otherwise) {
    const std::vector<double> numbers = file.numbers(name.c_str(), attribute);
    return numbers.empty() ? otherwise : numbers.front();
  };
  Mending mending;
  mending.signed_bytes = file.has_signed_bytes(name.c_str());
  mending.scale = first_of("scale_factor", 1), mending.shift = first_of("add_offset", 0);
  mending.missing = file.numbers(name.c_str(), "missing_value");
  const std::vector<double> fill = file.numbers(name.c_str(), "_FillValue");
  mending.missing.insert(mending.missing.end(), fill.begin(), fill.end());
  for (double& value : mending.missing) {
    value = value * mending.scale + mending.shift;
    if (is_float32 && std::abs(value) <= std::numeric_limits<float>::max()) value = static_cast<float>(value);
  }
  return mending;
}

/// Gives bytes their signs back and makes NaN of what the file's attributes say is missing.
void mend_values(const NetcdfFile& file, vtkDataSetAttributes& fields) {
  for (int k = 0; k < fields.GetNumberOfArrays(); ++k) {
    vtkDataArray* const array = fields.GetArray(k);
    if (array == nullptr || array->GetName() == nullptr) continue;
    const std::string name = array->GetName();
    const int type = array->GetDataType();
    const Mending mending = mending_of(file, name, type == VTK_FLOAT);
    if (!mending.signed_bytes && mending.missing.empty()) continue;
    vtkSmartPointer<vtkDataArray> mended = array;
    if (type != VTK_FLOAT && type != VTK_DOUBLE) {
      mended = vtkSmartPointer<vtkDataArray>::Take(
          vtkDataArray::CreateDataArray(array->GetDataTypeSize() <= 2 ? VTK_FLOAT : VTK_DOUBLE));
      mended->DeepCopy(array);
      mended->SetName(name.c_str());
    }
    // Packed numbers are unpacked by now, each by one rounding: half a step tells them apart.
    const double reach = mending.is_packed() ? std::abs(mending.scale) / 2 : 0;
    for (vtkIdType t = 0; t < mended->GetNumberOfTuples(); ++t) {
      double value = mended->GetComponent(t, 0);
      if (mending.signed_bytes && (value - mending.shift) / mending.scale > 127.5) value -= 256 * mending.scale;
      for (const double missing : mending.missing)
        if (std::abs(value - missing) <= reach) value = std::numeric_limits<double>::quiet_NaN();
      mended->SetComponent(t, 0, value);
    }
    if (mended != array) fields.AddArray(mended);  // in place of the one of its name
  }
}

/// Cells of given corners (`bounds`): VTK 9.1 makes the points of their last row wrong. Corners go round a cell, the
/// first two along the grid's first axis. Throws Error(bad_input) where the corners are not to be found.
void mend_last_row(const NetcdfFile& file, vtkStructuredGrid& grid, const std::string& source) {
  std::array<int, 3> points{};
  grid.GetDimensions(points.data());
  const auto columns = static_cast<std::size_t>(points[0]) - 1, rows = static_cast<std::size_t>(points[1]) - 1;
  std::array<std::vector<double>, 2> corners;  // longitude, latitude
  const char* const field = grid.GetCellData()->GetArrayName(0);
  std::istringstream names(field != nullptr ? file.text(field, "coordinates") : "");
  for (std::string name; names >> name;) {
    const std::string units = file.text(name, "units"), bounds = file.text(name, "bounds");
    if (!units.starts_with("degree") || bounds.empty()) continue;
    corners[units.find_first_of("Nn") == std::string::npos ? 0 : 1] = file.values(bounds, columns * rows * 4);
  }
  if (corners[0].empty() || corners[1].empty())
    throw scene::bad_input(fmt::format("{}: the bounds of its cells are not to be found; write it without", source));
  for (int k = 0; k < points[2]; ++k)
    for (std::size_t i = 0; i <= columns; ++i) {
      const std::size_t cell = (rows - 1) * columns + std::min(i, columns - 1),
                        corner = 4 * cell + (i < columns ? 3 : 2);
      const auto point = static_cast<vtkIdType>((static_cast<std::size_t>(k) * (rows + 1) + rows) * (columns + 1) + i);
      std::array<double, 3> place{};
      grid.GetPoints()->GetPoint(point, place.data());
      grid.GetPoints()->SetPoint(point, corners[0][corner], corners[1][corner], place[2]);
    }
}

/// A reader on which the grid is chosen. Rectilinear axes are read as they stand: VTK takes those for even that are so
/// to 1 % of a step.
void prepare(vtkNetCDFCFReader& reader, const std::string& dimensions) {
  reader.SphericalCoordinatesOff();
  reader.ReplaceFillValueWithNanOn();
  reader.SetDimensions(dimensions.c_str());
  reader.UpdateInformation();
  if (vtkImageData::SafeDownCast(reader.GetOutputDataObject(0)) != nullptr) reader.SetOutputTypeToRectilinear();
}

}  // namespace

ForeignContents read_netcdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  const std::string source = file.string();
  const NetcdfFile opened(file);
  const auto reader = vtkSmartPointer<GridReader>::Take(GridReader::New());
  ForeignContents contents;
  contents.format = "NetCDF";
  const bool only_look = request.value("look", false);
  const std::string warning = with_quiet_vtk(source, write_anew, [&] {
    reader->SetFileName(source.c_str());
    if (reader->UpdateMetaData() == 0) return;
    const std::vector<GridOfVariables> grids = grids_of(*reader);
    if (grids.empty())
      throw scene::bad_input(fmt::format(
          "{}: none of its variables has three dimensions (beside time); give a file of a grid in space", source));
    prepare(*reader, choose_grid(grids, request.value("field", ""), contents.notes).dimensions);
    only_look ? reader->UpdateInformation() : update_at_step(*reader, request, source, contents.time_step);
  });
  if (!warning.empty()) contents.notes.push_back("VTK warns: " + warning);
  auto* const data = vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  if (data == nullptr) throw scene::bad_input(fmt::format("{}: nothing can be read; write it anew", source));
  if (!only_look) {
    mend_values(opened, *data->GetPointData());
    mend_values(opened, *data->GetCellData());
    auto* const curvilinear = vtkStructuredGrid::SafeDownCast(data);
    if (curvilinear != nullptr && curvilinear->GetCellData()->GetNumberOfArrays() > 0)
      mend_last_row(opened, *curvilinear, source);
    if (opened.has_degrees())
      contents.notes.emplace_back(
          "longitude and latitude, in degrees, are x and y as they stand, not places on a sphere");
  }
  contents.parts = parts_of(holdings, *data, source);
  return contents;
}

}  // namespace tessera::io::helper
