#include "io/amrex_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <memory>

#include "io/amrex_header.hpp"
#include "io/mapped_file.hpp"
#include "io/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// How numbers are stored, as the line before them says it.
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

template <class Word>
Word swapped(Word word, bool swap) {
  if (!swap) return word;
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(Word)>>(word);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Word>(bytes);
}

/// The numbers of one field of one box, in a mapped file.
struct FabNumbers {
  std::shared_ptr<const MappedFile> file;
  std::size_t offset = 0;
  std::size_t bytes = 8;
  bool swap = false;
  AmrexBox box, stored;

  [[nodiscard]] double at(std::size_t number) const {
    const std::byte* const start = file->bytes().data() + offset + number * bytes;
    if (bytes == 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, start, sizeof word);
      return std::bit_cast<float>(swapped(word, swap));
    }
    std::uint64_t word = 0;
    std::memcpy(&word, start, sizeof word);
    return std::bit_cast<double>(swapped(word, swap));
  }

  /// The numbers of the box's cells, x first, of which there may be more around.
  void read(std::size_t first, std::span<double> out) const {
    const auto nx = static_cast<std::size_t>(box.cells(0)), ny = static_cast<std::size_t>(box.cells(1)),
               row = static_cast<std::size_t>(stored.cells(0)), slice = row * static_cast<std::size_t>(stored.cells(1));
    const auto dx = static_cast<std::size_t>(box.low[0] - stored.low[0]),
               dy = static_cast<std::size_t>(box.low[1] - stored.low[1]),
               dz = static_cast<std::size_t>(box.low[2] - stored.low[2]);
    for (std::size_t n = 0; n < out.size();) {
      const std::size_t cell = first + n, i = cell % nx, j = cell / nx % ny, k = cell / nx / ny,
                        start = i + dx + row * (j + dy) + slice * (k + dz), end = std::min(nx - i, out.size() - n);
      for (std::size_t x = 0; x < end; ++x) out[n + x] = at(start + x);
      n += end;
    }
  }
};

class PlotFile {
 public:
  explicit PlotFile(std::filesystem::path folder) : folder_(std::move(folder)) {}

  OpenedAmr open() {
    const std::filesystem::path file = folder_ / "Header";
    const MappedFile text(file);
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
    const MappedFile text(list);
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

  CellBlock fields_of(AmrexFab& fab, const std::filesystem::path& file, const std::string& name) {
    FabNumbers numbers = numbers_of(fab, file);
    CellBlock block;
    block.name = name;
    std::size_t cells = 1, stored = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      cells *= static_cast<std::size_t>(fab.box.cells(a));
      stored *= static_cast<std::size_t>(fab.stored.cells(a));
    }
    for (const std::string& field : header_.fields) {
      BlockField added;
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

  /// FAB, the format of numbers, the box and how many fields there are; then the numbers.
  FabNumbers numbers_of(AmrexFab& fab, const std::filesystem::path& file) {
    std::shared_ptr<const MappedFile>& mapped = files_[file.string()];
    if (mapped == nullptr) {
      mapped = std::make_shared<const MappedFile>(file);
      bytes_there_ += mapped->bytes().size();
    }
    const auto refuse = [&](const std::string& what) {
      return scene::bad_input(fmt::format("{}: at byte {}: {}", file.string(), fab.offset, what));
    };
    constexpr std::size_t longest = 512;
    const std::string_view all = mapped->text();
    const std::string_view rest = all.substr(std::min<std::size_t>(fab.offset, all.size()));
    std::string_view line = rest.substr(0, std::min(rest.find('\n'), longest));
    const std::size_t begin = static_cast<std::size_t>(fab.offset) + line.size() + 1;
    if (!line.starts_with("FAB "))
      throw refuse("no values begin there with FAB; the file is truncated or damaged, write it anew");
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
      throw refuse(fmt::format("{} fields are there, the Header has {}; write it anew", fields, header_.fields.size()));
    std::uint64_t bytes = format->bytes * fields;
    for (std::size_t a = 0; a < 3; ++a) {
      if (fab.stored.low[a] > fab.box.low[a] || fab.stored.high[a] < fab.box.high[a])
        throw refuse(
            fmt::format("its values are those of cells {} to {} along {}, its box has cells {} to {}; write "
                        "it anew",
                        fab.stored.low[a], fab.stored.high[a], "xyz"[a], fab.box.low[a], fab.box.high[a]));
      if (__builtin_mul_overflow(bytes, static_cast<std::uint64_t>(fab.stored.cells(a)), &bytes)) bytes = UINT64_MAX;
    }
    if (begin > all.size() || bytes > all.size() - begin)
      throw refuse(fmt::format("{} bytes of values begin there, the file has {} bytes; it is truncated, write it anew",
                               bytes, all.size()));
    bytes_used_ += bytes;
    if (bytes_used_ > bytes_there_)  // so that what is kept of each box is in proportion to the files
      throw refuse("boxes share their values; it is damaged, write it anew");
    return {mapped,  begin,     format->bytes, format->big_endian != (std::endian::native == std::endian::big),
            fab.box, fab.stored};
  }

  std::filesystem::path folder_;
  AmrexHeader header_;
  OpenedAmr opened_;
  std::map<std::string, std::shared_ptr<const MappedFile>> files_;
  std::uint64_t bytes_there_ = 0, bytes_used_ = 0;
};

}  // namespace

OpenedAmr open_amrex(const std::filesystem::path& file) {
  std::error_code unknown;
  std::filesystem::path folder = std::filesystem::is_directory(file, unknown) ? file : file.parent_path();
  return PlotFile(std::move(folder)).open();
}

}  // namespace tessera::io
