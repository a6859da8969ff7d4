// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/vtu_writing.hpp"

#include <fmt/format.h>
#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace tessera::test {
namespace {

using Coding = VtuStorage::Coding;
using Codec = VtuStorage::Codec;

std::string packed(Codec codec, const std::string& bytes) {
  const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
  std::string to(bytes.size() * 2 + 4096, '\0');
  auto* const out = reinterpret_cast<unsigned char*>(to.data());
  std::size_t size = 0;
  if (codec == Codec::zlib) {
    uLongf there = to.size();
    if (::compress(out, &there, from, bytes.size()) != Z_OK) throw std::runtime_error("zlib");
    size = there;
  } else if (codec == Codec::lz4) {
    const int made =
        LZ4_compress_default(bytes.data(), to.data(), static_cast<int>(bytes.size()), static_cast<int>(to.size()));
    if (made <= 0) throw std::runtime_error("lz4");
    size = static_cast<std::size_t>(made);
  } else if (::lzma_easy_buffer_encode(1, LZMA_CHECK_CRC32, nullptr, from, bytes.size(), out, &size, to.size()) !=
             LZMA_OK) {
    throw std::runtime_error("lzma");
  }
  return to.substr(0, size);
}

std::string base64(const std::string& bytes, std::size_t line) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::size_t written = 0;
  const auto put = [&](char c) {
    text += c;
    if (line > 0 && ++written % line == 0) text += '\n';
  };
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) put(k <= count ? letters[bits >> (18 - 6 * k) & 63] : '=');
  }
  return text;
}

template <class T>
void append_number(std::string& bytes, T value, bool big) {
  std::string number(sizeof value, '\0');
  std::memcpy(number.data(), &value, sizeof value);
  if (big) std::ranges::reverse(number);
  bytes += number;
}

template <class Use>
void with_type(const std::string& type, const Use& use) {
  if (type == "Int8") use(std::int8_t{});
  if (type == "UInt8") use(std::uint8_t{});
  if (type == "Int16") use(std::int16_t{});
  if (type == "UInt16") use(std::uint16_t{});
  if (type == "Int32") use(std::int32_t{});
  if (type == "UInt32") use(std::uint32_t{});
  if (type == "Int64") use(std::int64_t{});
  if (type == "UInt64") use(std::uint64_t{});
  if (type == "Float32") use(float{});
  if (type == "Float64") use(double{});
}

std::string bytes_of(const VtuArray& array, bool big) {
  std::string bytes;
  with_type(array.type, [&](auto zero) {
    for (const double number : array.numbers) append_number(bytes, static_cast<decltype(zero)>(number), big);
  });
  return bytes;
}

std::string ascii_of(const VtuArray& array) {
  std::string text;
  with_type(array.type, [&](auto zero) {
    for (const double number : array.numbers) {
      using T = decltype(zero);
      if constexpr (sizeof(T) == 1)
        text += fmt::format("{} ", static_cast<int>(static_cast<T>(number)));
      else
        text += fmt::format("{} ", static_cast<T>(number));
    }
  });
  return text;
}

/// The header and data of an array as stored.
std::string stored(const VtuStorage& s, const std::string& bytes) {
  const bool is_text = s.coding != Coding::appended_raw;
  std::string head, body;
  const auto number = [&](std::uint64_t n) {
    if (s.wide_numbers)
      append_number(head, n, s.big_endian);
    else
      append_number(head, static_cast<std::uint32_t>(n), s.big_endian);
  };
  const auto text = [&](const std::string& raw) { return is_text ? base64(raw, s.line) : raw; };
  if (s.codec == Codec::none) {
    number(bytes.size());
    return s.split_text ? text(head) + text(bytes) : text(head + bytes);
  }
  const std::size_t block = s.block > 0 ? s.block : std::max<std::size_t>(bytes.size(), 1);
  std::vector<std::string> blocks;
  for (std::size_t at = 0; at < bytes.size(); at += block) blocks.push_back(packed(s.codec, bytes.substr(at, block)));
  number(blocks.size());
  number(block);
  number(bytes.size() % block);
  for (const std::string& one : blocks) {
    number(one.size());
    body += one;
  }
  return text(head) + text(body);
}

class VtuText {
 public:
  explicit VtuText(const VtuStorage& storage) : s_(storage) {}

  void add(const VtuPiece& piece) {
    text_ += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", piece.points, piece.cells);
    add_list("PointData " + piece.point_attributes, "PointData", piece.point_data);
    add_list("CellData " + piece.cell_attributes, "CellData", piece.cell_data);
    add_list("Points", "Points", piece.coordinates);
    add_list("Cells", "Cells", piece.topology);
    text_ += "</Piece>\n";
  }

  [[nodiscard]] std::string whole() const {
    static constexpr const char* compressors[] = {"", " compressor=\"vtkZLibDataCompressor\"",
                                                  " compressor=\"vtkLZ4DataCompressor\"",
                                                  " compressor=\"vtkLZMADataCompressor\""};
    std::string all = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"{}\" byte_order=\"{}\" "
        "header_type=\"{}\"{}>\n<UnstructuredGrid>\n{}</UnstructuredGrid>\n",
        s_.version, s_.big_endian ? "BigEndian" : "LittleEndian", s_.wide_numbers ? "UInt64" : "UInt32",
        compressors[static_cast<std::size_t>(s_.codec)], text_);
    if (s_.coding == Coding::appended_base64 || s_.coding == Coding::appended_raw)
      all += fmt::format("<AppendedData encoding=\"{}\">\n _", s_.coding == Coding::appended_raw ? "raw" : "base64") +
             appended_ + "\n</AppendedData>\n";
    return all + "</VTKFile>\n";
  }

 private:
  void add_list(const std::string& opening, const std::string& name, const std::vector<VtuArray>& arrays) {
    text_ += "<" + opening + ">\n";
    for (const VtuArray& array : arrays) {
      text_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ", array.type, array.name,
                           array.components);
      if (s_.coding == Coding::ascii) {
        text_ += "format=\"ascii\">\n" + ascii_of(array) + "\n</DataArray>\n";
      } else if (s_.coding == Coding::inline_base64) {
        text_ += "format=\"binary\">\n  " + stored(s_, bytes_of(array, s_.big_endian)) + "\n</DataArray>\n";
      } else {
        text_ += fmt::format("format=\"appended\" offset=\"{}\"/>\n", appended_.size());
        appended_ += stored(s_, bytes_of(array, s_.big_endian));
      }
    }
    text_ += "</" + name + ">\n";
  }

  const VtuStorage& s_;
  std::string text_, appended_;
};

}  // namespace

std::string vtu_file_text(const VtuStorage& storage, const std::vector<VtuPiece>& pieces) {
  VtuText text(storage);
  for (const VtuPiece& piece : pieces) text.add(piece);
  return text.whole();
}

VtuPiece sample_piece(const std::string& point_type, const std::string& index_type, const std::string& cell_type) {
  VtuPiece piece{.points = 12, .cells = 3, .point_data = {}, .cell_data = {}, .coordinates = {}, .topology = {}};
  VtuArray points{point_type, "Points", 3, {}}, f{"Float32", "f", 1, {}}, v{"Float64", "v", 3, {}};
  for (int p = 0; p < 12; ++p) {
    const double x = p % 3, y = p / 3 % 2, z = p / 6;
    points.numbers.insert(points.numbers.end(), {x, y, z});
    f.numbers.push_back(x + 0.5 * y - 0.25 * z);
    v.numbers.insert(v.numbers.end(), {0.1 * p, -p / 3.0, 1e-3 * p * p});
  }
  piece.coordinates = {points};
  piece.point_data = {f, v};
  piece.cell_data = {{"Int16", "c", 1, {7, -3, 1000}}};
  piece.topology = {{index_type, "connectivity", 1, {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 4, 7, 8, 10, 2, 5, 4, 8, 11, 10}},
                    {index_type, "offsets", 1, {8, 14, 20}},
                    {cell_type, "types", 1, {12, 13, 13}}};
  piece.point_attributes = "Scalars=\"f\" Vectors=\"v\"";
  return piece;
}

std::vector<VtuStorage> all_storages() {
  std::vector<VtuStorage> all;
  for (const Coding coding : {Coding::ascii, Coding::inline_base64, Coding::appended_base64, Coding::appended_raw})
    for (const Codec codec : {Codec::none, Codec::zlib, Codec::lz4, Codec::lzma})
      for (const bool wide : {false, true})
        for (const bool big : {false, true})
          if (coding != Coding::ascii || codec == Codec::none)
            all.push_back({.coding = coding, .codec = codec, .wide_numbers = wide, .big_endian = big});
  return all;
}

}  // namespace tessera::test
