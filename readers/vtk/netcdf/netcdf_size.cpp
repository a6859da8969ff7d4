// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/netcdf/netcdf_size.hpp"

#include <vtk_netcdf.h>

#include <array>
#include <cstring>
#include <vector>

namespace tessera::readers {
namespace {

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

/// Computes the sizes of parts of a header. A count takes 4 bytes, or 8 bytes in version 5.
class Header {
 public:
  Header(int file, int format)
      : file_(file), count_(format == NC_FORMAT_CDF5 ? 8 : 4), offset_(format == NC_FORMAT_CLASSIC ? 4 : 8) {}

  [[nodiscard]] std::uint64_t name(const char* text) const { return count_ + padded(std::strlen(text)); }
  [[nodiscard]] std::uint64_t list() const { return 4 + count_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t offset() const { return offset_; }

  /// `of` is a variable, or NC_GLOBAL.
  [[nodiscard]] std::uint64_t attributes(int of, int n) const {
    std::uint64_t bytes = list();
    for (int k = 0; k < n; ++k) {
      std::array<char, NC_MAX_NAME + 1> text{};
      nc_type type = 0;
      std::size_t length = 0, size = 0;
      if (nc_inq_attname(file_, of, k, text.data()) != NC_NOERR ||
          nc_inq_att(file_, of, text.data(), &type, &length) != NC_NOERR ||
          nc_inq_type(file_, type, nullptr, &size) != NC_NOERR)
        continue;
      bytes += name(text.data()) + 4 + count_ + padded(length * size);
    }
    return bytes;
  }

 private:
  int file_;
  std::uint64_t count_, offset_;
};

}  // namespace

std::uint64_t least_netcdf_bytes(int file) {
  int format = 0, dimensions = 0, variables = 0, attributes = 0, unlimited = -1;
  if (nc_inq_format(file, &format) != NC_NOERR ||
      (format != NC_FORMAT_CLASSIC && format != NC_FORMAT_64BIT_OFFSET && format != NC_FORMAT_CDF5) ||
      nc_inq(file, &dimensions, &variables, &attributes, &unlimited) != NC_NOERR)
    return 0;
  const Header header(file, format);
  std::uint64_t bytes = 4 + header.count() + header.attributes(NC_GLOBAL, attributes) + 2 * header.list();
  std::array<char, NC_MAX_NAME + 1> text{};
  std::vector<std::size_t> lengths(static_cast<std::size_t>(dimensions), 0);
  for (int d = 0; d < dimensions; ++d)
    if (nc_inq_dim(file, d, text.data(), &lengths[static_cast<std::size_t>(d)]) == NC_NOERR)
      bytes += header.name(text.data()) + header.count();
  std::uint64_t of_one_record = 0, records = 0;
  for (int v = 0; v < variables; ++v) {
    nc_type type = 0;
    int n = 0, with = 0;
    std::array<int, NC_MAX_VAR_DIMS> ids{};
    std::size_t size = 0;
    if (nc_inq_var(file, v, text.data(), &type, &n, ids.data(), &with) != NC_NOERR ||
        nc_inq_type(file, type, nullptr, &size) != NC_NOERR)
      continue;
    bytes += header.name(text.data()) + header.count() * static_cast<std::uint64_t>(1 + n) +
             header.attributes(v, with) + 4 + header.count() + header.offset();
    const bool of_records = n > 0 && ids[0] == unlimited;
    double values = static_cast<double>(size);
    for (int k = of_records ? 1 : 0; k < n; ++k)
      values *= static_cast<double>(lengths[static_cast<std::size_t>(ids[static_cast<std::size_t>(k)])]);
    if (values > 1e15) return UINT64_MAX;
    (of_records ? of_one_record : bytes) += static_cast<std::uint64_t>(values);  // without padding
    if (of_records) records = lengths[static_cast<std::size_t>(unlimited)];
  }
  if (static_cast<double>(of_one_record) * static_cast<double>(records) > 1e15) return UINT64_MAX;
  return bytes + of_one_record * records;
}

}  // namespace tessera::readers
