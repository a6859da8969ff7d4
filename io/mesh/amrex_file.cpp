// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/amrex_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <map>
#include <vector>

#include "io/files/whole_file.hpp"
#include "io/mesh/amrex_header.hpp"
#include "io/text/text_file.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

/// The storage format of numbers, which the line before the numbers declares.
struct NumberFormat {
  std::string_view words;
  std::size_t bytes;
  bool big_endian;
};
constexpr std::array formats = {
    NumberFormat{"((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))", 8, false},
    NumberFormat{"((8, (64 11 52 0 1 12 0 1023)),(8, (1 2 3 4 5 6 7 8)))", 8, true},
    NumberFormat{"((8, (32 8 23 0 1 9 0 127)),(4, (4 3 2 1)))", 4, false},
    NumberFormat{"((8, (32 8 23 0 1 9 0 127)),(4, (1 2 3 4)))", 4, true},
};

/// The numbers of one field of one box. The file is opened for each read, because there may be more files than the
/// process may open at once.
struct FabNumbers {
  std::filesystem::path file;
  std::uint64_t offset = 0;
  std::size_t bytes = 8;
  bool swap = false;
  AmrexBox box, stored;

  /// Reads the numbers of the box's cells, x fastest. The stored array may include cells around the box.
  void read(std::size_t first, std::span<double> out) const {
    const auto nx = static_cast<std::size_t>(box.cells(0)), ny = static_cast<std::size_t>(box.cells(1)),
               row = static_cast<std::size_t>(stored.cells(0)), slice = row * static_cast<std::size_t>(stored.cells(1));
    const auto dx = static_cast<std::size_t>(box.low[0] - stored.low[0]),
               dy = static_cast<std::size_t>(box.low[1] - stored.low[1]),
               dz = static_cast<std::size_t>(box.low[2] - stored.low[2]);
    const auto place_of = [&](std::size_t cell) {
      return cell % nx + dx + row * (cell / nx % ny + dy) + slice * (cell / nx / ny + dz);
    };
    const system::PositionalFile opened(file);
    std::vector<std::byte> stored_bytes;
    for (std::size_t n = 0; n < out.size();) {
      // Extends the read over several rows as long as the gaps between the rows are not most of the bytes.
      std::size_t end = n + std::min(nx - (first + n) % nx, out.size() - n);
      const std::size_t begin = place_of(first + n);
      while (end < out.size()) {
        const std::size_t further = std::min(end + nx, out.size());
        if (place_of(first + further - 1) - begin > 2 * (further - n) || further - n > most_at_once) break;
        end = further;
      }
      stored_bytes.resize((place_of(first + end - 1) - begin + 1) * bytes);
      opened.read(offset + begin * bytes, stored_bytes.data(), stored_bytes.size());
      for (; n < end; ++n) out[n] = number_at(stored_bytes.data() + (place_of(first + n) - begin) * bytes);
    }
  }

 private:
  static constexpr std::size_t most_at_once = 1 << 17;

  [[nodiscard]] double number_at(const std::byte* start) const {
    return bytes == 4 ? static_cast<double>(scene::load<float>(start, swap)) : scene::load<double>(start, swap);
  }
};

class PlotFile {
 public:
  explicit PlotFile(std::filesystem::path folder) : folder_(std::move(folder)) {}

  OpenedAmr open() {
    const std::filesystem::path file = folder_ / "Header";
    const WholeFile text(file);
    header_ = parse_amrex_header(text.text(), file.string());
    opened_.format = "AMReX plot file";
    for (std::size_t level = 0; level < header_.levels.size(); ++level) add_level(level);
    for (const ForeignPart& part : opened_.parts) opened_.blocks.push_back({nullptr, &part});
    return std::move(opened_);
  }

 private:
  void add_level(std::size_t number) {
    const AmrexLevel& level = header_.levels[number];
    const std::filesystem::path list = folder_ / (level.cells + "_H");
    const WholeFile text(list);
    std::vector<AmrexFab> fabs = parse_amrex_level(text.text(), header_.fields.size(), list.string());
    for (std::size_t n = 0; n < fabs.size(); ++n) {
      AmrexFab& fab = fabs[n];
      const std::string name = fmt::format("level {} box {}", number, n);
      ForeignPart part;
      part.kind = ForeignPart::Kind::image;
      part.name = name;
      part.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t low = fab.box.low[a] - level.domain.low[a];
        part.extent[2 * a] = low, part.extent[2 * a + 1] = low + fab.box.cells(a);
        part.origin[a] = header_.low[a], part.spacing[a] = level.spacing[a];
      }
      opened_.parts.push_back(std::move(part));
      opened_.fields.push_back(fields_of(fab, list.parent_path() / fab.file, name));
    }
  }

  cells::CellBlock fields_of(AmrexFab& fab, const std::filesystem::path& file, const std::string& name) {
    FabNumbers numbers = numbers_of(fab, file);
    cells::CellBlock block;
    block.name = name;
    std::size_t cells = 1, stored = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      cells *= static_cast<std::size_t>(fab.box.cells(a));
      stored *= static_cast<std::size_t>(fab.stored.cells(a));
    }
    for (const std::string& field : header_.fields) {
      cells::BlockField added;
      added.name = field;
      added.association = scene::Association::cell;
      added.type = numbers.bytes == 4 ? "float" : "double";
      added.tuples = cells;
      added.read = [numbers](int, std::size_t first, std::span<double> out) { numbers.read(first, out); };
      block.fields.push_back(std::move(added));
      numbers.offset += stored * numbers.bytes;
    }
    return block;
  }

  /// Parses the line before the numbers: FAB, the format of numbers, the box and the number of fields.
  FabNumbers numbers_of(AmrexFab& fab, const std::filesystem::path& file) {
    const system::PositionalFile opened(file);
    const auto [known_file, is_new] = files_.try_emplace(file.string(), opened.size());
    const std::uint64_t size = known_file->second;
    if (is_new) bytes_there_ += size;
    const auto refuse = [&](const std::string& what) {
      return scene::bad_input(fmt::format("{}: at byte {}: {}", file.string(), fab.offset, what));
    };
    constexpr std::size_t longest = 512;
    std::string beginning(std::min<std::uint64_t>(longest, size - std::min<std::uint64_t>(fab.offset, size)), '\0');
    opened.read(fab.offset, reinterpret_cast<std::byte*>(beginning.data()), beginning.size());
    std::string_view line = std::string_view(beginning).substr(0, beginning.find('\n'));
    const std::uint64_t begin = fab.offset + line.size() + 1;
    if (!line.starts_with("FAB "))
      throw refuse("the values there do not begin with FAB; the file is truncated or damaged, write it again");
    line.remove_prefix(4);
    const auto* const format = std::find_if(formats.begin(), formats.end(),
                                            [&](const NumberFormat& known) { return line.starts_with(known.words); });
    if (format == formats.end())
      throw refuse(fmt::format("its numbers have the format {}; write IEEE numbers of 32 or 64 bits",
                               quote(line.substr(0, line.find(")))") + 3))));
    line.remove_prefix(format->words.size());
    std::size_t fields = 0;
    fab.stored = parse_amrex_fab(line, fields, fmt::format("{}: at byte {}", file.string(), fab.offset));
    if (fields != header_.fields.size())
      throw refuse(fmt::format("it has {} fields there, but the Header lists {}; write the file again", fields,
                               header_.fields.size()));
    std::uint64_t bytes = format->bytes * fields;
    for (std::size_t a = 0; a < 3; ++a) {
      if (fab.stored.low[a] > fab.box.low[a] || fab.stored.high[a] < fab.box.high[a])
        throw refuse(fmt::format(
            "its values belong to cells {} to {} along {}, but its box has cells {} to {}; write the file again",
            fab.stored.low[a], fab.stored.high[a], "xyz"[a], fab.box.low[a], fab.box.high[a]));
      if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(fab.stored.cells(a)), &bytes)) bytes = UINT64_MAX;
    }
    if (begin > size || bytes > size - begin)
      throw refuse(
          fmt::format("{} bytes of values begin there, but the file has only {} bytes; it is truncated, write it again",
                      bytes, size));
    bytes_used_ += bytes;
    if (bytes_used_ > bytes_there_)  // bounds the memory per box by the size of the files
      throw refuse("several boxes refer to the same values; the file is damaged, write it again");
    return {file, begin, format->bytes, scene::is_swapped(format->big_endian), fab.box, fab.stored};
  }

  std::filesystem::path folder_;
  AmrexHeader header_;
  OpenedAmr opened_;
  std::map<std::string, std::uint64_t> files_;  ///< their sizes
  std::uint64_t bytes_there_ = 0, bytes_used_ = 0;
};

}  // namespace

OpenedAmr open_amrex(const std::filesystem::path& file) {
  std::error_code unknown;
  std::filesystem::path folder = std::filesystem::is_directory(file, unknown) ? file : file.parent_path();
  return PlotFile(std::move(folder)).open();
}

}  // namespace tessera::io
