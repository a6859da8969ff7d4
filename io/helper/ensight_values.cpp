// EnSight 6 and Gold variable files, in text and C binary, by the EnSight User Manual ("EnSight Gold Variable File
// Format"). Only headers are interpreted; the numbers of points and cells are those that VTK's reader goes by.
#include "io/helper/ensight_values.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkEnSight6BinaryReader.h>
#include <vtkEnSight6Reader.h>
#include <vtkEnSightReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkIdList.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/mapped_file.hpp"

namespace tessera::io::helper {
namespace {

// VTK's readers keep these for their subclasses.
struct Tables : vtkEnSightReader {
  static vtkIdType part(vtkEnSightReader& reader, int id) { return (reader.*(&Tables::InsertNewPartId))(id); }
  static vtkIdType unstructured(vtkEnSightReader& reader, vtkIdType part) {
    return (reader.*(&Tables::UnstructuredPartIds))->IsId(part);
  }
  static int type(vtkEnSightReader& reader, const char* line) { return (reader.*(&Tables::GetElementType))(line); }
  static vtkIdType cells(vtkEnSightReader& reader, vtkIdType index, int type) {
    return (reader.*(&Tables::GetCellIds))(static_cast<int>(index), type)->GetNumberOfIds();
  }
};
struct TextNodes : vtkEnSight6Reader {
  static vtkPoints* of(vtkEnSight6Reader& reader) { return reader.*(&TextNodes::UnstructuredPoints); }
};
struct BinaryNodes : vtkEnSight6BinaryReader {
  static vtkPoints* of(vtkEnSight6BinaryReader& reader) { return reader.*(&BinaryNodes::UnstructuredPoints); }
};

enum class Found : std::uint8_t { all, too_few, other };

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

class ValuesText {
 public:
  ValuesText(std::string_view text, bool is_binary, bool is_gold)
      : text_(text), is_binary_(is_binary), widest_(is_gold ? text.size() : 12) {}

  [[nodiscard]] bool begins_with(std::string_view word) const { return text_.substr(at_).starts_with(word); }

  /// Records of Fortran have their length, 80 bytes, before them.
  [[nodiscard]] bool has_records() const {
    return is_binary_ &&
           (text_.starts_with(std::string_view("P\0\0\0", 4)) || text_.starts_with(std::string_view("\0\0\0P", 4)));
  }

  /// The next header without blanks around it; nothing at the end of the file.
  std::optional<std::string> header() {
    constexpr std::size_t record = 80;
    std::string_view line;
    if (is_binary_) {
      if (text_.size() - at_ < record) return std::nullopt;
      line = text_.substr(at_, record);
      line = line.substr(0, line.find('\0'));
      at_ += record;
    } else {
      while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '#'))
        text_[at_] == '#' ? next_line() : static_cast<void>(++at_);
      if (at_ == text_.size()) return std::nullopt;
      const std::size_t first = at_;
      next_line();
      line = text_.substr(first, at_ - first);
    }
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    return std::string(line);
  }

  void skip_description() { is_binary_ ? static_cast<void>(at_ = std::min(text_.size(), at_ + 80)) : next_line(); }

  /// The number of a part in a record of its own; 0 if there is none.
  int part_number() {
    if (!is_binary_) return number_in(header().value_or(""));
    std::uint32_t number = 0;
    if (text_.size() - at_ < sizeof number) return 0;
    std::memcpy(&number, text_.data() + at_, sizeof number);
    at_ += sizeof number;
    // Parts have small numbers, so the other byte order has the larger one.
    return static_cast<int>(std::min({number, __builtin_bswap32(number), 0x7fffffffu}));
  }

  static int number_in(std::string_view words) {
    while (!words.empty() && is_blank(words.front())) words.remove_prefix(1);
    int number = 0;
    const auto end = std::from_chars(words.data(), words.data() + words.size(), number).ptr;
    return end == words.data() + words.size() ? number : 0;
  }

  Found numbers(std::uint64_t count) {
    if (!is_binary_) return numbers_of_text(count);
    const bool are_there = (text_.size() - at_) / sizeof(float) >= count;
    at_ = are_there ? at_ + count * sizeof(float) : text_.size();
    return are_there ? Found::all : Found::too_few;
  }

 private:
  void next_line() { at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1; }

  /// Those of EnSight 6 may touch each other: each has 12 characters at most.
  Found numbers_of_text(std::uint64_t count) {
    if (count == 0) return Found::all;
    for (; count > 0; --count) {
      while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
      if (at_ == text_.size()) return Found::too_few;
      const char first = text_[at_];
      const bool is_word = std::isalpha(static_cast<unsigned char>(first)) != 0;
      const std::string_view word = text_.substr(at_, 3);
      if (first == '#' || (is_word && word != "nan" && word != "NaN" && word != "NAN" && word != "inf" &&
                           word != "Inf" && word != "INF"))
        return Found::other;
      const std::size_t most = std::min(text_.size() - at_, widest_) + at_;
      while (at_ < most && !is_blank(text_[at_])) ++at_;
    }
    next_line();
    return Found::all;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool is_binary_;
  std::size_t widest_;
};

class ValuesWalk {
 public:
  ValuesWalk(vtkEnSightReader& reader, vtkMultiBlockDataSet& parts, const EnsightCase::Values& values,
             std::string_view text)
      : reader_(reader),
        parts_(parts),
        values_(values),
        is_gold_(reader.IsA("vtkEnSightGoldReader") != 0 || reader.IsA("vtkEnSightGoldBinaryReader") != 0),
        text_(text, reader.IsA("vtkEnSightGoldBinaryReader") != 0 || reader.IsA("vtkEnSight6BinaryReader") != 0,
              is_gold_) {}

  /// As where_values_end().
  std::string walk() {
    if (text_.has_records() || text_.begins_with("BEGIN TIME STEP")) return "";
    text_.skip_description();
    if (!is_gold_ && values_.of_points && !text_.begins_with("part")) {
      const Found found = numbers(nodes());
      if (found != Found::all) return found == Found::too_few ? "the nodes" : "";
    }
    std::optional<std::string> line = text_.header();
    while (line && line->starts_with("part")) {
      const int number = is_gold_ ? text_.part_number() : ValuesText::number_in(std::string_view(*line).substr(4));
      const vtkIdType part = number > 0 ? Tables::part(reader_, number - 1) : -1;
      auto* const grid = part < 0 || part >= parts_.GetNumberOfBlocks()
                             ? nullptr
                             : vtkDataSet::SafeDownCast(parts_.GetBlock(static_cast<unsigned>(part)));
      if (grid == nullptr) return "";
      const Found found = values_.of_points ? points_of(*grid, line) : cells_of(*grid, part, line);
      if (found != Found::all) return found == Found::too_few ? fmt::format("part {}", number) : "";
    }
    return "";
  }

 private:
  Found numbers(vtkIdType tuples) {
    return text_.numbers(static_cast<std::uint64_t>(tuples) * static_cast<std::uint64_t>(values_.components));
  }

  /// Those that all unstructured parts of EnSight 6 share.
  vtkIdType nodes() {
    vtkPoints* points = nullptr;
    if (auto* const text = vtkEnSight6Reader::SafeDownCast(&reader_)) points = TextNodes::of(*text);
    if (auto* const binary = vtkEnSight6BinaryReader::SafeDownCast(&reader_)) points = BinaryNodes::of(*binary);
    return points != nullptr ? points->GetNumberOfPoints() : 0;
  }

  /// Reads on to the header after the part.
  Found points_of(vtkDataSet& grid, std::optional<std::string>& line) {
    Found found = Found::all;
    if (grid.GetNumberOfPoints() > 0) {
      line = text_.header();
      if (!line) return Found::too_few;
      found = *line == "coordinates" || *line == "block" ? numbers(grid.GetNumberOfPoints()) : Found::other;
    }
    line = text_.header();
    return found;
  }

  Found cells_of(vtkDataSet& grid, vtkIdType part, std::optional<std::string>& line) {
    for (line = text_.header(); line && !line->starts_with("part"); line = text_.header()) {
      vtkIdType cells = grid.GetNumberOfCells();
      if (*line != "block") {
        const vtkIdType index = Tables::unstructured(reader_, part);
        const int type = line->find(' ') == std::string::npos ? Tables::type(reader_, line->c_str()) : -1;
        if (index < 0 || type < 0) return Found::other;
        cells = Tables::cells(reader_, index, type);
      }
      if (const Found found = numbers(cells); found != Found::all) return found;
    }
    return Found::all;
  }

  vtkEnSightReader& reader_;
  vtkMultiBlockDataSet& parts_;
  const EnsightCase::Values& values_;
  bool is_gold_;
  ValuesText text_;
};

}  // namespace

std::string where_values_end(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values) {
  auto* const with_tables = vtkEnSightReader::SafeDownCast(reader.GetReader());
  auto* const parts = vtkMultiBlockDataSet::SafeDownCast(&data);
  if (with_tables == nullptr || parts == nullptr) return "";
  const MappedFile file(values.file);
  return ValuesWalk(*with_tables, *parts, values, file.text()).walk();
}

void remove_values(vtkDataObject& data, const EnsightCase::Values& values) {
  auto* const parts = vtkMultiBlockDataSet::SafeDownCast(&data);
  for (unsigned k = 0; parts != nullptr && k < parts->GetNumberOfBlocks(); ++k) {
    auto* const grid = vtkDataSet::SafeDownCast(parts->GetBlock(k));
    if (grid == nullptr) continue;
    vtkDataSetAttributes* attributes = grid->GetCellData();
    if (values.of_points) attributes = grid->GetPointData();
    attributes->RemoveArray(values.variable.c_str());
  }
}

}  // namespace tessera::io::helper
