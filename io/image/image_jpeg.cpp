// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstddef>
#include <cstdio>  // jpeglib.h uses FILE without including its header
// must follow <cstdio>
#include <jpeglib.h>

#include <csetjmp>
#include <cstdlib>
#include <vector>

#include "io/image/display_rows.hpp"
#include "io/image/image_formats.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

/// libjpeg reports errors by longjmp, which must not skip C++ destructors: functions that call libjpeg have no local
/// objects with destructors.
struct Jpeg {
  jpeg_compress_struct compress{};
  jpeg_error_mgr errors{};
  std::jmp_buf back{};
  char message[JMSG_LENGTH_MAX] = "";
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  Jpeg() = default;
  Jpeg(const Jpeg&) = delete;
  Jpeg& operator=(const Jpeg&) = delete;
  ~Jpeg() {
    jpeg_destroy_compress(&compress);
    std::free(bytes);
  }
};

void on_error(j_common_ptr info) {
  Jpeg& jpeg = *static_cast<Jpeg*>(info->client_data);
  (*info->err->format_message)(info, jpeg.message);
  std::longjmp(jpeg.back, 1);
}

void on_message(j_common_ptr) {}

bool begin(Jpeg& jpeg, int width, int height, int quality) {
  jpeg.compress.err = jpeg_std_error(&jpeg.errors);
  jpeg.errors.error_exit = on_error;
  jpeg.errors.output_message = on_message;
  jpeg.compress.client_data = &jpeg;
  if (setjmp(jpeg.back) != 0) return false;
  jpeg_create_compress(&jpeg.compress);
  jpeg_mem_dest(&jpeg.compress, &jpeg.bytes, &jpeg.size);
  jpeg.compress.image_width = static_cast<JDIMENSION>(width);
  jpeg.compress.image_height = static_cast<JDIMENSION>(height);
  jpeg.compress.input_components = 3;
  jpeg.compress.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg.compress);
  jpeg_set_quality(&jpeg.compress, quality, TRUE);
  // No chroma subsampling, because volume renderings have thin coloured lines.
  jpeg.compress.comp_info[0].h_samp_factor = jpeg.compress.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&jpeg.compress, TRUE);
  return true;
}

bool write_row(Jpeg& jpeg, unsigned char* row) {
  if (setjmp(jpeg.back) != 0) return false;
  jpeg_write_scanlines(&jpeg.compress, &row, 1);
  return true;
}

bool finish(Jpeg& jpeg) {
  if (setjmp(jpeg.back) != 0) return false;
  jpeg_finish_compress(&jpeg.compress);
  return true;
}

/// Encodes the whole file with `jpeg`.
void encode(Jpeg& jpeg, const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  if (image.size.width > JPEG_MAX_DIMENSION || image.size.height > JPEG_MAX_DIMENSION)
    throw scene::bad_input(fmt::format("{}: it is {}x{} pixels, but a .jpg has at most {} per side; write .png",
                                       file.string(), image.size.width, image.size.height, JPEG_MAX_DIMENSION));
  if (options.jpeg_quality < 1 || options.jpeg_quality > 100)
    throw scene::bad_input(
        fmt::format("{}: the quality is {}, but must be 1 to 100", file.string(), options.jpeg_quality));
  ImageFileOptions eight_bits = options;
  eight_bits.png_bits = 8;
  const DisplayRows display(image, file, eight_bits, 3);
  const auto check = [&](bool done) {
    if (!done)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("{}: cannot be written: {}; write .png", file.string(), jpeg.message));
  };
  check(begin(jpeg, image.size.width, image.size.height, options.jpeg_quality));
  std::vector<float> rgba;
  std::vector<std::uint8_t> row(display.row_bytes());
  for (int y = 0; y < image.size.height; ++y) {
    display.row(y, rgba, row.data());
    check(write_row(jpeg, row.data()));
  }
  check(finish(jpeg));
}

}  // namespace

bool has_jpeg() { return true; }

void write_jpeg(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  Jpeg jpeg;
  system::AtomicFile target(file);
  encode(jpeg, image, file, options);
  target.write(jpeg.bytes, jpeg.size);
  target.commit();
}

std::vector<std::byte> jpeg_bytes(const scene::Image& image, const ImageFileOptions& options) {
  Jpeg jpeg;
  encode(jpeg, image, "image", options);
  const auto* const first = reinterpret_cast<const std::byte*>(jpeg.bytes);
  return {first, first + jpeg.size};
}

}  // namespace tessera::io
