// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "scene/error.hpp"

namespace tessera::test {

/// A new directory, removed at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tessera-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  /// Names of everything in it, including hidden files.
  [[nodiscard]] std::vector<std::string> names() const { return names_in(path_); }
  static std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream out;
  out << stream.rdbuf();
  return out.str();
}

/// The one-line message and the code of the Error that `action` throws; "" and no code if it throws none.
struct Fault {
  std::string message;
  std::optional<scene::ErrorCode> code;  ///< no value: nothing was thrown
};
template <class Action>
Fault fault_of(const Action& action) {
  try {
    action();
  } catch (const scene::Error& error) {
    return {error.what(), error.code()};
  }
  return {};
}

/// `action` must throw Error(bad_input) with one printable line that contains all of `parts`.
template <class Action>
void expect_bad_input(const Action& action, const std::vector<std::string>& parts) {
  const Fault fault = fault_of(action);
  EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
  for (const std::string& part : parts) EXPECT_NE(fault.message.find(part), std::string::npos) << fault.message;
  EXPECT_TRUE(std::ranges::all_of(fault.message, [](char c) { return c >= 0x20 && c < 0x7f; })) << fault.message;
  EXPECT_LT(fault.message.size(), 400u) << fault.message;
}

}  // namespace tessera::test
