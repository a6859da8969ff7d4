// SPDX-License-Identifier: BSD-3-Clause
// Real files, truncated and with bytes changed: read, or refused in one line, never a crash. Intended for sanitizer
// builds.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"

namespace tessera::io {
namespace {

const std::filesystem::path meshes = std::filesystem::path(TESSERA_SOURCE_DIR) / ".." / "shared" / "data";

class Damaged : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(meshes)) GTEST_SKIP() << "no " << meshes << ": the public meshes are not here";
    original = test::contents(meshes / GetParam());
    name = std::filesystem::path(GetParam()).filename().string();
    if (const std::size_t at = name.find("xyz"); at != std::string::npos) {
      const std::string q = name.substr(0, at) + "q.bin";
      std::filesystem::copy_file((meshes / GetParam()).parent_path() / q, folder / q);
    }
  }

  /// Reads the bytes as a file with the original's name; returns whether they were accepted.
  bool read(const std::string& bytes) {
    const auto file = folder.write(name, bytes);
    const test::Fault fault = test::fault_of([&] { scene::validate(read_mesh(file).mesh, name); });
    if (!fault.code) return true;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_TRUE(fault.message.starts_with(folder.path().string())) << fault.message;
    EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
    return false;
  }

  test::TemporaryFolder folder;
  std::string original, name;
};

TEST_P(Damaged, EveryTruncationIsRefused) {
  ASSERT_TRUE(read(original));
  for (int k = 0; k < 24; ++k) {
    const std::size_t size = original.size() * static_cast<std::size_t>(k) / 24 + 1;
    EXPECT_FALSE(read(original.substr(0, size))) << size << " of " << original.size() << " bytes";
  }
}

TEST_P(Damaged, ChangedBytesNeverCrash) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bytes = original;
    const std::size_t reach = std::min(bytes.size(), std::size_t{seed % 2 ? 2000u : 4000000u});
    for (unsigned k = 0; k < 1 + seed % 4; ++k) bytes[random() % reach] = static_cast<char>(random());
    read(bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Damaged,
                         ::testing::Values("bluntfin/bluntfinxyz.bin", "bracket/bracket_appended_compressed.vtu",
                                           "disk-out/disk_out_ref.ex2", "notch/notch_stress_fixed.vtk",
                                           "unisim/UNISIM-II-D.vtu"));

}  // namespace
}  // namespace tessera::io
