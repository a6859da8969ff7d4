// SPDX-License-Identifier: BSD-3-Clause
// Any bytes in a file of any volume format with a parser of ours (NRRD, NIfTI, MetaImage, bricks, plain .vti and .vtr,
// by their first bytes) give a volume whose samples can be read and are within its range, or are refused in one line;
// holding it in memory or not makes no difference.
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/volume/volume_formats.hpp"
#include "support/fuzz_check.hpp"
#include "support/fuzz_file.hpp"
#include "support/read_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  static const test::FuzzFile file(".nii");
  file.write(data, size);
  std::vector<double> in_memory;
  test::parse_or_refuse([&] {
    const io::VolumeFile volume = io::open_volume(file.path, {});
    const scene::SampleBox all = volume.source->geometry().all_samples();
    test::require(all.count() > 0 && all.count() <= 64 * static_cast<std::int64_t>(size + 64));
    std::vector<double> values(static_cast<std::size_t>(all.count()));
    volume.source->read(all, std::span<double>(values));
    in_memory = values;
    // If floats represent the samples, the magnitudes of vectors are stored as floats too.
    if (scene::fits_float(volume.source->grid().type))
      for (double& v : values) v = static_cast<double>(static_cast<float>(v));
    // A brick file may state a range that is wider than the actual one.
    for (const double v : values)
      if (const double value = volume.source->grid().value(v); std::isfinite(v) && std::isfinite(value))
        test::require(volume.format.find("rick") != std::string::npos ||
                      (value >= volume.range.low && value <= volume.range.high));
  });
  // Reads the same samples through a scratch file, which also supports plain .vti and .vtr files. The file may be
  // refused again.
  test::parse_or_refuse([&] {
    ReadOptions options;
    options.memory_bytes = 1;
    const io::VolumeFile volume = io::open_volume(file.path, options);
    const scene::SampleBox all = volume.source->geometry().all_samples();
    test::require(all.count() > 0 && all.count() <= 64 * static_cast<std::int64_t>(size + 64));
    std::vector<double> values(static_cast<std::size_t>(all.count()));
    volume.source->read(all, std::span<double>(values));
    for (std::size_t k = 0; k < in_memory.size(); ++k)
      test::require(std::bit_cast<std::uint64_t>(values.at(k)) == std::bit_cast<std::uint64_t>(in_memory[k]));
  });
  return 0;
}
