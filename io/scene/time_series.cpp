// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/time_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/files/input_file.hpp"
#include "io/text/json_text.hpp"
#include "io/text/text_file.hpp"
#include "io/text/xml_elements.hpp"
#include "io/vtk/vtk_field_words.hpp"
#include "scene/error.hpp"
#include "system/files_read.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// A pattern of file names that contain a number, like printf's %d or %0Nd.
struct Pattern {
  std::string before, after;
  int width = 0;

  /// Returns the number with which the pattern gives this name; no value if there is none.
  [[nodiscard]] std::optional<std::uint64_t> number_in(const std::string& name) const {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
      return std::nullopt;
    const std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
    const auto number = number_of<std::uint64_t>(digits);
    if (number && fmt::format("{:0{}}", *number, width) != digits) return std::nullopt;  // 7 is not 007
    return number;
  }
};

std::optional<Pattern> pattern_of(const std::string& name) {
  for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
    std::size_t end = at + 1;
    int width = 0;
    if (end < name.size() && name[end] == '0') {
      const std::size_t first = ++end;
      while (end < name.size() && end < first + 2 && name[end] >= '0' && name[end] <= '9')
        width = 10 * width + (name[end++] - '0');
      if (end == first) continue;
    }
    if (end < name.size() && name[end] == 'd') return Pattern{name.substr(0, at), name.substr(end + 1), width};
  }
  return std::nullopt;
}

bool is_file_series(const std::filesystem::path& input) { return system::lower_extension(input) == ".series"; }
bool is_pvd(const std::filesystem::path& input) { return system::lower_extension(input) == ".pvd"; }

/// Sets the times to those in the numbered VTK files, if all of the files contain one.
void set_own_times(std::vector<TimeStep>& steps) {
  std::vector<double> times;
  for (const TimeStep& step : steps) {
    const auto time = vtk_time_value(step.files.front());
    if (!time) return;
    times.push_back(*time);
  }
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].time = times[k], steps[k].has_time = true;
}

std::vector<TimeStep> read_pattern(const std::filesystem::path& input, const Pattern& pattern) {
  const std::filesystem::path folder = input.has_parent_path() ? input.parent_path() : std::filesystem::path(".");
  std::vector<std::pair<std::uint64_t, std::filesystem::path>> found;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (const auto number = pattern.number_in(name)) found.emplace_back(*number, input.parent_path() / name);
  }
  if (error)
    throw scene::bad_input(
        fmt::format("{}: the directory cannot be listed: {}; check its name", input.string(), error.message()));
  if (found.empty())
    throw scene::bad_input(fmt::format("{}: no file has a name of this pattern, which would be like {}", input.string(),
                                       fmt::format("{}{:0{}}{}", pattern.before, 1, pattern.width, pattern.after)));
  std::sort(found.begin(), found.end());
  std::vector<TimeStep> steps;
  steps.reserve(found.size());
  for (auto& [number, file] : found) steps.push_back({static_cast<double>(number), {std::move(file)}});
  set_own_times(steps);
  return steps;
}

std::vector<TimeStep> read_pvd(const std::filesystem::path& input) {
  struct Entry {
    double time;
    bool has_time;
    long part;
    std::filesystem::path file;
  };
  const std::string source = input.string();
  require_file(input);
  std::vector<Entry> entries;
  bool root_seen = false;
  each_xml_element(read_text_file(input), source, [&](const XmlElement& element) {
    if (!root_seen) {
      const std::string* type = element.find("type");
      if (element.name != "VTKFile" || type == nullptr || *type != "Collection")
        throw scene::bad_input(
            fmt::format("{}: it begins with <{}>, not <VTKFile type=\"Collection\">; check that it is a .pvd", source,
                        element.name.substr(0, 40)));
      root_seen = true;
    }
    if (element.name != "DataSet") return;
    const auto fail = [&](const std::string& what) {
      return scene::bad_input(fmt::format("{}: DataSet {} {}; write the file again", source, entries.size(), what));
    };
    Entry entry{0, false, 0, {}};
    if (const std::string* time = element.find("timestep")) {
      const auto value = parse_number(*time);
      if (!value) throw fail(fmt::format("has the timestep {}, which is not a finite number", quote(*time)));
      entry.time = *value, entry.has_time = true;
    }
    if (const std::string* part = element.find("part"); part != nullptr && !part->empty()) {
      const auto [end, error] = std::from_chars(part->data(), part->data() + part->size(), entry.part);
      if (error != std::errc() || end != part->data() + part->size())
        throw fail(fmt::format("has the part {}, which is not a whole number", quote(*part)));
    }
    const std::string* file = element.find("file");
    if (file == nullptr || file->empty()) throw fail("names no file");
    entry.file = input.parent_path() / *file;
    entries.push_back(std::move(entry));
  });
  if (entries.empty()) throw scene::bad_input(fmt::format("{}: it lists no DataSet; write the file again", source));
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.time != b.time ? a.time < b.time : a.part < b.part; });
  std::vector<TimeStep> steps;
  for (Entry& entry : entries) {
    if (steps.empty() || steps.back().time != entry.time) steps.push_back({entry.time, {}, {}, entry.has_time});
    steps.back().files.push_back(std::move(entry.file));
  }
  return steps;
}

}  // namespace

std::vector<TimeStep> parse_file_series(std::string_view text, const std::filesystem::path& input) {
  const std::string source = input.string();
  const nlohmann::json json = parse_json(text, source);
  const auto files = json.is_object() ? json.find("files") : json.end();
  if (!json.is_object() || files == json.end() || !files->is_array())
    throw scene::bad_input(
        fmt::format("{}: it has no list \"files\"; check that it is a ParaView file series", source));
  if (files->empty()) throw scene::bad_input(fmt::format("{}: it lists no file; write the file again", source));
  std::vector<TimeStep> steps;
  for (const nlohmann::json& entry : *files) {
    const auto fail = [&](const char* what) {
      return scene::bad_input(
          fmt::format("{}: entry {} of \"files\" {}; write the file again", source, steps.size(), what));
    };
    const auto name = entry.is_object() ? entry.find("name") : entry.end();
    if (!entry.is_object() || name == entry.end() || !name->is_string() || name->get<std::string>().empty())
      throw fail("has no \"name\"");
    const auto time = entry.find("time");
    if (time != entry.end() && !time->is_number()) throw fail("has a \"time\" that is not a number");
    steps.push_back({time == entry.end() ? static_cast<double>(steps.size()) : time->get<double>(),
                     {input.parent_path() / name->get<std::string>()},
                     {},
                     time != entry.end()});
  }
  std::stable_sort(steps.begin(), steps.end(), [](const TimeStep& a, const TimeStep& b) { return a.time < b.time; });
  return steps;
}

void require_input(const std::filesystem::path& input) {
  if (is_time_series(input))
    read_time_series(input);
  else
    require_file(input);
}

}  // namespace tessera::io

namespace tessera {
inline namespace v0_1 {

bool is_time_series(const std::filesystem::path& input) {
  if (io::is_pvd(input) || io::is_file_series(input)) return true;
  std::error_code absent;
  return io::pattern_of(input.filename().string()).has_value() && !std::filesystem::exists(input, absent);
}

namespace {

std::vector<TimeStep> steps_of_series(const std::filesystem::path& input) {
  if (io::is_pvd(input)) return io::read_pvd(input);
  if (io::is_file_series(input)) {
    io::require_file(input);
    return io::parse_file_series(io::read_text_file(input), input);
  }
  const auto pattern = io::pattern_of(input.filename().string());
  if (!pattern)
    throw scene::bad_input(fmt::format(
        "{}: is not a time series; give a .pvd or .series, or a name with %04d for the number", input.string()));
  return io::read_pattern(input, *pattern);
}

}  // namespace

std::vector<TimeStep> read_time_series(const std::filesystem::path& input) {
  std::vector<TimeStep> steps = steps_of_series(input);
  for (const TimeStep& step : steps)
    for (const auto& file : step.files) system::note_named(file);
  return steps;
}

std::optional<std::string> numbered_name(const std::string& pattern, int number) {
  const auto parts = io::pattern_of(pattern);
  if (!parts) return std::nullopt;
  return fmt::format("{}{:0{}}{}", parts->before, number, parts->width, parts->after);
}

}  // namespace v0_1
}  // namespace tessera
