// SPDX-License-Identifier: BSD-3-Clause
// EnSight files of several time steps, text, C binary or Fortran binary, according to the EnSight User Manual
// ("Transient single file format"): each step is between the lines, or records of 80 bytes, BEGIN TIME STEP and END
// TIME STEP.
#include "readers/vtk/ensight_step.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "system/descriptor.hpp"

namespace tessera::readers {
namespace {

constexpr std::string_view begin_words = "BEGIN TIME STEP", end_words = "END TIME STEP";

/// The text of a step: the lines that precede all steps (`C Binary`), and the lines of the step.
struct StepText {
  std::string_view before, lines;
};

StepText step_text(std::string_view text, std::size_t step, bool in_set) {
  std::size_t begin = text.find(begin_words);
  if (begin == std::string_view::npos) return step == 0 || !in_set ? StepText{text, {}} : StepText{};
  constexpr std::size_t record = 80;
  const std::size_t after = text.find_first_not_of(" \t\r", begin + begin_words.size());
  const bool is_text = after == std::string_view::npos || text[after] == '\n';
  // Fortran stores the length of each record before and after the record.
  const std::string_view mark = text.substr(std::min(text.size(), begin + record), 4);
  const std::size_t mark_bytes =
      !is_text && begin >= 4 && mark.size() == 4 && mark == text.substr(begin - 4, 4) ? 4 : 0;
  const std::string_view before = text.substr(0, begin - mark_bytes);
  for (; step > 0; --step) {
    begin = text.find(begin_words, std::min(text.find(end_words, begin), text.size()));
    if (begin == std::string_view::npos) return {};
  }
  const std::size_t first = is_text ? std::min(text.find('\n', begin), text.size() - 1) + 1
                                    : std::min(text.size(), begin + record + mark_bytes);
  const std::size_t end = text.find(end_words, first);
  return {before, text.substr(first, end == std::string_view::npos ? end : end - mark_bytes - first)};
}

}  // namespace

EnsightStep::EnsightStep(const EnsightCase& described, double time) {
  std::string geometry, variables;
  const std::vector<EnsightCase::Located> located = described.located(time);
  std::vector<std::filesystem::path> files;
  files.reserve(located.size());
  for (const EnsightCase::Located& each : located) files.push_back(file_of(each));
  for (std::size_t k = 0; k < located.size(); ++k) {
    const EnsightCase::Values& values = located[k].values;
    std::string names = files[k].filename();
    if (values.variable.empty()) {
      geometry = fmt::format("model: 1 1 {}\n", names);
      continue;
    }
    if (located[k].kind.find("complex") != std::string::npos) {
      const bool is_whole = k + 1 < located.size() && located[k + 1].values.variable == values.variable;
      if (!is_whole) continue;
      names += fmt::format(" {} 1", files[++k].filename().string());
    }
    variables += fmt::format("{}: 1 1 {} {}\n", located[k].kind, values.variable, names);
    if (values.components == 0) continue;
    values_.push_back(values);
    values_.back().file = files[k];
  }
  const char* const type = described.is_gold() ? "ensight gold" : "ensight";
  const std::string text = fmt::format("FORMAT\ntype: {}\nGEOMETRY\n{}VARIABLE\n{}", type, geometry, variables);
  case_file_ = in_memory(text, {});
}

std::filesystem::path EnsightStep::keep(system::Descriptor opened) {
  opened_.push_back(std::move(opened));
  return fmt::format("/proc/{}/fd/{}", ::getpid(), opened_.back().get());
}

std::filesystem::path EnsightStep::in_memory(std::string_view before, std::string_view lines) {
  system::Descriptor file(::memfd_create("tessera", MFD_CLOEXEC));
  if (!file.is_open() || !system::write_all(file.get(), before.data(), before.size()) ||
      !system::write_all(file.get(), lines.data(), lines.size()))
    throw std::bad_alloc();
  return keep(std::move(file));
}

std::filesystem::path EnsightStep::file_of(const EnsightCase::Located& located) {
  const std::filesystem::path& file = located.values.file;
  const auto as_it_is = [&] { return keep(system::open_regular(file, file.string())); };
  if (std::error_code unknown; std::filesystem::file_size(file, unknown) == 0) return as_it_is();
  const io::WholeFile mapped(file);
  const StepText text = step_text(mapped.text(), located.step, located.in_set);
  if (text.before.size() == mapped.text().size()) return as_it_is();
  return in_memory(text.before, text.lines);
}

}  // namespace tessera::readers
