// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/image_deep_exr.hpp"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "io/image/exr_stream.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using Sample = scene::DeepImageSample;
constexpr std::array<std::pair<const char*, float Sample::*>, 6> channels{{{"R", &Sample::red},
                                                                           {"G", &Sample::green},
                                                                           {"B", &Sample::blue},
                                                                           {"A", &Sample::alpha},
                                                                           {"Z", &Sample::z},
                                                                           {"ZBack", &Sample::z_back}}};

/// Checks invariants on which readers rely, so that no invalid image is written silently.
void check_tidy(const scene::DeepImage& image, const std::filesystem::path& file) {
  const auto width = static_cast<std::size_t>(image.size.width);
  for (std::size_t p = 0; p + 1 < image.begin.size(); ++p) {
    float last = -std::numeric_limits<float>::infinity();
    for (const Sample& s : image.pixel(p)) {
      bool good = s.z <= s.z_back && s.z >= last && s.alpha >= 0 && s.alpha <= 1;
      for (const auto& channel : channels) good = good && std::isfinite(s.*channel.second);
      if (!good)
        throw scene::Error(scene::ErrorCode::system_failure,
                           fmt::format("{}: pixel ({}, {}) has a sample from depth {} to {} after a sample that ends "
                                       "at {}, with alpha {}; the image was not written, please report this",
                                       file.string(), p % width, p / width, s.z, s.z_back, last, s.alpha));
      last = s.z_back;
    }
  }
}

void write_lines(Imf::DeepScanLineOutputFile& output, const scene::DeepImage& image) {
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<unsigned int> counts(width);
  std::array<std::vector<const char*>, channels.size()> pointers;
  for (auto& row : pointers) row.resize(width);
  // One line at a time: deep files compress line by line. With a stride of zero between lines, any line uses the same
  // buffer.
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned int), 0));
  for (std::size_t c = 0; c < channels.size(); ++c)
    frame.insert(channels[c].first, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers[c].data()),
                                                   sizeof(char*), 0, sizeof(Sample)));
  output.setFrameBuffer(frame);
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.size.height); ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto samples = image.pixel(y * width + x);
      counts[x] = static_cast<unsigned int>(samples.size());
      for (std::size_t c = 0; c < channels.size(); ++c)
        pointers[c][x] = samples.empty() ? nullptr : reinterpret_cast<const char*>(&(samples[0].*channels[c].second));
    }
    output.writePixels(1);
  }
}

}  // namespace

bool is_deep_name(const std::filesystem::path& file) {
  return lower_case(file.filename().string()).ends_with(".deep.exr");
}

void write_deep_exr(const scene::DeepImage& image, const std::filesystem::path& file) {
  scene::validate(image.size);
  const std::size_t pixels = static_cast<std::size_t>(image.size.width) * static_cast<std::size_t>(image.size.height);
  if (image.begin.size() != pixels + 1 || image.begin.back() != image.samples.size())
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: there are {} sample lists for {} pixels; please report this", file.string(),
                                   image.begin.size(), pixels));
  check_tidy(image, file);
  system::AtomicFile target(file);
  try {
    Imf::Header header(image.size.width, image.size.height);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.setType(Imf::DEEPSCANLINE);
    for (const auto& channel : channels) header.channels().insert(channel.first, Imf::Channel(Imf::FLOAT));
    ExrStream stream(target, file.string());
    {
      Imf::DeepScanLineOutputFile output(stream, header, 0);
      write_lines(output, image);
    }
    stream.rethrow();
  } catch (const scene::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: cannot be written: {}; check the disk", file.string(), error.what()));
  }
  target.commit();
}

}  // namespace tessera::io
