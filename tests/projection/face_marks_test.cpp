// SPDX-License-Identifier: BSD-3-Clause
#include "projection/face_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "projection/surface_crossings.hpp"

namespace tessera::projection {
namespace {

constexpr double error = 1e-12;

FaceMark mark(std::uint32_t number, double slope_x, double slope_y, double depth = 2) {
  return {0, number, depth, 0, 1e-14, {slope_x, slope_y}, {error, error}, 0.5f, true};
}

/// The crossings of one ray, in the order in which they are met.
struct Met {
  std::vector<std::uint32_t> numbers;
  std::vector<double> depths;
};

Met met(std::vector<FaceMark> given) {
  FaceMarks marks;
  marks.reset(1);
  for (const FaceMark& m : given) marks.add(m);
  marks.sort();
  RaySegments segments;
  segments.reserve(given.size());
  marks.append_own(segments);
  Met met;
  for (std::size_t i = 0; i < segments.size; ++i) {
    met.numbers.push_back(crossing_of(segments.scalar_front[i]).number);
    met.depths.push_back(segments.front[i]);
  }
  return met;
}

TEST(FaceMarks, AtOneDepthAreInTheOrderOfAShiftedRay) {
  std::vector<FaceMark> marks{mark(1, 0.5, 0), mark(2, -1, 3), mark(3, -1, -2), mark(4, 0.5 + 1e-13, 0), mark(5, 0, 9)};
  // Marks are ordered by slope in x, then by slope in y; marks in one plane are ordered by number.
  const std::vector<std::uint32_t> expected{3, 2, 5, 1, 4};
  std::ranges::sort(marks, {}, &FaceMark::number);
  do {
    const Met found = met(marks);
    EXPECT_EQ(found.numbers, expected);
    EXPECT_TRUE(std::ranges::is_sorted(found.depths));
    EXPECT_EQ(std::ranges::adjacent_find(found.depths), found.depths.end()) << "each has a depth of its own";
    EXPECT_NEAR(found.depths.back(), 2, 1e-14);
  } while (std::next_permutation(marks.begin(), marks.end(),
                                 [](const FaceMark& a, const FaceMark& b) { return a.number < b.number; }));
}

TEST(FaceMarks, OfDifferentDepthsAreInTheOrderOfDepth) {
  EXPECT_EQ(met({mark(1, -5, 0, 2.5), mark(2, 5, 0, 2), mark(3, 0, 0, 3)}).numbers,
            (std::vector<std::uint32_t>{2, 1, 3}));
}

TEST(FaceMarks, CellsEndBeforeThoseThatTheyMeetAndBeginBehindThem) {
  FaceMarks marks;
  marks.reset(1);
  for (const FaceMark& m : {mark(10, 1, 0), mark(20, -1, 0), mark(30, 0, 0)}) marks.add(m);
  marks.sort();
  RaySegments segments;
  segments.reserve(16);
  const auto add = [&](double front, double back, double scalar_front) {
    const std::size_t at = segments.size++;
    segments.pixel_and_tet[at] = 0;
    segments.front[at] = front, segments.back[at] = back;
    segments.scalar_front[at] = scalar_front, segments.scalar_back[at] = 1;
  };
  add(1, 2, 0);                           // ends there
  add(2, 3, 0);                           // begins there
  add(1, 3, 0);                           // passes through
  add(2, 2, marked(Crossing{5, 0.5f}));   // an iso-surface that the ray meets before it leaves a cell
  add(2, 2, marked(Crossing{15, 0.5f}));  // in front of all larger numbers
  add(2, 2, marked(Crossing{99, 0.5f}));  // behind all
  marks.cut(segments, 0);
  ASSERT_EQ(segments.size, 7u) << "the third has two parts";
  const std::vector<double> places = met({mark(10, 1, 0), mark(20, -1, 0), mark(30, 0, 0)}).depths;
  EXPECT_EQ(segments.back[0], 2);
  EXPECT_LT(segments.back[0], places.front());
  EXPECT_GT(segments.front[1], places.back());
  EXPECT_EQ(segments.back[2], 2);
  EXPECT_EQ(segments.front[6], segments.front[1]);
  EXPECT_EQ(segments.back[6], 3);
  // In the order of slopes, the numbers are 20, 30, 10.
  EXPECT_LT(segments.front[3], places[0]);
  EXPECT_LT(segments.front[4], places[0]);
  EXPECT_GT(segments.front[5], places[2]);
  EXPECT_LT(segments.front[5], segments.front[1]);
}

}  // namespace
}  // namespace tessera::projection
