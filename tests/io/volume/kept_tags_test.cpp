// SPDX-License-Identifier: BSD-3-Clause
// What `convert` keeps in addition to samples and positions: a patient's axes, modality, units and the meaning of
// values.
#include <gtest/gtest.h>

#include <string>

#include "io/volume/volume_writer.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::kept_tags_test {
namespace {

using test::put;

TEST(KeptTags, AreReadBackFromEveryFormatThatKeepsThem) {
  const test::TemporaryFolder folder;
  const VolumeFile volume = open_volume(folder.write("a.nii", test::nifti()));
  const VolumeTags tags{"CT", "HU", "mm", true};
  for (const char* name : {"a.nrrd", "a.bricks", "a.vti", "a.vtr"})
    for (const BodyAxes axes : {BodyAxes::ras, BodyAxes::lps, BodyAxes::none}) {
      write_volume(*volume.source, folder / name, 8, axes, tags);
      const VolumeFile again = open_volume(folder / name);
      EXPECT_EQ(again.body_axes, axes) << name;
      EXPECT_EQ(again.tags, tags) << name;
      EXPECT_EQ(test::all_samples(*again.source), test::all_samples(*volume.source)) << name;
      EXPECT_EQ(again.source->geometry().spacing, volume.source->geometry().spacing) << name;
    }
}

TEST(KeptTags, UnknownTagsStayUnset) {
  const test::TemporaryFolder folder;
  const VolumeFile volume = open_volume(folder.write("a.nii", test::nifti()));
  for (const char* name : {"a.nrrd", "a.bricks", "a.vti"}) {
    write_volume(*volume.source, folder / name, 8);
    const VolumeFile again = open_volume(folder / name);
    EXPECT_EQ(again.body_axes, BodyAxes::none) << name;
    EXPECT_EQ(again.tags, VolumeTags()) << name;
  }
}

TEST(KeptTags, ControlCharactersInAHeaderDoNoHarm) {
  const test::TemporaryFolder folder;
  const VolumeFile volume = open_volume(folder.write("a.nii", test::nifti()));
  const VolumeTags odd{"C\nT", "\xff\"HU", "m\rm", false};
  for (const char* name : {"a.nrrd", "a.bricks", "a.vti"}) {
    write_volume(*volume.source, folder / name, 8, BodyAxes::ras, odd);
    const VolumeFile again = open_volume(folder / name);
    EXPECT_EQ(again.tags.modality, "CT") << name;
    EXPECT_EQ(again.tags.length_unit, "mm") << name;
    EXPECT_EQ(again.body_axes, BodyAxes::ras) << name;
  }
}

/// Anatomical axes apply if the header describes a patient or the values are those of CT; otherwise the frame has no
/// meaning.
TEST(KeptTags, ANiftiIsAPatientByItsHeaderOrValues) {
  const test::TemporaryFolder folder;
  const auto axes = [&](int code, char unit, std::int16_t low, std::int16_t high) {
    std::string file = test::nifti();
    put<std::int16_t>(file, 254, static_cast<std::int16_t>(code));
    const float rows[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    std::memcpy(file.data() + 280, rows, sizeof rows);
    file[123] = unit;
    put<std::int16_t>(file, 352, low), put<std::int16_t>(file, 354, high);
    return open_volume(folder.write("a.nii", file)).body_axes;
  };
  for (const int code : {1, 3, 4}) EXPECT_EQ(axes(code, 0, 0, 100), BodyAxes::ras) << code;
  for (const int code : {2, 5}) {
    EXPECT_EQ(axes(code, 0, 0, 100), BodyAxes::none) << code;
    EXPECT_EQ(axes(code, 2, 0, 100), BodyAxes::ras) << code;        // millimetres
    EXPECT_EQ(axes(code, 2 + 8, 0, 100), BodyAxes::ras) << code;    // and seconds
    EXPECT_EQ(axes(code, 0, -1024, 1500), BodyAxes::ras) << code;   // Hounsfield units
    EXPECT_EQ(axes(code, 0, -9999, 1500), BodyAxes::none) << code;  // a fill value
  }
}

TEST(KeptTags, TheModalityOfAMetaImageIsKnownWhateverSeparatesItsHeadersWords) {
  const test::TemporaryFolder folder;
  for (const auto& [word, modality] :
       {std::pair("MET_MOD_CT", "CT"), std::pair("MET_MOD_MR", "MR"), std::pair("MET_MOD_UNKNOWN", "")})
    for (const char* between : {" = ", ": "}) {
      std::string header;
      for (const auto& [key, value] : {std::pair("ObjectType", "Image"), std::pair("NDims", "3"),
                                       std::pair("Modality", word), std::pair("DimSize", "2 2 2"),
                                       std::pair("ElementType", "MET_UCHAR"), std::pair("ElementDataFile", "LOCAL")})
        header += std::string(key) + between + value + "\n";
      EXPECT_EQ(open_volume(folder.write("a.mha", header + "abcdefgh")).tags.modality, modality) << word << between;
    }
}

TEST(KeptTags, TheIntentOfANiftiMakesLabels) {
  const test::TemporaryFolder folder;
  std::string file = test::nifti();
  EXPECT_FALSE(open_volume(folder.write("a.nii", file)).tags.labels);
  for (const std::int16_t intent : {1002, 1005}) {
    put<std::int16_t>(file, 68, intent);
    EXPECT_TRUE(open_volume(folder.write("a.nii", file)).tags.labels) << intent;
  }
  put<std::int16_t>(file, 68, 3);
  EXPECT_FALSE(open_volume(folder.write("a.nii", file)).tags.labels);
}

}  // namespace
}  // namespace tessera::io::kept_tags_test
