// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "io/image/display_rows.hpp"
#include "io/image/image_formats.hpp"
#include "io/image/picture_strips.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

/// Output of libtiff. Exceptions must not propagate through libtiff's C functions: the first error is stored.
struct Target {
  explicit Target(const std::filesystem::path& path) : file(path) {}

  system::AtomicFile file;
  std::uint64_t size = 0;
  std::string message;
  std::exception_ptr error;
};

Target& target_of(void* handle) { return *static_cast<Target*>(handle); }

tmsize_t on_write(thandle_t handle, void* bytes, tmsize_t count) {
  Target& target = target_of(handle);
  try {
    target.file.write(bytes, static_cast<std::size_t>(count));
    target.size = std::max(target.size, target.file.position());
    return count;
  } catch (...) {
    target.error = std::current_exception();
    return -1;
  }
}

toff_t on_seek(thandle_t handle, toff_t offset, int whence) {
  Target& target = target_of(handle);
  try {
    target.file.seek(whence == SEEK_SET   ? offset
                     : whence == SEEK_CUR ? target.file.position() + offset
                                          : target.size + offset);
    return target.file.position();
  } catch (...) {
    target.error = std::current_exception();
    return static_cast<toff_t>(-1);
  }
}

tmsize_t on_read(thandle_t /*handle*/, void* /*bytes*/, tmsize_t /*count*/) { return 0; }
toff_t on_size(thandle_t handle) { return target_of(handle).size; }
int on_close(thandle_t /*handle*/) { return 0; }

int on_error(TIFF* /*tiff*/, void* handle, const char* /*module*/, const char* format, va_list values) {
  char text[256] = "";
  std::vsnprintf(text, sizeof text, format, values);
  target_of(handle).message = text;
  return 1;
}
int on_warning(TIFF* /*tiff*/, void* /*handle*/, const char* /*module*/, const char* /*format*/, va_list /*values*/) {
  return 1;
}

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

/// Returns null if memory runs out. `large`: BigTIFF for files over 4 GiB, which few readers supported before 2010.
Tiff open(Target& target, const char* name, bool large) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  if (!options) return {nullptr, &TIFFClose};
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &target);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, nullptr);
  return {TIFFClientOpenExt(name, large ? "w8" : "w", &target, on_read, on_write, on_seek, on_close, on_size, nullptr,
                            nullptr, options.get()),
          &TIFFClose};
}

void set_tags(TIFF* tiff, scene::ImageSize size, int channels, int bits, int strip_rows) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(size.width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(size.height));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(strip_rows));
  const std::uint16_t straight_alpha = EXTRASAMPLE_UNASSALPHA;
  if (channels == 4) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &straight_alpha);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_ZIPQUALITY, deflate_level);
}

}  // namespace

bool has_tiff() { return true; }

void write_tiff(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  if (options.png_bits != 8 && options.png_bits != 16)
    throw scene::bad_input(
        fmt::format("{}: {} bits per channel are not supported; a .tif has 8 or 16", file.string(), options.png_bits));
  Target target(file);
  const int channels = options.background ? 3 : 4, height = image.size.height;
  const DisplayRows display(image, file, options, channels, DisplayRows::Order::little);
  const std::size_t row_bytes = display.row_bytes();
  const int strip_rows = std::clamp(static_cast<int>(deflated_bytes / row_bytes), 1, height);
  const auto check = [&](bool done) {
    if (target.error) std::rethrow_exception(target.error);
    if (!done)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("{}: cannot be written: {}; write .png", file.string(), target.message));
  };
  const bool large = static_cast<double>(row_bytes) * height > 0xf0000000;
  Tiff tiff = open(target, file.c_str(), large);
  check(tiff != nullptr);
  set_tags(tiff.get(), image.size, channels, options.png_bits, strip_rows);
  std::vector<float> rgba;
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(strip_rows) * row_bytes);
  for (int begin = 0; begin < height; begin += strip_rows) {
    const int end = std::min(begin + strip_rows, height);
    for (int y = begin; y < end; ++y)
      display.row(y, rgba, rows.data() + static_cast<std::size_t>(y - begin) * row_bytes);
    check(TIFFWriteEncodedStrip(tiff.get(), static_cast<std::uint32_t>(begin / strip_rows), rows.data(),
                                static_cast<tmsize_t>(static_cast<std::size_t>(end - begin) * row_bytes)) >= 0);
  }
  check(TIFFWriteDirectory(tiff.get()) == 1);
  tiff.reset();
  check(target.message.empty());  // closing writes, too, and does not report errors
  target.file.commit();
}

}  // namespace tessera::io
