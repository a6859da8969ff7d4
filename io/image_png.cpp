#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <exception>
#include <vector>

#include "colormaps/color_spaces.hpp"
#include "io/atomic_file.hpp"
#include "io/image_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// What libpng's callbacks reach. libpng leaves by longjmp, which must not pass C++ destructors, so exceptions are kept
/// here and no function that calls libpng owns anything.
struct Png {
  AtomicFile* file = nullptr;
  std::exception_ptr thrown;
  char message[200] = "";
};

void on_write(png_structp png, png_bytep bytes, png_size_t count) {
  Png& state = *static_cast<Png*>(png_get_io_ptr(png));
  try {
    state.file->write(bytes, count);
    return;
  } catch (...) {
    state.thrown = std::current_exception();
  }
  png_error(png, "write");
}

void on_flush(png_structp) {}

void on_error(png_structp png, png_const_charp message) {
  Png& state = *static_cast<Png*>(png_get_error_ptr(png));
  std::strncpy(state.message, message, sizeof(state.message) - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Layout {
  png_uint_32 width, height;
  int bits, color_type;
};

bool write_header(png_structp png, png_infop info, const Layout& layout) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, layout.width, layout.height, layout.bits, layout.color_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  return true;
}

bool write_row(png_structp png, const png_byte* row) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_write_row(png, row);
  return true;
}

bool write_end(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_write_end(png, info);
  return true;
}

/// Premultiplied row to display integers, big endian where 16 bits.
void encode_row(const std::vector<float>& rgba, int channels, const ImageFileOptions& options,
                std::vector<png_byte>& out) {
  const double largest = options.png_bits == 16 ? 65535 : 255;
  png_byte* next = out.data();
  const auto put = [&](double level) {
    const auto code = static_cast<unsigned>(std::lround(std::clamp(level, 0.0, 1.0) * largest));
    if (options.png_bits == 16) *next++ = static_cast<png_byte>(code >> 8);
    *next++ = static_cast<png_byte>(code & 0xff);
  };
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    // PNG's alpha is straight: colours are what an opaque pixel would show.
    const double alpha = rgba[i + 3], scale = alpha > 0 ? 1 / alpha : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double straight = std::clamp(rgba[i + k] * scale, 0.0, 1.0);
      put(options.encode_srgb ? colormaps::encode_srgb(straight) : straight);
    }
    if (channels == 4) put(alpha);
  }
}

}  // namespace

void write_png(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  if (options.png_bits != 8 && options.png_bits != 16)
    throw scene::bad_input(fmt::format("{}: {} bits a channel; a .png has 8 or 16", file.string(), options.png_bits));
  AtomicFile target(file);
  Png state;
  state.file = &target;
  struct Handles {
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Handles() { png_destroy_write_struct(&png, &info); }
  } handles;
  handles.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
  if (handles.png != nullptr) handles.info = png_create_info_struct(handles.png);
  const auto check = [&](bool done) {
    if (done) return;
    if (state.thrown) std::rethrow_exception(state.thrown);
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: cannot be written: {}; write .exr", file.string(), state.message));
  };
  if (handles.info == nullptr)
    throw scene::Error(scene::ErrorCode::system_failure, file.string() + ": no memory to write it");
  png_set_write_fn(handles.png, &state, on_write, on_flush);

  const int channels = options.background ? 3 : 4;
  check(write_header(handles.png, handles.info,
                     {static_cast<png_uint_32>(image.size.width), static_cast<png_uint_32>(image.size.height),
                      options.png_bits, channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB}));
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<float> row(4 * width);
  std::vector<png_byte> bytes(width * static_cast<std::size_t>(channels * options.png_bits / 8));
  for (int y = 0; y < image.size.height; ++y) {
    composited_row(image, y, options, file, row.data());
    encode_row(row, channels, options, bytes);
    check(write_row(handles.png, bytes.data()));
  }
  check(write_end(handles.png, handles.info));
  target.commit();
}

}  // namespace tessera::io
