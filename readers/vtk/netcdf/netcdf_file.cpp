// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/netcdf/netcdf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/files/input_file.hpp"
#include "readers/vtk/netcdf/netcdf_size.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

bool is_number(nc_type type) { return type != NC_NAT && type != NC_CHAR && type <= NC_UINT64; }

}  // namespace

NetcdfFile::NetcdfFile(const std::filesystem::path& file) : source_(file.string()) {
  if (nc_open(file.c_str(), NC_NOWRITE, &id_) != NC_NOERR)
    throw scene::bad_input(
        fmt::format("{}: it begins like a NetCDF file, but cannot be opened; {}", source_, write_again));
  try {
    const std::uint64_t least = least_netcdf_bytes(id_), size = io::require_file(file);
    if (size < least)
      throw scene::bad_input(
          fmt::format("{}: it has {} bytes, but needs at least {}; {}", source_, size, least, write_again));
    add_variables(id_, "", 0);
  } catch (...) {
    nc_close(id_);
    throw;
  }
}

void NetcdfFile::add_variables(int group, const std::string& path, int depth) {
  int count = 0;
  nc_inq_nvars(group, &count);
  for (int v = 0; v < count; ++v) {
    NetcdfVariable variable{.group = group, .id = v, .name = {}, .path = {}, .dimensions = {}};
    std::array<char, NC_MAX_NAME + 1> name{};
    int dimensions = 0;
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    if (nc_inq_var(group, v, name.data(), &variable.type, &dimensions, ids.data(), nullptr) != NC_NOERR ||
        !is_number(variable.type))
      continue;
    variable.name = name.data();
    variable.path = path + variable.name;
    bool are_known = true;
    for (int d = 0; d < dimensions; ++d) {
      NetcdfDimension dimension{.id = ids[static_cast<std::size_t>(d)], .name = {}};
      are_known = are_known && nc_inq_dim(group, dimension.id, name.data(), &dimension.length) == NC_NOERR;
      dimension.name = name.data();
      variable.dimensions.push_back(std::move(dimension));
    }
    if (are_known) variables_.push_back(std::move(variable));
  }
  constexpr int deepest = 32;
  int groups = 0;
  if (depth >= deepest || nc_inq_grps(group, &groups, nullptr) != NC_NOERR || groups <= 0) return;
  std::vector<int> ids(static_cast<std::size_t>(groups));
  if (nc_inq_grps(group, &groups, ids.data()) != NC_NOERR) return;
  for (const int id : ids) {
    std::array<char, NC_MAX_NAME + 1> name{};
    if (nc_inq_grpname(id, name.data()) == NC_NOERR) add_variables(id, path + name.data() + "/", depth + 1);
  }
}

const NetcdfVariable* NetcdfFile::find(const NetcdfVariable& from, const std::string& name) const {
  for (int group = from.group;;) {
    const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const NetcdfVariable& variable) {
      return variable.group == group && variable.name == name;
    });
    if (found != variables_.end()) return &*found;
    if (nc_inq_grp_parent(group, &group) != NC_NOERR) return nullptr;
  }
}

nc_type NetcdfFile::attribute_type(const NetcdfVariable& of, const char* attribute) const {
  nc_type type = NC_NAT;
  return nc_inq_atttype(of.group, of.id, attribute, &type) == NC_NOERR ? type : NC_NAT;
}

std::vector<double> NetcdfFile::numbers(const NetcdfVariable& of, const char* attribute) const {
  nc_type type = NC_NAT;
  std::size_t count = 0;
  constexpr std::size_t most = 1000;
  if (nc_inq_att(of.group, of.id, attribute, &type, &count) != NC_NOERR || !is_number(type) || count > most) return {};
  std::vector<double> values(count);
  if (nc_get_att_double(of.group, of.id, attribute, values.data()) != NC_NOERR) values.clear();
  return values;
}

std::string NetcdfFile::text(const NetcdfVariable& of, const char* attribute) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  constexpr std::size_t most = 1000;
  if (nc_inq_att(of.group, of.id, attribute, &type, &length) != NC_NOERR || length > most) return "";
  std::string value;
  if (type == NC_CHAR) {
    value.resize(length);
    if (nc_get_att_text(of.group, of.id, attribute, value.data()) != NC_NOERR) return "";
  } else if (type == NC_STRING && length == 1) {
    char* string = nullptr;
    if (nc_get_att_string(of.group, of.id, attribute, &string) != NC_NOERR) return "";
    if (string != nullptr) value.assign(string, std::min(std::char_traits<char>::length(string), most));
    nc_free_string(1, &string);
  }
  return value.substr(0, value.find('\0'));
}

}  // namespace tessera::readers
