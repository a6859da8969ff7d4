// SPDX-License-Identifier: BSD-3-Clause
// Without Cairo nothing is drawn, and this is reported.

#include <gtest/gtest.h>

#include <functional>

#include "tessera/annotation.hpp"
#include "tessera/error.hpp"

namespace tessera {
namespace {

TEST(AnnotationAbsent, ReportsThatTheBuildLacksCairo) {
  Annotation annotation;
  annotation.color_bar.emplace();
  Image picture({8, 8});
  const std::function<void()> all[] = {
      [&] {
        annotate(picture, annotation, {{}, {8, 8}}, {}, {});
      },
      [&] {
        (void)annotation_layer(picture, annotation, {{}, {8, 8}}, {}, {});
      },
      [&] { validate(annotation, TransferFunction{}); },
  };
  for (const auto& draw : all) {
    try {
      draw();
      FAIL() << "it drew";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find("Cairo"), std::string::npos) << error.what();
    }
  }
}

TEST(AnnotationAbsent, AnAnnotationOfNothingIsValidAndChangesNothing) {
  Image picture({8, 8});
  picture.rgba.front() = 0.5F;
  const Image before = picture;
  EXPECT_NO_THROW(validate(Annotation{}, TransferFunction{}));
  annotate(picture, {}, {{}, {8, 8}}, {}, {});
  EXPECT_EQ(picture.rgba, before.rgba);
  EXPECT_EQ(annotation_layer(picture, {}, {{}, {8, 8}}, {}, {}).rgba, Image({8, 8}).rgba);
}

}  // namespace
}  // namespace tessera
