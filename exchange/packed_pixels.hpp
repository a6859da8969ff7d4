// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/message.hpp"
#include "scene/image.hpp"
#include "tessera/pixel_rect.hpp"

/// The format in which finished pixels are sent to the rank that assembles the image. It is lossless, and takes fewer
/// bytes where the image is smooth (bench/pixel_packing.cpp measures how many).
///
/// A rectangle of pixels is encoded as a u32, whose value determines what follows:
///   0      unpacked pixels: f32 RGBA row by row, then f32 depths row by row
///   n > 0  n bytes of packed pixels
///
/// In packed pixels, the columns of a rectangle form bands of 16, from left to right; in a narrower last band, the
/// missing columns count as 0. The 32 bits of a value are treated as an integer. Its prediction is v = 2 a - b (modulo
/// 2^32, with 0 for missing rows), where a is the value one row above and b the value two rows above. The difference d
/// from the prediction is encoded as 2 |d|, less 1 if d < 0:
///   u8 widths  one width w, 0 to 32, for each band, row, and channel (red, green, blue, alpha, depth): the number of
///              bits of the largest of the 16 differences
///   u32 words  16 streams of bits, one per column of a band, interleaved word by word: in the order of the widths, the
///              w bits of each difference, lowest bit first. At the end, words are padded with 0
/// So 16 columns are packed and unpacked at once, by shifts that are the same in all lanes. Widths that change from row
/// to row adapt to edges. The use of a common width is from Lemire & Boytsov, "Decoding billions of integers per second
/// through vectorization", 2015 (SIMD-BP128).
namespace tessera::exchange {

/// Appends the pixels of `rect`, which must be within the image. The pixels are left unpacked if packing would not save
/// bytes, or if `pack` is false.
void append_pixels(Bytes& bytes, const scene::Image& image, const PixelRect& rect, bool pack);

/// Reads the pixels of `rect` into the image. Throws Error(system_failure) if the bytes do not have this format; the
/// pixels of the rectangle are then unspecified.
void take_pixels(RecordReader& reader, scene::Image& image, const PixelRect& rect);

}  // namespace tessera::exchange
