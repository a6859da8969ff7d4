// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/message.hpp"
#include "scene/image.hpp"
#include "tessera/pixel_rect.hpp"

/// Finished pixels on their way to the rank that assembles the image: bit for bit, in fewer bytes where the image is
/// smooth (bench/pixel_packing.cpp has the figures).
///
/// A rectangle of pixels is a u32 followed by what it determines:
///   0      the pixels as they are: f32 RGBA row by row, then f32 depths row by row
///   n > 0  n bytes of packed pixels
///
/// Packed, the columns of a rectangle form bands of 16, from left to right; in a narrower last band, the missing
/// columns count as 0. The 32 bits of a value are an integer, predicted as v = 2 a - b (modulo 2^32, with 0 for missing
/// rows) from a, one row above, and b, two rows above. The difference d from it is written as 2 |d|, less 1 if d < 0:
///   u8 widths  by band, row, and channel (red, green, blue, alpha, depth): w, 0 to 32, the bits of the largest
///              difference of the 16
///   u32 words  16 streams of bits, one per column of a band, interleaved word by word: in the order of the widths, the
///              w bits of each difference, lowest bit first. At the end, words are padded with 0
/// So 16 columns are packed and unpacked at once, by shifts that all lanes share. Widths that change from row to row
/// adapt to edges. The method of a common width is from Lemire & Boytsov, "Decoding billions of integers per second
/// through vectorization", 2015 (SIMD-BP128).
namespace tessera::exchange {

/// Appends the pixels of `rect`, which must be within the image. They are not packed if this would not save bytes, or
/// if `pack` is false.
void append_pixels(Bytes& bytes, const scene::Image& image, const PixelRect& rect, bool pack);

/// Takes the pixels of `rect` into the image. Throws Error(system_failure) if they do not have this format; the values
/// of the rectangle are then unspecified.
void take_pixels(RecordReader& reader, scene::Image& image, const PixelRect& rect);

}  // namespace tessera::exchange
