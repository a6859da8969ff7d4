// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/message.hpp"
#include "scene/image.hpp"
#include "tessera/pixel_rect.hpp"

/// Finished pixels on their way to the rank that puts the picture together: bit for bit, in fewer bytes where they are
/// smooth (bench/pixel_packing.cpp has the figures).
///
/// A rectangle of pixels is u32 bytes and what this number says:
///   0      the pixels as they are: f32 RGBA row by row, then f32 depths row by row
///   more   so many bytes of packed pixels
///
/// Packed, the columns of a rectangle go in bands of 16, from left to right; where the last band is narrower, what it
/// lacks counts as 0. Of a value's 32 bits, taken as a whole number, those of the two rows above foretell v = 2 a - b
/// (modulo 2^32, and with 0 where there is no row), and what differs is written as 2 |d|, less 1 if d < 0:
///   u8 widths  by band, row, and channel (red, green, blue, alpha, depth): w, 0 to 32, the bits of the largest
///              difference of the 16
///   u32 words  16 streams of bits, one a column of a band, word by word side by side: in the order of the widths w
///   bits
///              of each difference, lowest bit first. The last words are filled up with 0
/// So 16 columns are packed and unpacked at once, by shifts that all lanes share. Widths that change from row to row
/// follow edges. The method of a common width is Lemire & Boytsov, "Decoding billions of integers per second through
/// vectorization", 2015 (SIMD-BP128).
namespace tessera::exchange {

/// Appends the pixels of `rect`, which lies in the image; as they are if they are no fewer bytes packed, or if not
/// asked to `pack`.
void append_pixels(Bytes& bytes, const scene::Image& image, const PixelRect& rect, bool pack);

/// Takes the pixels of `rect` into the image. Throws Error(system_failure) if they are not what is said above; then the
/// rectangle has any values.
void take_pixels(RecordReader& reader, scene::Image& image, const PixelRect& rect);

}  // namespace tessera::exchange
