// SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 and Gold case files, according to the EnSight User Manual ("EnSight Gold Case File Format").
#include "readers/vtk/ensight_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "readers/common/opened_files.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

bool is_count(const std::string& word) {
  return !word.empty() && word.size() < 9 && word.find_first_not_of("0123456789") == std::string::npos;
}

/// Removes the numbers of a time set and a file set from the beginning of the words, and returns them.
std::pair<int, int> take_sets(std::vector<std::string>& words, std::size_t names) {
  int time_set = 1, file_set = 0;
  for (int k = 0; k < 2 && words.size() > names && is_count(words.front()); ++k) {
    (k == 0 ? time_set : file_set) = std::stoi(words.front());
    words.erase(words.begin());
  }
  return {time_set, file_set};
}

int components_of(const std::string& kind) {
  const auto has = [&](const char* word) { return kind.find(word) != std::string::npos; };
  return has("scalar") ? 1 : has("vector") ? 3 : has("tensor symm") ? 6 : has("tensor asym") ? 9 : 0;
}

std::string without_quotes(std::string name) {
  if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return name;
}

}  // namespace

EnsightCase::EnsightCase(const std::filesystem::path& file)
    : folder_(file.has_parent_path() ? file.parent_path() : std::filesystem::path(".")) {
  std::ifstream text(file);
  std::string section, list;
  TimeSet* set = nullptr;
  std::vector<InFileSet>* files = nullptr;
  constexpr std::size_t most_lines = 1 << 20;
  std::size_t lines = 0;
  for (std::string line; std::getline(text, line) && lines < most_lines; ++lines) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    if (words.size() == 1 && std::ranges::all_of(words[0], [](char c) { return c >= 'A' && c <= 'Z'; }))
      section = words[0];
    else if (section == "FORMAT")
      is_gold_ = is_gold_ || line.find("gold") != std::string::npos;
    else if (section == "GEOMETRY")
      read_geometry(line);
    else if (section == "VARIABLE")
      read_variable(line);
    else if (section == "TIME")
      read_time(line, set, list);
    else if (section == "FILE")
      read_file_set(line, files);
  }
}

void EnsightCase::read_geometry(const std::string& line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return;
  std::vector<std::string> words = words_of(line.substr(colon + 1));
  const auto [time_set, file_set] = take_sets(words, 1);
  if (words.empty()) return;
  const bool is_model = line.substr(0, colon).find("model") != std::string::npos;
  (is_model ? named_ : beside_).push_back({"model", "", without_quotes(words.front()), time_set, file_set});
}

/// Parses a line `scalar per node: [ts] [fs] NAME FILE`. A complex variable has two files and a frequency; a constant
/// has no file.
void EnsightCase::read_variable(const std::string& line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return;
  const std::string kind = line.substr(0, colon);
  const bool is_complex = kind.find("complex") != std::string::npos;
  if (kind.find("per node") == std::string::npos && kind.find("per element") == std::string::npos) return;
  if (kind.find("measured") != std::string::npos) return;
  std::vector<std::string> words = words_of(line.substr(colon + 1));
  const auto [time_set, file_set] = take_sets(words, is_complex ? 3 : 2);
  const bool of_points = kind.find("per node") != std::string::npos;
  for (std::size_t k = 1; k < words.size() && k < (is_complex ? 3u : 2u); ++k)
    named_.push_back(
        {kind, words.front(), without_quotes(words[k]), time_set, file_set, of_points, components_of(kind)});
}

void EnsightCase::read_time(const std::string& line, TimeSet*& set, std::string& list) {
  const std::size_t colon = line.find(':');
  std::vector<std::string> words = words_of(line.substr(colon == std::string::npos ? 0 : colon + 1));
  if (colon != std::string::npos) {
    list = line.substr(0, colon);
    if (list.find("time set") != std::string::npos && !words.empty() && is_count(words.front())) {
      set = &sets_[std::stoi(words.front())];
      return;
    }
  }
  if (set == nullptr) return;
  for (const std::string& word : words) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (end == word.c_str()) continue;
    if (list.find("time values") != std::string::npos)
      set->times.push_back(static_cast<float>(number));  // rounded to float, as in VTK
    if (list.find("filename numbers") != std::string::npos) set->numbers.push_back(static_cast<long>(number));
    if (list.find("filename start number") != std::string::npos) set->start = static_cast<long>(number);
    if (list.find("filename increment") != std::string::npos) set->increment = static_cast<long>(number);
  }
}

void EnsightCase::read_file_set(const std::string& line, std::vector<InFileSet>*& set) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) return;
  const std::string key = line.substr(0, colon);
  const std::vector<std::string> words = words_of(line.substr(colon + 1));
  if (words.empty() || !is_count(words.front())) return;
  const int number = std::stoi(words.front());
  if (key.find("file set") != std::string::npos) set = &file_sets_[number];
  if (set == nullptr) return;
  if (key.find("filename index") != std::string::npos) set->push_back({number, 0});
  if (key.find("number of steps") == std::string::npos) return;
  if (set->empty()) set->push_back({});
  set->back().steps = static_cast<std::size_t>(number);
}

EnsightCase::Place EnsightCase::place_of(const Named& named, double time) const {
  const std::size_t first = named.pattern.find('*');
  const auto found = sets_.find(named.time_set);
  if (found == sets_.end()) return {first == std::string::npos ? named.pattern : "", 0};
  const TimeSet& set = found->second;
  Place place{named.pattern, 0};
  while (place.step + 1 < set.times.size() && set.times[place.step + 1] <= time) ++place.step;
  std::optional<long> number;
  if (set.numbers.empty())
    number = set.start + static_cast<long>(place.step) * set.increment;
  else if (place.step < set.numbers.size())
    number = set.numbers[place.step];
  if (const auto files = file_sets_.find(named.file_set); files != file_sets_.end() && !files->second.empty()) {
    auto file = files->second.begin();
    for (; file + 1 != files->second.end() && place.step >= file->steps; ++file) place.step -= file->steps;
    number = file->number;
  }
  if (first == std::string::npos) return place;
  if (!number) return {};
  const std::size_t last = named.pattern.find_last_of('*');
  place.file.replace(first, last + 1 - first, fmt::format("{:0{}}", *number, last + 1 - first));
  return place;
}

std::vector<EnsightCase::Missing> EnsightCase::missing(double time) const {
  std::vector<Missing> missing;
  for (const Named& named : named_) {
    const std::string file = place_of(named, time).file;
    std::error_code unknown;  // an error means, for example, a circular link, which is not a file either
    if (!file.empty() && !std::filesystem::is_regular_file(folder_ / file, unknown))
      missing.push_back({named.variable, file, named.of_points});
  }
  return missing;
}

void EnsightCase::require_regular_files(const std::string& source) const {
  std::vector<double> all = times();
  if (all.empty()) all.push_back(0);
  std::vector<Named> everything = named_;
  everything.insert(everything.end(), beside_.begin(), beside_.end());
  for (const double time : all)
    for (const Named& named : everything) {
      const std::string file = place_of(named, time).file;
      std::error_code unknown;
      const auto status = std::filesystem::status(folder_ / file, unknown);
      if (file.empty() || !std::filesystem::exists(status)) continue;
      if (!std::filesystem::is_regular_file(status))
        throw scene::bad_input(
            fmt::format("{}: it names {}, which is not a regular file; put one there", source, file));
      note_named_file(folder_ / file);
    }
}

std::vector<EnsightCase::Located> EnsightCase::located(double time) const {
  std::vector<Located> located;
  for (const Named& named : named_) {
    const Place place = place_of(named, time);
    const std::filesystem::path file = folder_ / place.file;
    std::error_code unknown;
    if (place.file.empty() || !std::filesystem::is_regular_file(file, unknown)) continue;
    located.push_back({named.kind,
                       {named.variable, file, file.filename().string(), named.components, named.of_points},
                       place.step,
                       named.file_set != 0});
  }
  return located;
}

std::vector<EnsightCase::Values> EnsightCase::values(double time) const {
  std::vector<Values> values;
  for (Located& each : located(time))
    if (!each.values.variable.empty() && !each.in_set && each.values.components > 0)
      values.push_back(std::move(each.values));
  return values;
}

std::vector<double> EnsightCase::times() const {
  std::vector<double> times;
  for (const auto& [number, set] : sets_) times.insert(times.end(), set.times.begin(), set.times.end());
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace tessera::readers
