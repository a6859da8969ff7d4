// SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 and Gold variable files, in text and C binary, according to the EnSight User Manual ("EnSight Gold Variable
// File Format"). Only headers are interpreted; the numbers of points and cells are those used by VTK's reader.
#include "readers/vtk/ensight_values.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkEnSight6BinaryReader.h>
#include <vtkEnSight6Reader.h>
#include <vtkEnSightReader.h>
#include <vtkGenericCell.h>
#include <vtkGenericEnSightReader.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/files/whole_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

// Gives access to tables that VTK's readers keep for their subclasses.
struct Tables : vtkEnSightReader {
  static vtkIdType part(vtkEnSightReader& reader, int id) { return (reader.*(&Tables::InsertNewPartId))(id); }
  static vtkIdType unstructured(vtkEnSightReader& reader, vtkIdType part) {
    return (reader.*(&Tables::UnstructuredPartIds))->IsId(part);
  }
  static int type(vtkEnSightReader& reader, const char* line) { return (reader.*(&Tables::GetElementType))(line); }
  static vtkIdList& cells(vtkEnSightReader& reader, vtkIdType index, int type) {
    return *(reader.*(&Tables::GetCellIds))(static_cast<int>(index), type);
  }
  static constexpr int types = NUMBER_OF_ELEMENT_TYPES;
};
struct TextNodes : vtkEnSight6Reader {
  static vtkPoints* of(vtkEnSight6Reader& reader) { return reader.*(&TextNodes::UnstructuredPoints); }
};
struct BinaryNodes : vtkEnSight6BinaryReader {
  static vtkPoints* of(vtkEnSight6BinaryReader& reader) { return reader.*(&BinaryNodes::UnstructuredPoints); }
};

constexpr std::string_view part_word = "part";

enum class Found : std::uint8_t { all, too_few, other };

class ValuesText {
 public:
  ValuesText(std::string_view text, bool is_binary, bool is_gold)
      : text_(text), is_binary_(is_binary), widest_(is_gold ? text.size() : 12) {}

  [[nodiscard]] bool begins_with(std::string_view word) const { return text_.substr(at_).starts_with(word); }

  /// Whether only blanks follow.
  [[nodiscard]] bool is_at_end() const { return std::ranges::all_of(text_.substr(at_), is_blank); }

  /// Whether a binary file ends within the record that begins a part.
  [[nodiscard]] bool is_cut_off() const {
    const std::string_view rest = text_.substr(at_);
    return is_binary_ && !rest.empty() && rest.size() < 80 && part_word.starts_with(rest.substr(0, part_word.size()));
  }

  /// Whether the file has Fortran records, which begin with their length, here 80 bytes.
  [[nodiscard]] bool has_records() const {
    return is_binary_ &&
           (text_.starts_with(std::string_view("P\0\0\0", 4)) || text_.starts_with(std::string_view("\0\0\0P", 4)));
  }

  /// Returns the next header without surrounding blanks; no value at the end of the file.
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
    return std::string(trimmed(line));
  }

  void skip_description() { is_binary_ ? static_cast<void>(at_ = std::min(text_.size(), at_ + 80)) : next_line(); }

  /// Reads a line or record that contains a single small integer; returns 0 if there is none.
  int number() {
    if (!is_binary_) return number_in(header().value_or(""));
    std::uint32_t number = 0;
    if (text_.size() - at_ < sizeof number) return at_ = text_.size(), 0;
    std::memcpy(&number, text_.data() + at_, sizeof number);
    at_ += sizeof number;
    // The number is small, so the wrong byte order would give a larger number.
    return static_cast<int>(std::min({number, __builtin_bswap32(number), 0x7fffffffu}));
  }

  static int number_in(std::string_view words) {
    while (!words.empty() && is_blank(words.front())) words.remove_prefix(1);
    int number = 0;
    const auto end = std::from_chars(words.data(), words.data() + words.size(), number).ptr;
    return end == words.data() + words.size() ? number : 0;
  }

  Found reals(std::uint64_t count) { return is_binary_ ? binary(count) : numbers_of_text(count, true); }
  Found integers(std::uint64_t count) { return is_binary_ ? binary(count) : numbers_of_text(count, false); }

 private:
  void next_line() { at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1; }

  Found binary(std::uint64_t count) {
    const bool are_there = (text_.size() - at_) / sizeof(float) >= count;
    at_ = are_there ? at_ + count * sizeof(float) : text_.size();
    return are_there ? Found::all : Found::too_few;
  }

  /// Reads numbers. In EnSight 6 they may be adjacent without blanks, with at most 12 characters each.
  Found numbers_of_text(std::uint64_t count, bool are_reals) {
    if (count == 0) return Found::all;
    for (; count > 0; --count) {
      while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
      if (at_ == text_.size()) return Found::too_few;
      const char first = text_[at_];
      const bool is_word = is_letter(first);
      const std::string_view word = text_.substr(at_, 3);
      if (first == '#' || (is_word && word != "nan" && word != "NaN" && word != "NAN" && word != "inf" &&
                           word != "Inf" && word != "INF"))
        return Found::other;
      const std::size_t start = at_, most = std::min(text_.size() - at_, widest_) + at_;
      while (at_ < most && !is_blank(text_[at_])) ++at_;
      if (are_reals && !is_word && is_cut(text_.substr(start, at_ - start))) return Found::too_few;
    }
    next_line();
    return Found::all;
  }

  /// Whether a number at the very end of the file is cut off: it has fewer characters after its point than all others,
  /// which have an exponent and the same number of characters after the point. EnSight writes this kind of fixed-width
  /// format.
  bool is_cut(std::string_view number) {
    const std::size_t length = number.size() - std::min(number.size(), number.find('.'));
    if (at_ == text_.size() && decimals_ && is_even_ && length < *decimals_) return true;
    is_even_ = is_even_ && number.find_first_of("eE") != std::string_view::npos && length == decimals_.value_or(length);
    decimals_ = length;
    return false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool is_binary_;
  std::size_t widest_;
  std::optional<std::size_t> decimals_;
  bool is_even_ = true;
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

  /// Checks the file; see values_in().
  EnsightValues walk() {
    if (text_.has_records() || text_.begins_with("BEGIN TIME STEP")) return {};
    text_.skip_description();
    const bool has_nodes = !is_gold_ && values_.of_points && !text_.begins_with("part") && nodes() > 0;
    if (has_nodes) {
      const Found found = reals(nodes());
      if (found != Found::all) return {found == Found::too_few ? "inside the nodes" : "", {}};
    }
    std::optional<std::string> line = text_.header();
    if (!line && !has_nodes) return {"before its values", {}};
    int number = 0;
    std::vector<bool> is_there(parts_.GetNumberOfBlocks());
    while (line && line->starts_with("part")) {
      const int next = is_gold_ ? text_.number() : ValuesText::number_in(std::string_view(*line).substr(4));
      const vtkIdType part = next > 0 ? Tables::part(reader_, next - 1) : -1;
      auto* const grid = part < 0 || part >= parts_.GetNumberOfBlocks()
                             ? nullptr
                             : vtkDataSet::SafeDownCast(parts_.GetBlock(static_cast<unsigned>(part)));
      if (grid == nullptr) return {text_.is_at_end() ? end_after(number) : "", {}};
      number = next;
      Found found = values_.of_points ? points_of(*grid, line) : cells_of(*grid, part, line);
      if (found == Found::other && text_.is_at_end()) found = Found::too_few;
      if (found != Found::all) return {found == Found::too_few ? fmt::format("inside part {}", number) : "", {}};
      is_there[static_cast<std::size_t>(part)] = true;
    }
    if (line ? part_word.starts_with(*line) && text_.is_at_end() : text_.is_cut_off()) return {end_after(number), {}};
    return {"", has_nodes ? std::vector<std::string>() : absent(is_there)};
  }

 private:
  static std::string end_after(int part) {
    return part == 0 ? std::string("before its values") : fmt::format("after part {}", part);
  }

  Found reals(vtkIdType tuples) {
    return text_.reals(static_cast<std::uint64_t>(tuples) * static_cast<std::uint64_t>(values_.components));
  }

  /// Reads the values after a header: for all tuples, for all except those with a certain value (`undef`), or for
  /// listed tuples (`partial`).
  Found values_after(std::string_view header, vtkIdType tuples) {
    if (header.ends_with(" undef")) {
      if (const Found found = text_.reals(1); found != Found::all) return found;
    } else if (header.ends_with(" partial")) {
      tuples = text_.number();
      if (const Found found = text_.integers(static_cast<std::uint64_t>(tuples)); found != Found::all) return found;
    }
    return reals(tuples);
  }

  /// Returns the number of nodes, which all unstructured parts of EnSight 6 share.
  vtkIdType nodes() {
    vtkPoints* points = nullptr;
    if (auto* const text = vtkEnSight6Reader::SafeDownCast(&reader_)) points = TextNodes::of(*text);
    if (auto* const binary = vtkEnSight6BinaryReader::SafeDownCast(&reader_)) points = BinaryNodes::of(*binary);
    return points != nullptr ? points->GetNumberOfPoints() : 0;
  }

  /// Reads a part, up to the next header.
  Found points_of(vtkDataSet& grid, std::optional<std::string>& line) {
    Found found = Found::all;
    if (grid.GetNumberOfPoints() > 0) {
      line = text_.header();
      if (!line) return Found::too_few;
      const std::string_view word = std::string_view(*line).substr(0, line->find(' '));
      found = word == "coordinates" || word == "block" ? values_after(*line, grid.GetNumberOfPoints()) : Found::other;
    }
    line = text_.header();
    return found;
  }

  Found cells_of(vtkDataSet& grid, vtkIdType part, std::optional<std::string>& line) {
    const vtkIdType index = Tables::unstructured(reader_, part);
    std::vector<bool> is_there(Tables::types);
    bool is_empty = true;
    const auto is_of_cells = [&] { return line && !line->starts_with("part") && !part_word.starts_with(*line); };
    for (line = text_.header(); is_of_cells(); line = text_.header()) {
      vtkIdType cells = grid.GetNumberOfCells();
      const std::string word = line->substr(0, line->find(' '));
      if (word != "block") {
        const int type = Tables::type(reader_, word.c_str());
        if (index < 0 || type < 0) return Found::other;
        cells = Tables::cells(reader_, index, type).GetNumberOfIds();
        is_there[static_cast<std::size_t>(type)] = true;
      }
      if (const Found found = values_after(*line, cells); found != Found::all) return found;
      is_empty = false;
    }
    if (is_empty && !line && grid.GetNumberOfCells() > 0) return Found::too_few;
    if (index >= 0) blank_types(grid, index, is_there);
    return Found::all;
  }

  /// Sets values of cells to NaN if the file has no values for their type, because VTK leaves these values
  /// uninitialized.
  void blank_types(vtkDataSet& grid, vtkIdType index, const std::vector<bool>& is_there) {
    vtkDataArray* const array = grid.GetCellData()->GetArray(values_.variable.c_str());
    for (int type = 0; array != nullptr && type < Tables::types; ++type) {
      if (is_there[static_cast<std::size_t>(type)]) continue;
      for (const vtkIdType cell : Tables::cells(reader_, index, type))
        for (int k = 0; k < array->GetNumberOfComponents(); ++k)
          array->SetComponent(cell, k, std::numeric_limits<double>::quiet_NaN());
    }
  }

  /// Returns the names of the parts that have solid cells but no values.
  std::vector<std::string> absent(const std::vector<bool>& is_there) {
    std::vector<std::string> names;
    for (unsigned part = 0; part < parts_.GetNumberOfBlocks(); ++part) {
      auto* const grid = vtkDataSet::SafeDownCast(parts_.GetBlock(part));
      if (is_there[part] || grid == nullptr || !has_solid_cells(*grid)) continue;
      const char* const name = parts_.GetMetaData(part)->Get(vtkCompositeDataSet::NAME());
      names.emplace_back(name != nullptr && *name != '\0' ? name : fmt::format("{}", part + 1));
    }
    return names;
  }

  static bool has_solid_cells(vtkDataSet& grid) {
    const vtkNew<vtkCellTypes> types;
    grid.GetCellTypes(types);
    const vtkNew<vtkGenericCell> cell;
    for (vtkIdType k = 0; k < types->GetNumberOfTypes(); ++k) {
      cell->SetCellType(types->GetCellType(k));
      if (cell->GetCellDimension() == 3) return true;
    }
    return false;
  }

  vtkEnSightReader& reader_;
  vtkMultiBlockDataSet& parts_;
  const EnsightCase::Values& values_;
  bool is_gold_;
  ValuesText text_;
};

}  // namespace

EnsightValues values_in(vtkGenericEnSightReader& reader, vtkDataObject& data, const EnsightCase::Values& values) {
  auto* const with_tables = vtkEnSightReader::SafeDownCast(reader.GetReader());
  auto* const parts = vtkMultiBlockDataSet::SafeDownCast(&data);
  if (with_tables == nullptr || parts == nullptr) return {};
  if (std::error_code unknown; std::filesystem::file_size(values.file, unknown) == 0) return {"before its values", {}};
  const io::WholeFile file(values.file);
  return ValuesWalk(*with_tables, *parts, values, file.text()).walk();
}

bool ends_with_part(const EnsightCase::Values& values) {
  if (std::error_code unknown; std::filesystem::file_size(values.file, unknown) == 0) return false;
  const io::WholeFile file(values.file);
  const std::string_view text = file.text();
  const std::size_t end = text.find_last_not_of(std::string_view(" \t\r\n\0", 5));
  return end != std::string_view::npos && text.substr(0, end + 1).ends_with(part_word);
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

}  // namespace tessera::readers
