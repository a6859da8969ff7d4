// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/program.hpp"
#include "support/await.hpp"

namespace tessera::apps {

/// Films of a mesh and of a volume that a test interrupts.
class FilmRuns : public ::testing::Test {
 protected:
  using Words = std::vector<std::string>;
  /// Number of frames of a film that is ended early. All of them would take minutes.
  static constexpr int endless = 9999;

  void SetUp() override {
    ASSERT_EQ(tessera({"generate", "cube", inputs_[0], "n=8", "--quiet"}).status, 0);
    ASSERT_EQ(tessera({"generate", "ripples", inputs_[1], "n=32", "--quiet"}).status, 0);
    std::filesystem::create_directory(pictures_);
  }

  [[nodiscard]] Words film(const std::string& input, const Words& more = {}, int frames = endless) const {
    Words words{"render",    input,   "-o",      pictures_ + "/f_%04d.pfm",
                "--size",    "60x60", "--orbit", std::to_string(frames),
                "--threads", "1",     "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Returns the command line of a run on `ranks` ranks, or in one process if `ranks` is 0.
  static Words command(int ranks, const Words& arguments) {
    if (ranks > 0) return mpirun_command(ranks, arguments);
    Words words{TESSERA_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return words;
  }

  [[nodiscard]] std::size_t pictures() const { return pictures(pictures_); }

  static std::size_t pictures(const std::filesystem::path& folder) {
    std::error_code gone;
    const std::filesystem::directory_iterator begin(folder, gone);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

  /// Waits until `count` images exist. Returns false if the run ends before.
  [[nodiscard]] bool wait_for_pictures(const Running& running, std::size_t count) const {
    return test::await([&] { return pictures() >= count || !running.runs(); }) && pictures() >= count;
  }

  void clear_pictures() const {
    std::filesystem::remove_all(pictures_);
    std::filesystem::create_directory(pictures_);
  }

  const Folder folder_;
  const std::string inputs_[2] = {folder_ / "m.vtu", folder_ / "v.nrrd"};
  const std::string pictures_ = folder_ / "pictures";
};

}  // namespace tessera::apps
