// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include "sorting/gl/gl_bitonic_texture.hpp"
#include "sorting/gl/gl_list_sort.hpp"
#include "support/gl_context.hpp"

namespace tessera::sorting::gl_sorts_test {
namespace {

using gl::Buffer;

bool key_before(const GlKey& a, const GlKey& b) {
  return std::tie(a.front, a.back, a.tie, a.element) < std::tie(b.front, b.back, b.tie, b.element);
}

void fill(const gl::Context& context, Buffer& device, const void* from, std::size_t bytes) {
  Buffer upload(context, Buffer::Use::upload);
  upload.reserve(bytes);
  device.reserve(bytes);
  if (bytes > 0) std::memcpy(upload.mapped(), from, bytes);
  device.copy_from(upload, 0, bytes);
}

/// The keys as sorted by the device, list after list.
std::vector<GlKey> sorted(const gl::Context& context, const std::vector<GlKey>& keys,
                          const std::vector<GlList>& lists) {
  GlListSort sort(context);
  sort.plan(lists);
  const std::size_t bytes = keys.size() * sizeof(GlKey);
  Buffer unsorted(context, Buffer::Use::device), a(context, Buffer::Use::device), b(context, Buffer::Use::device),
      tables(context, Buffer::Use::device), back_a(context, Buffer::Use::readback),
      back_b(context, Buffer::Use::readback);
  fill(context, unsorted, keys.data(), bytes);
  fill(context, tables, sort.tables().data(), sort.tables().size_bytes());
  for (Buffer* buffer : {&a, &b, &back_a, &back_b}) buffer->reserve(bytes);
  sort.sort(unsorted, {&a, &b}, tables);
  context.gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  back_a.copy_from(a, 0, bytes);
  back_b.copy_from(b, 0, bytes);
  gl::Fence fence(context);
  fence.set();
  fence.wait();
  context.check("sorting");
  std::vector<GlKey> result(keys.size());
  for (const GlList& list : lists)
    std::memcpy(&result[list.begin],
                (GlListSort::buffer_of(list.count) == 0 ? back_a : back_b).mapped() + list.begin * sizeof(GlKey),
                list.count * sizeof(GlKey));
  return result;
}

/// Fronts of an arrangement: element i of n.
std::uint32_t front_of(const std::string& arrangement, std::uint32_t i, std::uint32_t n, std::mt19937& random) {
  if (arrangement == "sorted") return i;
  if (arrangement == "reversed") return n - i;
  if (arrangement == "equal") return 7;
  if (arrangement == "extreme") return i % 2 == 0 ? 0 : 0xffffffff;
  return static_cast<std::uint32_t>(random());
}

class Arrangements : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Arrangements, testing::Values("sorted", "reversed", "equal", "shuffled", "extreme"));

TEST_P(Arrangements, ListsOfAnyLengthAreSortedSideBySide) {
  TESSERA_OSMESA_OR_SKIP(context);
  std::mt19937 random(5);
  std::vector<GlKey> keys;
  std::vector<GlList> lists;
  for (const std::uint32_t n : {1, 2, 3, 64, 20000, 1, 7, 1023, 1024, 1025, 2048, 2049, 5000, 31, 100}) {
    lists.push_back({static_cast<std::uint32_t>(keys.size()), n});
    for (std::uint32_t i = 0; i < n; ++i)
      keys.push_back({front_of(GetParam(), i, n, random), static_cast<std::uint32_t>(random() % 3), 5,
                      static_cast<std::uint32_t>(keys.size())});
  }
  const auto result = sorted(context, keys, lists);
  for (const GlList& list : lists) {
    const auto first = keys.begin() + list.begin;
    std::sort(first, first + list.count, key_before);
    for (std::uint32_t i = 0; i < list.count; ++i)
      ASSERT_EQ(result[list.begin + i].element, keys[list.begin + i].element)
          << "element " << i << " of a list of " << list.count;
  }
}

TEST(ListSort, AcceptsEmptyLists) {
  TESSERA_OSMESA_OR_SKIP(context);
  EXPECT_TRUE(sorted(context, {}, {}).empty());
}

/// The positions of the segments, list by list, after sorting in a texture of at most `limit` texels a side.
std::vector<std::uint32_t> texture_order(const gl::Context& context, int limit, std::uint32_t longest, int lists,
                                         const std::vector<TextureSegment>& segments,
                                         const std::vector<TextureTie>& ties) {
  GLuint vertices = 0;
  context.gl().CreateVertexArrays(1, &vertices);
  context.gl().BindVertexArray(vertices);
  GlBitonicTexture sort(context, limit);
  const auto layout = sort.layout(longest);
  EXPECT_GE(layout.lists, lists);
  EXPECT_EQ(layout.stride() * static_cast<std::size_t>(lists), segments.size());
  const std::uint32_t passes = sort.sort(layout, lists, segments, ties);
  EXPECT_EQ(passes, layout.log2_size * (layout.log2_size + 1) / 2);
  std::vector<TextureTie> result(segments.size());
  const gl::Texture& texture = sort.sorted_ties();
  std::vector<TextureTie> texels(static_cast<std::size_t>(texture.width()) *
                                 static_cast<std::size_t>(texture.height()));
  context.gl().GetTextureImage(texture.name(), 0, GL_RG_INTEGER, GL_UNSIGNED_INT,
                               static_cast<GLsizei>(texels.size() * sizeof(TextureTie)), texels.data());
  context.check("reading");
  context.gl().DeleteVertexArrays(1, &vertices);
  std::vector<std::uint32_t> places;
  for (const TextureTie& tie : texels) places.push_back(tie.place);
  return places;
}

TEST_P(Arrangements, ATextureSortsListsInItsRowsAndLongerOnesOverSeveral) {
  TESSERA_OSMESA_OR_SKIP(context);
  for (const int limit : {0, 16}) {  // rows of 128 elements without a limit, parts of 16 with it
    std::mt19937 random(6);
    constexpr std::uint32_t stride = 128;
    constexpr int lists = 2;
    const std::uint32_t counts[lists] = {100, 5};
    std::vector<TextureSegment> segments(stride * lists, {0, 0, 0, GlBitonicTexture::null_depth});
    std::vector<TextureTie> ties(stride * lists, {0, 0xffff});
    std::vector<std::uint32_t> expected;
    for (int list = 0; list < lists; ++list) {
      const std::uint32_t n = counts[list];
      for (std::uint32_t i = 0; i < n; ++i) {
        segments[list * stride + i].z_back = static_cast<float>(front_of(GetParam(), i, n, random)) - 1e9f;
        ties[list * stride + i] = {static_cast<std::uint32_t>(random() % 4), i};
      }
      std::vector<std::uint32_t> order(n);
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key = [&](std::uint32_t i) {
          return std::tuple(segments[list * stride + i].z_back, ties[list * stride + i].tie, i);
        };
        return key(a) > key(b);
      });
      order.resize(stride, 0xffff);
      expected.insert(expected.end(), order.begin(), order.end());
    }
    EXPECT_EQ(texture_order(context, limit, 100, lists, segments, ties), expected) << "limit " << limit;
  }
}

TEST(BitonicTexture, AListBeyondTheWholeTextureIsRefused) {
  TESSERA_OSMESA_OR_SKIP(context);
  EXPECT_THROW(static_cast<void>(GlBitonicTexture(context, 16).layout(257)), scene::Error);
  EXPECT_EQ(GlBitonicTexture(context, 16).layout(256).lists, 1);
}

}  // namespace
}  // namespace tessera::sorting::gl_sorts_test
