// SPDX-License-Identifier: BSD-3-Clause
// Volumes of colours are never silently rendered by the length of their tuples.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::volume_colors_test {
namespace {

std::string bytes(std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += static_cast<char>(k);
  return text;
}

std::string nrrd(const char* type, const char* kind, int components, std::size_t size) {
  return "NRRD0004\ntype: " + std::string(type) + "\ndimension: 4\nsizes: " + std::to_string(components) +
         " 2 2 2\nkinds: " + kind + " domain domain domain\nendian: little\nencoding: raw\n\n" +
         bytes(8 * static_cast<std::size_t>(components) * size);
}

std::string meta_image(int channels) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 2 2 2\nElementNumberOfChannels = " +
         std::to_string(channels) + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
         bytes(8 * static_cast<std::size_t>(channels));
}

/// NIfTI-1 of 2 x 2 x 2 samples: RGB24 (128) or RGBA32 (2304).
std::string nifti(std::int16_t type, std::size_t components) {
  std::string header(352, '\0');
  test::put(header, 0, std::int32_t{348});
  const std::vector<std::int16_t> dimensions = {3, 2, 2, 2, 1, 1, 1, 1};
  for (std::size_t k = 0; k < dimensions.size(); ++k) test::put(header, 40 + 2 * k, dimensions[k]);
  test::put(header, 70, type);
  test::put(header, 72, static_cast<std::int16_t>(8 * components));
  for (std::size_t k = 0; k < 4; ++k) test::put(header, 76 + 4 * k, 1.0F);
  test::put(header, 108, 352.0F);
  header.replace(344, 4, std::string("n+1\0", 4));
  return header + bytes(8 * components);
}

std::string vti(int components) {
  std::string text =
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 1 0 1 0 1\" "
      "Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray type=\"UInt8\" "
      "Name=\"samples\" NumberOfComponents=\"" +
      std::to_string(components) + "\" format=\"ascii\">";
  for (int k = 0; k < 8 * components; ++k) text += std::to_string(k) + " ";
  return text + "</DataArray></PointData></Piece></ImageData></VTKFile>";
}

TEST(VolumeColors, AreRefusedUnlessAComponentOrTheLengthIsAskedFor) {
  const test::TemporaryFolder folder;
  const std::vector<std::filesystem::path> files = {folder.write("a.nrrd", nrrd("uint8", "RGB-color", 3, 1)),
                                                    folder.write("b.nrrd", nrrd("uint8", "RGBA-color", 4, 1)),
                                                    folder.write("c.nrrd", nrrd("uint16", "RGB-color", 3, 2)),
                                                    folder.write("d.mha", meta_image(3)),
                                                    folder.write("e.mha", meta_image(4)),
                                                    folder.write("f.nii", nifti(128, 3)),
                                                    folder.write("g.nii", nifti(2304, 4)),
                                                    folder.write("h.vti", vti(3)),
                                                    folder.write("i.vti", vti(4))};
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.string());
    test::expect_no_volume(file, "'samples' has colours of ");
    ReadOptions options;
    options.field = "samples";
    test::expect_no_volume(file, "choose one component with `field` samples:0 (red), or their length with samples:mag",
                           options);
    options.field = "samples:1";
    EXPECT_GT(open_volume(file, options).range.low, 0);
    options.field = "samples:mag";
    EXPECT_GT(open_volume(file, options).range.high, open_volume(file, options).range.low);
  }
}

TEST(VolumeColors, AreNotVectors) {
  const test::TemporaryFolder folder;
  for (const auto& file :
       {folder.write("v.nrrd", nrrd("uint8", "vector", 3, 1)), folder.write("w.nrrd", nrrd("int16", "3-vector", 3, 2)),
        folder.write("x.mha", meta_image(2))})
    EXPECT_TRUE(open_volume(file).source->grid().field_name.ends_with(":mag")) << file;
}

}  // namespace
}  // namespace tessera::io::volume_colors_test
