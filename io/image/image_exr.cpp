// SPDX-License-Identifier: BSD-3-Clause
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/image/exr_stream.hpp"
#include "io/image/image_formats.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

constexpr std::array<const char*, 4> channel_names{"R", "G", "B", "A"};

/// OpenEXR compresses on a process-wide thread pool, which is empty until it is resized. This function only enlarges
/// the pool, so that a caller's larger setting is kept. Returns 0 if only this thread compresses.
int compressing_threads(const ImageFileOptions& options) {
  const int threads = scene::threads_for(options.threads);
  if (threads < 2) return 0;
  static std::mutex growing;
  const std::lock_guard lock(growing);
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  return threads;
}

template <class Number>
void write_rows(Imf::OutputFile& output, const scene::Image& image, const std::filesystem::path& file,
                const ImageFileOptions& options, int threads) {
  constexpr bool is_half = std::is_same_v<Number, half>;
  const auto width = static_cast<std::size_t>(image.size.width);
  const int rows_at_once = 16 * std::clamp(threads, 1, 64);  // each thread compresses groups of 16 rows
  std::vector<float> row(4 * width);
  std::vector<Number> rows(4 * width * static_cast<std::size_t>(std::min(rows_at_once, image.size.height)));
  for (int begin = 0; begin < image.size.height; begin += rows_at_once) {
    const int end = std::min(begin + rows_at_once, image.size.height);
    for (int y = begin; y < end; ++y) {
      composited_row(image, y, options, file, row.data());
      Number* out = rows.data() + 4 * width * static_cast<std::size_t>(y - begin);
      for (std::size_t i = 0; i < row.size(); ++i) {
        if constexpr (is_half)
          if (std::abs(row[i]) > 65504.0f)
            throw scene::bad_input(
                fmt::format("{}: pixel ({}, {}) is {}, above 65504, the largest 16-bit float; write 32-bit floats",
                            file.string(), i / 4, y, row[i]));
        out[i] = Number(row[i]);
      }
    }
    // The base of a slice is the address of pixel (0, 0), which is before the buffer. The address is computed as an
    // integer, because pointer arithmetic outside the buffer is invalid, and it is never dereferenced.
    const auto base = [&](const void* first, std::size_t row_bytes) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr)
      return reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(first) -
                                     row_bytes * static_cast<std::uintptr_t>(begin));
    };
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < 4; ++k)
      frame.insert(channel_names[k],
                   Imf::Slice(is_half ? Imf::HALF : Imf::FLOAT, base(rows.data() + k, 4 * width * sizeof(Number)),
                              4 * sizeof(Number), 4 * width * sizeof(Number)));
    frame.insert("Z", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(const_cast<float*>(image.depth.data())),
                                 sizeof(float), width * sizeof(float)));
    output.setFrameBuffer(frame);
    output.writePixels(end - begin);
  }
}

/// Writes the whole file to a stream named after it. Also throws OpenEXR's exceptions.
void encode(Imf::OStream& stream, const scene::Image& image, const std::filesystem::path& file,
            const ImageFileOptions& options) {
  Imf::Header header(image.size.width, image.size.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : channel_names)
    header.channels().insert(name, Imf::Channel(options.half ? Imf::HALF : Imf::FLOAT));
  header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  const int threads = compressing_threads(options);
  Imf::OutputFile output(stream, header, threads);
  if (options.half)
    write_rows<half>(output, image, file, options, threads);
  else
    write_rows<float>(output, image, file, options, threads);
}

/// Converts exceptions of `work` to Error.
template <class Work>
void writing(const std::filesystem::path& file, const Work& work) {
  try {
    work();
  } catch (const scene::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: cannot be written: {}; check the disk", file.string(), error.what()));
  }
}

/// Lets OpenEXR write into memory.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("image") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < position_ + size) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
};

}  // namespace

void write_exr(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  system::AtomicFile target(file);
  writing(file, [&] {
    ExrStream stream(target, file.string());
    encode(stream, image, file, options);
    stream.rethrow();
  });
  target.commit();
}

std::vector<std::byte> exr_bytes(const scene::Image& image, const ImageFileOptions& options) {
  MemoryStream stream;
  writing("image", [&] { encode(stream, image, "image", options); });
  return stream.take();
}

scene::Image read_exr(const std::filesystem::path& file) {
  try {
    Imf::InputFile input(file.c_str(), 0);
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > scene::max_image_side || height > scene::max_image_side)
      throw scene::bad_input(fmt::format("{}: it is {} by {} pixels; each side must be 1 to {}", file.string(), width,
                                         height, scene::max_image_side));
    for (const char* name : {"R", "G", "B"})
      if (input.header().channels().findChannel(name) == nullptr)
        throw scene::bad_input(fmt::format("{}: it has no channel {}; give an RGB image", file.string(), name));
    scene::Image image({static_cast<int>(width), static_cast<int>(height)});
    const auto row_floats = static_cast<std::size_t>(width);
    const auto base = [&](const float* first, std::size_t floats_per_pixel) {
      const auto offset = (static_cast<std::int64_t>(window.min.y) * width + window.min.x) *
                          static_cast<std::int64_t>(floats_per_pixel * sizeof(float));
      // NOLINTNEXTLINE(performance-no-int-to-ptr): as above
      return reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(first) - static_cast<std::uintptr_t>(offset));
    };
    Imf::FrameBuffer frame;
    for (std::size_t k = 0; k < 4; ++k)
      frame.insert(channel_names[k], Imf::Slice(Imf::FLOAT, base(image.rgba.data() + k, 4), 4 * sizeof(float),
                                                4 * row_floats * sizeof(float), 1, 1, k == 3 ? 1.0 : 0.0));
    frame.insert("Z", Imf::Slice(Imf::FLOAT, base(image.depth.data(), 1), sizeof(float), row_floats * sizeof(float), 1,
                                 1, std::numeric_limits<double>::infinity()));
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const scene::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::string reason = error.what();
    std::ranges::replace(reason, '\n', ' ');
    throw scene::bad_input(
        fmt::format("{}: is not an OpenEXR image that can be read ({}); write the file again", file.string(), reason));
  }
}

}  // namespace tessera::io
