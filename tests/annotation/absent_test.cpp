// SPDX-License-Identifier: BSD-3-Clause
// Without Cairo nothing is drawn, and this is reported.

#include <gtest/gtest.h>

#include "tessera/annotation.hpp"
#include "tessera/error.hpp"

namespace tessera {
namespace {

TEST(AnnotationAbsent, SaysThatTheBuildLacksCairo) {
  Image picture({8, 8});
  for (const auto& draw : {+[](Image& image) {
                             annotate(image, {}, {{}, {8, 8}}, {}, {});
                           },
                           +[](Image& image) {
                             (void)annotation_layer(image, {}, {{}, {8, 8}}, {}, {});
                           },
                           +[](Image&) { validate(Annotation{}, TransferFunction{}); }}) {
    try {
      draw(picture);
      FAIL() << "it drew";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find("Cairo"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tessera
