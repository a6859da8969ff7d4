// SPDX-License-Identifier: BSD-3-Clause
#include "scene/error.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <type_traits>

namespace tessera::scene {
namespace {

struct Parts {
  std::string subject, problem, remedy;
  bool operator==(const Parts&) const = default;
};

Parts parts(const Error& error) {
  return {std::string(error.subject()), std::string(error.problem()), std::string(error.remedy())};
}

Parts split(const std::string& line) {
  const Error error(ErrorCode::bad_input, line);
  EXPECT_STREQ(error.what(), line.c_str());
  return parts(error);
}

TEST(Error, SplitsALineIntoItsParts) {
  EXPECT_EQ(split("mesh.vtu: cell 3 has no volume; write the file again"),
            (Parts{"mesh.vtu", "cell 3 has no volume", "write the file again"}));
  EXPECT_EQ(split("rank 3 of 8: tile 17: 12 bytes; please report"),
            (Parts{"rank 3 of 8", "tile 17: 12 bytes", "please report"}));
  EXPECT_EQ(split("`deep_accuracy` 0.5: it must be 1e-6 to 1"),
            (Parts{"`deep_accuracy` 0.5", "it must be 1e-6 to 1", ""}));
  EXPECT_EQ(split("opacity scale is -1; it must not be negative"),
            (Parts{"", "opacity scale is -1", "it must not be negative"}));
}

TEST(Error, TheRemedyFollowsTheLastMarkAndTheSubjectPrecedesTheFirst) {
  EXPECT_EQ(split("a: b: c; d; e"), (Parts{"a", "b: c; d", "e"}));
  EXPECT_EQ(split("broken; do this: that"), (Parts{"", "broken", "do this: that"}));
  EXPECT_EQ(split("C:\\mesh;1.vtu: empty"), (Parts{"C:\\mesh;1.vtu", "empty", ""}));
}

TEST(Error, LinesOfNoFormAreAProblem) {
  EXPECT_EQ(split("full"), (Parts{"", "full", ""}));
  EXPECT_EQ(split(""), (Parts{"", "", ""}));
  EXPECT_EQ(split(": a"), (Parts{"", ": a", ""}));
  EXPECT_EQ(split("a: "), (Parts{"a", "", ""}));
  EXPECT_EQ(split("a; "), (Parts{"", "a", ""}));
}

TEST(Error, IsAboutTheSettingThatItsLineBeginsWith) {
  const auto setting = [](const std::string& line) { return std::string(bad_input(line).setting()); };
  EXPECT_EQ(setting("`deep_accuracy` 0.5: it must be 1e-6 to 1"), "deep_accuracy");
  EXPECT_EQ(setting("`zoom` is 0; it must be above 0"), "zoom");
  EXPECT_EQ(setting("`shade`: `rasterizer` scanline does not shade; use `rasterizer` planes"), "shade");
  EXPECT_EQ(setting("mesh.vtu: `smooth` is for meshes; leave it out"), "");
  EXPECT_EQ(setting("`shade"), "");
  EXPECT_EQ(setting(""), "");
}

TEST(Error, JoinsPartsWhateverTheyHold) {
  const Error error(ErrorCode::system_failure, "odd: name; 1.vtu", "is cut: short", "copy it; or write it again");
  EXPECT_EQ(error.code(), ErrorCode::system_failure);
  EXPECT_STREQ(error.what(), "odd: name; 1.vtu: is cut: short; copy it; or write it again");
  EXPECT_EQ(parts(error), (Parts{"odd: name; 1.vtu", "is cut: short", "copy it; or write it again"}));
}

TEST(Error, OmitsTheSeparatorsOfEmptyParts) {
  const auto line = [](const char* subject, const char* remedy) {
    const Error error(ErrorCode::bad_input, subject, "is wrong", remedy);
    EXPECT_EQ(parts(error), (Parts{subject, "is wrong", remedy}));
    return std::string(error.what());
  };
  EXPECT_EQ(line("", ""), "is wrong");
  EXPECT_EQ(line("a", ""), "a: is wrong");
  EXPECT_EQ(line("", "correct it"), "is wrong; correct it");
}

TEST(Error, EndsAtANullCharacterLikeWhat) {
  const Error from_line(ErrorCode::bad_input, std::string("a\0b: c; d", 9));
  EXPECT_EQ(parts(from_line), (Parts{"a", "", ""}));
  const Error from_parts(ErrorCode::bad_input, std::string_view("a\0b", 3), "c", "d");
  EXPECT_EQ(parts(from_parts), (Parts{"a", "", ""}));
}

TEST(Error, CopiesKeepTheParts) {
  static_assert(std::is_nothrow_copy_constructible_v<Error>);
  std::optional<Error> copy;
  {
    const Error error(ErrorCode::system_failure, "odd: name", "is wrong", "correct it");
    copy = error;
  }
  EXPECT_EQ(copy->code(), ErrorCode::system_failure);
  EXPECT_EQ(parts(*copy), (Parts{"odd: name", "is wrong", "correct it"}));
  try {
    throw Error(*copy);
  } catch (const std::runtime_error& caught) {
    EXPECT_STREQ(caught.what(), "odd: name: is wrong; correct it");
  }
}

TEST(Error, KeepsKnownSubjectsWhole) {
  const Error error = bad_input("odd: name; 1.vtu: line 3: is cut short; write the file again");
  EXPECT_EQ(error.subject(), "odd");
  const Error known = with_subject(error, "odd: name; 1.vtu");
  EXPECT_STREQ(known.what(), error.what());
  EXPECT_EQ(known.code(), error.code());
  EXPECT_EQ(parts(known), (Parts{"odd: name; 1.vtu", "line 3: is cut short", "write the file again"}));
  EXPECT_EQ(parts(with_subject(bad_input("a; b: is empty"), "a; b")), (Parts{"a; b", "is empty", ""}));
  // An error with another subject is unchanged.
  for (const char* other : {"", "od", "name", "odd: name", "another.vtu"})
    EXPECT_EQ(parts(with_subject(error, other)), parts(error)) << other;
}

TEST(Error, CodesAreTheProgramsExitStatuses) {
  EXPECT_EQ(static_cast<int>(ErrorCode::bad_input), 2);
  EXPECT_EQ(static_cast<int>(ErrorCode::system_failure), 3);
}

}  // namespace
}  // namespace tessera::scene
