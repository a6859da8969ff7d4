// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/netcdf/netcdf_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

NumberType number_type_of(nc_type type, const std::string& is_unsigned) {
  const bool yes = is_unsigned == "true", no = is_unsigned == "false";
  switch (type) {
    case NC_BYTE:
      return yes ? NumberType::uint8 : NumberType::int8;
    case NC_UBYTE:
      return no ? NumberType::int8 : NumberType::uint8;
    case NC_SHORT:
      return yes ? NumberType::uint16 : NumberType::int16;
    case NC_USHORT:
      return NumberType::uint16;
    case NC_INT:
      return yes ? NumberType::uint32 : NumberType::int32;
    case NC_UINT:
      return NumberType::uint32;
    case NC_INT64:
      return yes ? NumberType::uint64 : NumberType::int64;
    case NC_UINT64:
      return NumberType::uint64;
    case NC_FLOAT:
      return NumberType::float32;
    default:
      return NumberType::float64;
  }
}

/// Returns the value that NetCDF's library stores where a program did not write a value. Bytes have a default, too, but
/// it is not used, because every byte is a valid value.
std::optional<double> default_fill_of(nc_type type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return static_cast<double>(NC_FILL_INT64);
    case NC_UINT64:
      return static_cast<double>(NC_FILL_UINT64);
    case NC_FLOAT:
      return static_cast<double>(NC_FILL_FLOAT);
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return std::nullopt;
  }
}

bool is_float(nc_type type) { return type == NC_FLOAT || type == NC_DOUBLE; }

/// The attributes of a variable that affect its numbers.
struct Packing {
  NumberType type = NumberType::float64;  ///< stored type
  double scale = 1, shift = 0;
  bool single = false;              ///< numbers are float32 after unpacking
  std::vector<double> missing;      ///< as stored
  std::optional<double> unwritten;  ///< the default fill value
  double low = -infinity, high = infinity;
  bool range_is_unpacked = false;

  [[nodiscard]] bool is_packed() const { return scale != 1 || shift != 0; }
  [[nodiscard]] bool has_range() const { return low > -infinity || high < infinity; }
};

void add_valid_range(const NetcdfFile& file, const NetcdfVariable& variable, Packing& packing, double wrap) {
  for (const char* const name : {"valid_range", "valid_min", "valid_max"}) {
    std::vector<double> ends = file.numbers(variable, name);
    const bool is_range = std::string_view(name) == "valid_range", is_low = std::string_view(name) == "valid_min";
    if (ends.size() != (is_range ? 2u : 1u)) continue;
    // If integers are packed and the limits have a floating-point type, the limits are those of unpacked values.
    const bool unpacked = is_float(file.attribute_type(variable, name)) && !is_float(variable.type);
    for (double& end : ends)
      if (!unpacked && end < 0) end += wrap;
    if (is_range && !(ends[0] <= ends[1])) continue;
    packing.range_is_unpacked = unpacked;
    if (is_range || is_low) packing.low = ends.front();
    if (is_range || !is_low) packing.high = ends.back();
  }
}

Packing packing_of(const NetcdfFile& file, const NetcdfVariable& variable) {
  Packing packing;
  packing.type = number_type_of(variable.type, file.text(variable, "_Unsigned"));
  // If a signed type is declared as unsigned, negative attribute values represent the unsigned numbers with the same
  // bits.
  const bool reinterpreted = file.text(variable, "_Unsigned") == "true" && variable.type != NC_UBYTE;
  const double wrap = reinterpreted ? std::ldexp(1.0, static_cast<int>(8 * io::size_of(packing.type))) : 0;
  const auto first_of = [&](const char* attribute, double otherwise) {
    const std::vector<double> numbers = file.numbers(variable, attribute);
    return numbers.empty() || !std::isfinite(numbers.front()) ? otherwise : numbers.front();
  };
  packing.scale = first_of("scale_factor", 1), packing.shift = first_of("add_offset", 0);
  packing.single = (io::size_of(packing.type) <= 2 || variable.type == NC_FLOAT) &&
                   file.attribute_type(variable, "scale_factor") != NC_DOUBLE &&
                   file.attribute_type(variable, "add_offset") != NC_DOUBLE;
  const std::vector<double> fill = file.numbers(variable, "_FillValue");
  packing.missing = file.numbers(variable, "missing_value");
  packing.missing.insert(packing.missing.end(), fill.begin(), fill.end());
  if (fill.empty()) packing.unwritten = default_fill_of(variable.type);
  int without = 0;
  if (nc_inq_var_fill(variable.group, variable.id, &without, nullptr) == NC_NOERR && without != 0)
    packing.unwritten.reset();
  for (double& value : packing.missing) {
    if (value < 0) value += wrap;
    if (variable.type == NC_FLOAT && std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))
      value = static_cast<float>(value);
  }
  if (packing.unwritten && *packing.unwritten < 0) *packing.unwritten += wrap;
  add_valid_range(file, variable, packing, wrap);
  return packing;
}

/// Unpacks some numbers in place, and counts in `result` the numbers that become NaN. Returns whether any number
/// changed.
bool unpack_some(const Packing& packing, std::span<double> values, NetcdfValues& result) {
  bool changes = packing.is_packed();
  for (double& value : values) {
    const double raw = value;
    if (packing.is_packed()) value = raw * packing.scale + packing.shift;
    const double ranged = packing.range_is_unpacked ? value : raw;
    const bool is_missing = std::find(packing.missing.begin(), packing.missing.end(), raw) != packing.missing.end();
    const bool is_unwritten = !is_missing && packing.unwritten == raw;
    const bool is_outside = !is_missing && !is_unwritten && (ranged < packing.low || ranged > packing.high);
    if (!is_missing && !is_unwritten && !is_outside) continue;
    value = std::numeric_limits<double>::quiet_NaN();
    changes = true;
    result.default_fills += is_unwritten ? 1 : 0;
    result.out_of_range += is_outside ? 1 : 0;
  }
  return changes;
}

/// Returns the unpacked numbers, or `stored` if nothing changes them.
NetcdfValues unpack(GridNumbers stored, const Packing& packing) {
  NetcdfValues result;
  const std::size_t count = stored.count();
  std::array<double, 4096> some;
  const auto chunk_at = [&](std::size_t first) {
    const std::span chunk(some.data(), std::min(some.size(), count - first));
    io::read_tuples(stored.bytes, stored.type, 1, 0, first, chunk);
    return chunk;
  };
  bool changes = false;
  for (std::size_t first = 0; first < count; first += some.size())
    if (unpack_some(packing, chunk_at(first), result)) changes = true;
  if (!changes) {
    result.numbers = std::move(stored);
    return result;
  }
  NetcdfValues counted_again;
  result.numbers.type = packing.single ? NumberType::float32 : NumberType::float64;
  result.numbers.bytes.resize(count * io::size_of(result.numbers.type));
  for (std::size_t first = 0; first < count; first += some.size()) {
    const std::span<double> chunk = chunk_at(first);
    unpack_some(packing, chunk, counted_again);
    const GridNumbers done = numbers_of(chunk, result.numbers.type);
    std::copy(done.bytes.begin(), done.bytes.end(),
              result.numbers.bytes.begin() + static_cast<std::ptrdiff_t>(first * io::size_of(done.type)));
  }
  return result;
}

scene::Error unreadable(const NetcdfFile& file, const NetcdfVariable& variable, int status) {
  const std::string name = quote(variable.path);
  if (status == NC_ENOFILTER || status == NC_EFILTER)
    return scene::bad_input(fmt::format(
        "{}: {} is compressed by a filter that is not installed here; unpack it with h5repack -f NONE, or install the "
        "filter and set HDF5_PLUGIN_PATH",
        file.source(), name));
  return scene::bad_input(fmt::format("{}: {} cannot be read ({}); the file is truncated or damaged, write it again",
                                      file.source(), name, nc_strerror(status)));
}

}  // namespace

NetcdfValues read_values(const NetcdfFile& file, const NetcdfVariable& variable, std::span<const std::size_t> first,
                         std::span<const std::size_t> counts) {
  const Packing packing = packing_of(file, variable);
  double bytes = static_cast<double>(io::size_of(packing.type));
  std::size_t count = 1;
  for (const std::size_t n : counts) bytes *= static_cast<double>(n), count *= n;
  if (bytes > 0x1p60) throw std::bad_alloc();
  GridNumbers stored{packing.type, std::vector<std::byte>(count * io::size_of(packing.type))};
  if (const int status = nc_get_vara(variable.group, variable.id, first.data(), counts.data(), stored.bytes.data());
      status != NC_NOERR)
    throw unreadable(file, variable, status);
  const bool is_plain = !packing.is_packed() && packing.missing.empty() && !packing.unwritten && !packing.has_range();
  return is_plain ? NetcdfValues{.numbers = std::move(stored)} : unpack(std::move(stored), packing);
}

GridNumbers read_whole(const NetcdfFile& file, const NetcdfVariable& variable, std::size_t most) {
  std::vector<std::size_t> first(variable.dimensions.size(), 0), counts;
  double count = 1;
  for (const NetcdfDimension& dimension : variable.dimensions) {
    counts.push_back(dimension.length);
    count *= static_cast<double>(dimension.length);
  }
  if (count > static_cast<double>(most)) return {};
  return read_values(file, variable, first, counts).numbers;
}

}  // namespace tessera::readers
