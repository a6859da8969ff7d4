// SPDX-License-Identifier: BSD-3-Clause
#include "system/missing_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"

namespace tessera::system {

namespace {

std::string without_digits(std::string name) {
  std::erase_if(name, is_digit);
  return name;
}

}  // namespace

std::string meant_file(const std::filesystem::path& file) {
  constexpr std::size_t most = 1000;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && names.size() < most && entry != std::filesystem::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  // Digits are ignored, because the next piece or step of a series was probably not meant.
  const std::string requested = without_digits(file.filename().string());
  std::erase_if(names, [&](const std::string& name) { return without_digits(name) == requested; });
  std::ranges::sort(names);  // directory entries are in no order
  const auto near = nearest_name(file.filename().string(), names);
  if (!near) return {};
  return fmt::format("did you mean {}?",
                     (file.has_parent_path() ? folder / *near : std::filesystem::path(*near)).string());
}

scene::Error missing_file(const std::filesystem::path& file) {
  const std::string meant = meant_file(file);
  return scene::bad_input(
      fmt::format("{}: there is no such file; {}", file.string(), meant.empty() ? "check the name" : meant));
}

}  // namespace tessera::system
