// HDF5 says nothing at its beginning of what is in it.
#include <fmt/format.h>
#include <hdf5.h>
#include <vtk_netcdf.h>

#include <nlohmann/json.hpp>

#include "io/helper/readers.hpp"
#include "io/inflated_file.hpp"
#include "scene/error.hpp"
#include "scene/quote.hpp"

namespace tessera::io::helper {
namespace {

/// An open file of the library's, closed with this.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
    id_ = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  }
  ~Hdf5File() {
    if (is_open()) H5Fclose(id_);
  }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  [[nodiscard]] bool is_open() const { return id_ >= 0; }
  [[nodiscard]] bool has(const char* name) const { return H5Lexists(id_, name, H5P_DEFAULT) > 0; }
  [[nodiscard]] bool has_attribute(const char* name) const { return H5Aexists(id_, name) > 0; }

  /// The text of a group's attribute; empty if it has none of a fixed length.
  [[nodiscard]] std::string text_of(const char* group, const char* name) const {
    const hid_t attribute = H5Aopen_by_name(id_, group, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return "";
    const hid_t type = H5Aget_type(attribute);
    std::string text;
    constexpr std::size_t most = 256;
    if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= most &&
        H5Aget_storage_size(attribute) <= most) {
      text.resize(most);
      if (H5Aread(attribute, type, text.data()) < 0) text.clear();
    }
    H5Tclose(type);
    H5Aclose(attribute);
    return text.substr(0, text.find('\0'));
  }

  /// A group's attribute that is one number, or `otherwise`.
  [[nodiscard]] long number_of(const char* group, const char* name, long otherwise) const {
    const hid_t attribute = H5Aopen_by_name(id_, group, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return otherwise;
    const hid_t space = H5Aget_space(attribute);
    long number = otherwise;
    if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, H5T_NATIVE_LONG, &number) < 0)
      number = otherwise;
    H5Sclose(space);
    H5Aclose(attribute);
    return number;
  }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// NetCDF-4, or other HDF5 that its library takes for such.
bool opens_as_netcdf(const std::filesystem::path& file) {
  int id = 0;
  if (nc_open(file.c_str(), NC_NOWRITE, &id) != NC_NOERR) return false;
  nc_close(id);
  return true;
}

}  // namespace

ForeignContents read_hdf5(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  require_real_name(file);
  allow_for(file);
  std::string vtk_type;
  bool has_steps = false;
  enum class Kind { unknown, vtk, cgns, exodus, flash, fluent, minc, med } kind = Kind::unknown;
  {
    const Hdf5File opened(file);
    if (!opened.is_open())
      throw scene::bad_input(fmt::format(
          "{}: it begins as HDF5 and cannot be opened; it is truncated or damaged, write it anew", file.string()));
    if (opened.has("VTKHDF")) {
      kind = Kind::vtk;
      vtk_type = opened.text_of("VTKHDF", "Type");
      has_steps = opened.has("VTKHDF/Steps") && opened.number_of("VTKHDF/Steps", "NSteps", 2) != 1;
    } else if (opened.has("CGNSLibraryVersion"))
      kind = Kind::cgns;
    else if (opened.has_attribute("floating_point_word_size") || opened.has("num_nodes"))
      kind = Kind::exodus;
    else if (opened.has("gid") && opened.has("refine level") && opened.has("bounding box"))
      kind = Kind::flash;
    else if (opened.has("meshes") && opened.has("settings"))
      kind = Kind::fluent;
    else if (opened.has("minc-2.0"))
      kind = Kind::minc;
    else if (opened.has("ENS_MAA"))
      kind = Kind::med;
  }
  const auto refuse = [&](const char* what, const char* remedy) {
    return scene::bad_input(fmt::format("{}: it is HDF5 and holds {}; {}", file.string(), what, remedy));
  };
  if (request.value("look", false) && kind != Kind::unknown && kind != Kind::minc) return {};  // no grid
  if (kind != Kind::cgns && request.value("part", 0) > 0) return {};                           // the first share is all
  switch (kind) {
    case Kind::vtk:
      if (!vtk_type.empty() && vtk_type != "UnstructuredGrid" && vtk_type != "ImageData")
        throw refuse(fmt::format("VTKHDF of the type {}, which VTK 9.1 does not read", scene::quote(vtk_type)).c_str(),
                     "save it as .vtu, .vtm or .vtp in ParaView");
      if (has_steps)  // it would take them for pieces of one mesh
        throw refuse("VTKHDF with time steps, which VTK 9.1 does not know", "save its steps as .pvd in ParaView");
      return read_vtk_hdf(holdings, file, request);
    case Kind::cgns:
      return read_cgns(holdings, file, request);
    case Kind::exodus:
      return read_exodus(holdings, file, request);
    case Kind::flash:
      return read_flash(holdings, file, request);
    case Kind::fluent:
      throw refuse("a Fluent case, which is read as text only", "export CGNS, EnSight or a .cas without HDF5");
    case Kind::minc:
      return read_minc2(holdings, file, request);
    case Kind::med:
      throw refuse("a MED mesh, which is known by its name alone", "have that end in .med");
    case Kind::unknown:
      break;
  }
  if (!opens_as_netcdf(file))
    throw refuse("neither Exodus nor CGNS nor FLASH nor VTKHDF nor NetCDF",
                 "have the program that wrote it write another format");
  return read_netcdf(holdings, file, request);
}

}  // namespace tessera::io::helper
