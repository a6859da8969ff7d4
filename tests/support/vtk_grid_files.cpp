// SPDX-License-Identifier: BSD-3-Clause
#include "support/vtk_grid_files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace tessera::test {
namespace {

std::string zlib_of(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                     bytes.size()),
            Z_OK);
  packed.resize(size);
  return packed;
}

std::string base64_of(const std::string& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

template <class T>
std::string number(T value, bool big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) std::ranges::reverse(bytes);
  return bytes;
}

std::string array_of(const VtkCase& c, const std::string& bytes) {
  const auto numbers = [&](std::uint64_t n) {
    return c.wide_numbers ? number(n, c.big_endian) : number(static_cast<std::uint32_t>(n), c.big_endian);
  };
  const auto text = [&](const std::string& raw) { return c.base64 ? base64_of(raw) : raw; };
  if (!c.compressed)
    return c.split_text ? text(numbers(bytes.size())) + text(bytes) : text(numbers(bytes.size()) + bytes);
  constexpr std::size_t block = 32768;
  std::string table, packed;
  std::size_t blocks = 0;
  for (std::size_t at = 0; at < bytes.size(); at += block, ++blocks) {
    const std::string one = zlib_of(bytes.substr(at, block));
    table += numbers(one.size()), packed += one;
  }
  return text(numbers(blocks) + numbers(block) + numbers(bytes.size() % block) + table) + text(packed);
}

std::string numbers_of(const std::string& type, const std::vector<double>& values, bool big) {
  std::string bytes;
  for (const double x : values)
    bytes += type == "Float32" ? number(static_cast<float>(x), big)
             : type == "Int32" ? number(static_cast<std::int32_t>(x), big)
             : type == "Int64" ? number(static_cast<std::int64_t>(x), big)
                               : number(x, big);
  return bytes;
}

/// The elements of the axes; adds appended data to `appended`.
std::string coordinates_of(const VtkCase& c, std::string& appended) {
  std::string elements;
  for (const std::vector<double>& axis : c.axes->values) {
    elements += "<DataArray type=\"" + c.axes->type + "\" ";
    std::string text;
    for (const double x : axis) text += fmt::format("{} ", x);
    const std::string array = array_of(c, numbers_of(c.axes->type, axis, c.big_endian));
    if (c.axes->text) {
      elements += "format=\"ascii\">\n" + text + "\n</DataArray>";
    } else if (!c.appended) {
      elements += "format=\"binary\">\n" + array + "\n</DataArray>";
    } else {
      elements += "format=\"appended\" offset=\"" + std::to_string(appended.size()) + "\"/>";
      appended += array;
    }
  }
  return "<Coordinates>" + elements + "</Coordinates>";
}

}  // namespace

std::string noise(std::size_t bytes) {
  std::mt19937 random(3);
  std::string text(bytes, '\0');
  // Only some bits, so that packing has an effect.
  for (char& c : text) c = static_cast<char>(random() & 15);
  return text;
}

std::string vtk_file(const VtkCase& c, const std::string& bytes) {
  const auto extent = [&](int low, int n) {
    return std::to_string(low) + " " + std::to_string(low + n - (c.of_cells ? 0 : 1));
  };
  const std::string whole = extent(-3, nx) + " " + extent(0, ny) + " " + extent(5, nz);
  const std::string fields = c.of_cells ? "CellData" : "PointData", kind = c.axes ? "RectilinearGrid" : "ImageData";
  const std::string array = array_of(c, bytes);
  std::string appended = c.appended ? array : "";
  const std::string coordinates = c.axes ? coordinates_of(c, appended) : "";
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind + "\" version=\"1.0\" byte_order=\"" +
      (c.big_endian ? "BigEndian" : "LittleEndian") + "\" header_type=\"" + (c.wide_numbers ? "UInt64" : "UInt32") +
      "\"" + (c.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") + ">\n<" + kind + " WholeExtent=\"" + whole +
      "\"" + (c.axes ? "" : " Origin=\"1 2 3\" Spacing=\"0.5 2 0.25\" Direction=\"0 -1 0 1 0 0 0 0 1\"") +
      ">\n<Piece Extent=\"" + whole + "\">" + (c.axes && c.axes->first ? coordinates : "") + "<" + fields +
      " Scalars=\"rho\"><DataArray type=\"" + c.type + "\" Name=\"rho\" NumberOfComponents=\"" +
      std::to_string(c.components) + "\" ";
  text += c.appended ? "format=\"appended\" offset=\"0\"/>" : "format=\"binary\">\n  " + array + "\n</DataArray>";
  text += "</" + fields + ">" + (c.axes && !c.axes->first ? coordinates : "") + "</Piece></" + kind + ">";
  if (c.appended)
    text += std::string("<AppendedData encoding=\"") + (c.base64 ? "base64" : "raw") + "\">\n  _" + appended +
            "\n</AppendedData>";
  return text + "</VTKFile>\n";
}

AxesCase axes_of(const std::string& type, double bent, std::array<bool, 3> falls, int more) {
  AxesCase axes{.type = type, .values = {}};
  const bool whole = type.starts_with("Int");
  const std::array<int, 3> n{nx + more, ny + more, nz + more};
  for (std::size_t a = 0; a < 3; ++a)
    for (int i = 0; i < n[a]; ++i) {
      const double x = -1.7 + 0.1 * i + bent * i * i;
      axes.values[a].push_back((falls[a] ? -1 : 1) * (whole ? std::round(10 * x) : x));
    }
  return axes;
}

}  // namespace tessera::test
