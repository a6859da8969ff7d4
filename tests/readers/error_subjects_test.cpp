// SPDX-License-Identifier: BSD-3-Clause
// The subject of an error is the file, whatever its name contains.

#include <gtest/gtest.h>

#include "io/scene/camera_file.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

const std::string odd = "odd: name; 1";

template <class Action>
void expect_subject(const std::filesystem::path& subject, const Action& action) {
  try {
    action();
    ADD_FAILURE() << subject << " is not an error";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.subject(), subject.string()) << error.what();
    EXPECT_FALSE(error.problem().empty()) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
  }
}

TEST(ErrorSubjects, AreTheFilesThatAreRead) {
  const test::TemporaryFolder folder;
  const auto file = [&](const std::string& extension, const std::string& text) {
    return folder.write(odd + extension, text);
  };
  const auto vtu = file(".vtu", "<VTKFile"), tets = file(".tets", "tets"), raw = file(".raw", "12345678");
  expect_subject(vtu, [&] { read_mesh(vtu, {}); });
  expect_subject(tets, [&] { read_mesh(tets, {}); });
  expect_subject(raw, [&] { open_volume(raw, {}); });
  for (const auto& camera : {file(".txt", ""), file(".json", "[{}]"), file("", "position 1 2")})
    expect_subject(camera, [&] { read_cameras(camera); });
  for (const auto& function : {file(".tf", "0 1 1"), file(".empty", ""), file(".xml", "<a/>"), folder / "no: file; 1"})
    expect_subject(function, [&] {
      colormaps::TransferFunctionOptions options;
      load_transfer_function(function, options);
    });
}

TEST(ErrorSubjects, AreTheFilesThatAreWritten) {
  const test::TemporaryFolder folder;
  const auto target = folder / odd / "a.png";
  expect_subject(target, [&] { system::check_writable(target); });
  expect_subject(target, [&] { system::AtomicFile file(target); });
  expect_subject(folder.path(), [&] { system::AtomicFile file(folder.path()); });
}

TEST(ErrorSubjects, AreTheSameWhenADirectoryIsRemovedDuringTheRun) {
  const test::TemporaryFolder folder;
  const auto target = folder / odd / "a.png";
  try {
    system::AtomicFile file(target);
    ADD_FAILURE();
  } catch (const system::OutputFault& fault) {
    const scene::Error since = fault.since_changed();
    EXPECT_EQ(since.code(), scene::ErrorCode::system_failure);
    EXPECT_EQ(since.subject(), target.string());
    EXPECT_EQ(since.problem(), fault.problem());
    EXPECT_TRUE(since.remedy().starts_with("it could be written when the run began")) << since.what();
  }
}

}  // namespace
}  // namespace tessera::io
