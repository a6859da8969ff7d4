// One array of a .vti where it lies. VTK's reader, by which all others are read (foreign_vtk_grids.cpp), holds all
// samples in memory and gives none before it has the last.
#include "io/vti_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <locale>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "io/foreign_geometry.hpp"
#include "io/gzip.hpp"
#include "io/input_file.hpp"
#include "io/positional_file.hpp"
#include "io/volume_formats.hpp"
#include "io/xml_elements.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t longest_beginning = 1 << 16, largest_block = 16 << 20;

/// Bytes of an array one after the other, out of its text if it is one.
class ArrayBytes {
 public:
  ArrayBytes(const PositionalFile& file, const VtkArrayPlace& place)
      : file_(file), base64_(place.base64), at_(place.first_byte), end_(file.size()) {}

  /// false: the file ends before, or what stands there is not base64.
  [[nodiscard]] bool read(std::byte* to, std::uint64_t count) {
    if (base64_) {
      for (; count > 0; --count, ++to) {
        if (next_ == three_.size() && !decode()) return false;
        *to = three_[next_++];
      }
      return true;
    }
    if (at_ > end_ || count > end_ - at_) return false;
    file_.read(at_, to, count);
    at_ += count;
    return true;
  }

  /// Of the file, behind what has been read.
  [[nodiscard]] std::uint64_t position() const { return base64_ ? at_ - (text_.size() - used_) : at_; }

 private:
  /// The next four characters to the last places of three_. A text within the text may end with padding.
  [[nodiscard]] bool decode() {
    std::uint32_t bits = 0;
    std::size_t padding = 0;
    for (int k = 0; k < 4;) {
      if (used_ == text_.size() && !fetch()) return false;
      const char c = text_[used_++];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      const int value = value_of(c);
      if (c == '=' ? k < 2 : value < 0 || padding > 0) return false;
      if (c == '=') ++padding;
      bits = bits << 6 | static_cast<std::uint32_t>(c == '=' ? 0 : value);
      ++k;
    }
    const std::array<std::byte, 3> bytes{std::byte(bits >> 16), std::byte(bits >> 8 & 255), std::byte(bits & 255)};
    next_ = padding;
    std::copy_n(bytes.begin(), bytes.size() - padding, three_.begin() + static_cast<std::ptrdiff_t>(padding));
    return true;
  }

  [[nodiscard]] bool fetch() {
    text_.resize(std::min<std::uint64_t>(64 << 10, end_ - std::min(at_, end_)));
    used_ = 0;
    if (text_.empty()) return false;
    file_.read(at_, reinterpret_cast<std::byte*>(text_.data()), text_.size());
    at_ += text_.size();
    return true;
  }

  static int value_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  }

  const PositionalFile& file_;
  bool base64_;
  std::uint64_t at_, end_;
  std::string text_;
  std::size_t used_ = 0;
  std::array<std::byte, 3> three_{};
  std::size_t next_ = 3;
};

bool read_number(ArrayBytes& bytes, const VtkArrayPlace& place, std::uint64_t& number) {
  std::array<std::byte, 8> raw{};
  const std::span<std::byte> own = std::span(raw).first(place.number_bytes);
  if (!bytes.read(own.data(), own.size())) return false;
  if (place.swapped) std::ranges::reverse(own);
  static_assert(std::endian::native == std::endian::little);
  number = std::bit_cast<std::uint64_t>(raw);
  return true;
}

/// What stands before a compressed array's blocks.
struct BlockTable {
  std::uint64_t block = 0, last = 0;  ///< bytes of each, unpacked
  std::vector<std::uint64_t> packed;
};

/// None unless it fits an array of so many bytes in this file.
std::optional<BlockTable> block_table(ArrayBytes& bytes, const VtkArrayPlace& place, std::uint64_t count,
                                      std::uint64_t file_bytes) {
  BlockTable table;
  std::uint64_t blocks = 0;
  if (!read_number(bytes, place, blocks) || !read_number(bytes, place, table.block) ||
      !read_number(bytes, place, table.last))
    return std::nullopt;
  if (table.block == 0 || table.block > largest_block || table.last > table.block || blocks == 0 ||
      blocks > file_bytes / place.number_bytes)
    return std::nullopt;
  if (table.last == 0) table.last = table.block;
  if ((blocks - 1) * table.block + table.last != count) return std::nullopt;
  table.packed.resize(blocks);
  std::uint64_t all = 0;
  for (std::uint64_t& packed : table.packed) {
    if (!read_number(bytes, place, packed) || packed > largest_block + (largest_block >> 8)) return std::nullopt;
    all += packed;
  }
  if (all > file_bytes) return std::nullopt;
  return table;
}

struct ImageAttributes {
  std::map<std::string, std::string> file, image, piece, array, appended;
  int pieces = 0, arrays = 0;
  bool of_cells = false, active = false;
};

struct BeginningEnds {};

/// Elements up to where the samples come.
ImageAttributes attributes_of(std::string_view beginning, const std::string& source) {
  ImageAttributes found;
  std::string scalars;
  try {
    each_xml_element(beginning, source, [&](const XmlElement& element) {
      const std::string parent = element.parents.empty() ? "" : element.parents.back();
      const bool fields = element.name == "PointData" || element.name == "CellData";
      if (element.name == "VTKFile") found.file = element.attributes;
      if (element.name == "ImageData") found.image = element.attributes;
      if (element.name == "Piece") found.piece = element.attributes, ++found.pieces;
      if (fields) scalars = element.find("Scalars") != nullptr ? *element.find("Scalars") : "";
      if (element.name == "DataArray" && (parent == "PointData" || parent == "CellData")) {
        found.array = element.attributes, found.of_cells = parent == "CellData", ++found.arrays;
        found.active = element.find("Name") != nullptr && *element.find("Name") == scalars;
      }
      if (element.name == "AppendedData") {
        found.appended = element.attributes;
        throw BeginningEnds();
      }
    });
  } catch (const BeginningEnds&) {
  } catch (const scene::Error&) {  // it goes on behind the beginning; what was found has to be all that is needed
  }
  return found;
}

std::string word(const std::map<std::string, std::string>& attributes, const std::string& name,
                 const std::string& otherwise = "") {
  const auto found = attributes.find(name);
  return found == attributes.end() ? otherwise : found->second;
}

template <class T, std::size_t n>
bool read_numbers(const std::string& text, std::array<T, n>& numbers) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  for (T& number : numbers)
    if (!(in >> number)) return false;
  return (in >> std::ws).eof();
}

std::optional<scene::SampleType> type_named(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, scene::SampleType>, 8> types = {
      {{"Int8", scene::SampleType::int8},
       {"UInt8", scene::SampleType::uint8},
       {"Int16", scene::SampleType::int16},
       {"UInt16", scene::SampleType::uint16},
       {"Int32", scene::SampleType::int32},
       {"UInt32", scene::SampleType::uint32},
       {"Float32", scene::SampleType::float32},
       {"Float64", scene::SampleType::float64}}};
  for (const auto& [known, type] : types)
    if (known == name) return type;
  return std::nullopt;
}

/// false: anything is odd.
bool set_image(const ImageAttributes& found, StoredVolume& volume) {
  ForeignPart image;
  image.kind = ForeignPart::Kind::image;
  std::array<std::int64_t, 6> piece{};
  const bool read = read_numbers(word(found.image, "WholeExtent"), image.extent) &&
                    read_numbers(word(found.piece, "Extent"), piece) && piece == image.extent &&
                    read_numbers(word(found.image, "Origin", "0 0 0"), image.origin) &&
                    read_numbers(word(found.image, "Spacing", "1 1 1"), image.spacing) &&
                    read_numbers(word(found.image, "Direction", "1 0 0 0 1 0 0 0 1"), image.direction);
  if (!read) return false;
  scene::GridGeometry& g = volume.grid.geometry;
  for (std::size_t a = 0; a < 3; ++a) {
    constexpr std::int64_t most = 1 << 16;  // so that bytes can be counted
    const std::int64_t low = image.extent[2 * a], high = image.extent[2 * a + 1];
    if (low < -most || high > most || high <= low || !(image.spacing[a] > 0)) return false;
    g.points[a] = high - low + 1;
  }
  g.association = found.of_cells ? scene::Association::cell : scene::Association::point;
  set_image_geometry(image, g);
  return true;
}

/// Behind the `>` of the tag that begins at `tag`; npos if it has none.
std::size_t behind_tag(std::string_view text, std::size_t tag) {
  char quote = 0;
  for (std::size_t at = tag; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0 ? c == quote : c == '"' || c == '\'') quote = quote != 0 ? '\0' : c;
    if (quote == 0 && c == '>') return at + 1;
  }
  return std::string_view::npos;
}

/// Where the array's bytes begin; false: not within the beginning.
bool set_place(std::string_view beginning, const ImageAttributes& found, VtkArrayPlace& place) {
  const bool appended = word(found.array, "format") == "appended";
  const std::size_t data = beginning.find(found.of_cells ? "<CellData" : "<PointData");
  const std::size_t tag = appended ? beginning.find("<AppendedData") : beginning.find("<DataArray", data);
  if (data == std::string_view::npos || tag == std::string_view::npos) return false;
  std::size_t first = behind_tag(beginning, tag);
  if (first == std::string_view::npos) return false;
  if (appended) {
    std::array<std::uint64_t, 1> offset{};
    first = beginning.find('_', first);
    if (first == std::string_view::npos || !read_numbers(word(found.array, "offset"), offset)) return false;
    place.base64 = word(found.appended, "encoding") == "base64";
    if (!place.base64 && word(found.appended, "encoding") != "raw") return false;
    place.first_byte = first + 1 + offset[0];
    return true;
  }
  place.base64 = true;
  place.first_byte = first;
  return word(found.array, "format") == "binary";
}

/// Whether another array follows one that stands among the elements; whatever is too long to be looked at may be one.
bool another_follows(const PositionalFile& file, std::uint64_t from) {
  const std::uint64_t size = file.size();
  if (from > size || size - from > longest_beginning) return true;
  std::string rest(size - from, '\0');
  file.read(from, reinterpret_cast<std::byte*>(rest.data()), rest.size());
  return rest.find("<DataArray") != std::string::npos || rest.find("</VTKFile>") == std::string::npos;
}

/// Compares what stands before the samples with what they need and with the file's size.
bool fits(const std::filesystem::path& path, const VtkArrayPlace& place, std::uint64_t count, bool inline_text) {
  const PositionalFile file(path);
  ArrayBytes bytes(file, place);
  std::uint64_t packed = count;
  if (place.compressed) {
    const auto table = block_table(bytes, place, count, file.size());
    if (!table) return false;
    packed = 0;
    for (const std::uint64_t block : table->packed) packed += block;
  } else {
    std::uint64_t said = 0;
    if (!read_number(bytes, place, said) || said != count) return false;
  }
  const std::uint64_t text = place.base64 ? packed / 3 * 4 : packed, left = file.size() - bytes.position();
  return text <= left && !(inline_text && another_follows(file, bytes.position() + text));
}

}  // namespace

std::optional<StoredVolume> read_plain_vti(const std::filesystem::path& file, std::uint64_t most_in_memory) {
  const std::string beginning = read_beginning(file, longest_beginning);
  const ImageAttributes found = attributes_of(beginning, file.string());
  const std::string order = word(found.file, "byte_order"), number = word(found.file, "header_type", "UInt32");
  const std::string compressor = word(found.file, "compressor"), name = word(found.array, "Name");
  const auto type = type_named(word(found.array, "type"));
  std::array<int, 1> components{};
  const bool plain = word(found.file, "type") == "ImageData" && found.pieces == 1 && found.arrays == 1 &&
                     (order == "LittleEndian" || order == "BigEndian") && (number == "UInt32" || number == "UInt64") &&
                     (compressor.empty() || compressor == "vtkZLibDataCompressor") && type && !name.empty() &&
                     name != "vtkGhostType" && read_numbers(word(found.array, "NumberOfComponents", "1"), components) &&
                     components[0] >= 1 && components[0] <= 64;
  StoredVolume volume;
  VtkArrayPlace place{
      .compressed = !compressor.empty(), .swapped = order == "BigEndian", .number_bytes = number == "UInt64" ? 8u : 4u};
  if (!plain || !set_image(found, volume) || !set_place(beginning, found, place)) return std::nullopt;
  const auto samples = static_cast<std::uint64_t>(volume.grid.geometry.all_samples().count());
  const std::uint64_t count = samples * static_cast<std::uint64_t>(components[0]) * scene::size_of(*type);
  const bool inline_text = word(found.array, "format") == "binary";
  if (count <= most_in_memory || !fits(file, place, count, inline_text)) return std::nullopt;
  volume.number = *type;
  volume.components = components[0];
  volume.swapped = place.swapped;
  volume.field = name;
  volume.active = found.active;
  volume.format = "VTK XML (image data)";
  volume.payload = file;
  if (place.base64 || place.compressed)
    volume.vtk_array = place;
  else
    volume.offset = place.first_byte + place.number_bytes;
  return volume;
}

void read_vtk_array(const std::filesystem::path& path, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const ByteSink& use) {
  const PositionalFile file(path, source);
  ArrayBytes bytes(file, place);
  std::uint64_t made = 0;
  const auto broken = [&] {
    return scene::bad_input(
        fmt::format("{}: its samples end or break after {} of {} bytes; the file is truncated or damaged, write it "
                    "anew",
                    source, made, count));
  };
  if (!place.compressed) {
    std::uint64_t said = 0;
    if (!read_number(bytes, place, said) || said != count) throw broken();
    std::vector<std::byte> part(256 << 10);
    for (; made < count; made += part.size()) {
      part.resize(std::min<std::uint64_t>(part.size(), count - made));
      if (!bytes.read(part.data(), part.size())) throw broken();
      use(part);
    }
    return;
  }
  const auto table = block_table(bytes, place, count, file.size());
  if (!table) throw broken();
  std::vector<std::byte> packed, part(table->block);
  for (std::size_t k = 0; k < table->packed.size(); ++k, made += part.size()) {
    packed.resize(table->packed[k]);
    part.resize(k + 1 < table->packed.size() ? table->block : table->last);
    if (!bytes.read(packed.data(), packed.size()) || !inflate_block(packed, part)) throw broken();
    use(part);
  }
}

}  // namespace tessera::io
