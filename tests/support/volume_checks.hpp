// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"

namespace tessera::test {

/// Samples as stored, without scale and shift.
inline std::vector<double> all_samples(const scene::SampleSource& source) {
  std::vector<double> values(static_cast<std::size_t>(source.geometry().all_samples().count()));
  source.read(source.geometry().all_samples(), std::span<double>(values));
  return values;
}

/// Opens the file and expects a one-line error that contains `words` and a remedy and does not mention an unnamed file.
inline void expect_no_volume(const std::filesystem::path& file, const std::string& words,
                             const ReadOptions& options = {}) {
  const Fault fault = fault_of([&] { io::open_volume(file, options); });
  EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
  EXPECT_NE(fault.message.find(words), std::string::npos) << fault.message;
  EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
  EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
  EXPECT_EQ(fault.message.find("/proc/"), std::string::npos) << fault.message;
}

/// Whether one of the notes contains `words`.
inline bool has_note(const io::VolumeFile& volume, const std::string& words) {
  for (const std::string& note : volume.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace tessera::test
