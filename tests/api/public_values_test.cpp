// SPDX-License-Identifier: BSD-3-Clause
// Values of the public API that are created, or written as text, without an image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "api/query_data.hpp"
#include "scene/error.hpp"
#include "tessera/presets.hpp"
#include "tessera/session.hpp"
#include "tessera/view.hpp"

namespace tessera::public_values_test {
namespace {

TEST(PublicValues, PresetColorsAreThoseOfTheFunction) {
  for (const std::string& name : preset_names()) {
    const std::vector<glm::dvec3> colors = preset_colors(name, 33);
    ASSERT_EQ(colors.size(), 33u);
    const TransferFunction function = preset_function(name);
    const auto decoded = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    for (std::size_t i = 0; i < colors.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(decoded(colors[i][c]), function.evaluate(static_cast<double>(i) / 32).color[c], 3e-3) << name;
  }
  EXPECT_EQ(preset_colors("gray", 2), (std::vector{glm::dvec3(0), glm::dvec3(1)}));
  EXPECT_THROW((void)preset_colors("nowhere", 3), Error);
  EXPECT_THROW((void)preset_colors("viridis", 1), Error);
}

TEST(PublicValues, CamerasAreReadFromTextAsFromFiles) {
  CameraFile one{{}, ImageSize{30, 20}};
  one.camera.position = {4, 3, 5};
  one.camera.parallel_scale = 2;
  CameraFile other = one;
  other.camera.projection = ProjectionKind::perspective;
  other.camera.parallel_scale = 1;
  other.camera.clipping_range = {1, 9};
  EXPECT_EQ(cameras_of(camera_json(one)), std::vector{one});
  std::string list = "[";
  list += camera_json(one);
  list += ',';
  list += camera_json(other);
  list += ']';
  EXPECT_EQ(cameras_of(list), (std::vector{one, other}));
  EXPECT_EQ(parse_cameras(camera_json(other), "state"), std::vector{other});
  EXPECT_TRUE(is_json_text("{}") && is_json_text("[") && !is_json_text("./{}") && !is_json_text(""));
  const auto message = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([] { (void)parse_cameras("{\"eye\": 1}", "state"); }).rfind("state: ", 0), 0u);
  EXPECT_EQ(message([] { (void)cameras_of("{\"eye\": 1}"); }).rfind("`camera`: ", 0), 0u);
}

/// A function that is exported and read back renders the same.
TEST(PublicValues, FunctionsAsTextRenderAlike) {
  const Dataset data = Dataset::of(datasets::arrays_of(datasets::cube(8)));
  const View view = data.default_view({80, 60});
  Settings settings;
  settings.integrator.kind = IntegratorKind::exact;
  Session session(data, settings);
  for (const char* name : {"", "turbo:peaks", "cool-warm:surface", "inferno:rise"}) {
    const LoadedTransferFunction loaded = data.transfer_function(name);
    const Image expected = session.render(view, loaded.function).image;
    const TransferFunction same = data.transfer_function(transfer_function_json(loaded.function)).function;
    EXPECT_TRUE(std::ranges::equal(same.knots(), loaded.function.knots())) << name;
    for (const double distance : {loaded.unit_distance.value_or(1), 1e3}) {
      const auto back = data.transfer_function(paraview_json(loaded.function, distance, "exported"));
      const Image seen = session.render(view, back.function).image;
      double most = 0;
      for (std::size_t i = 0; i < seen.rgba.size(); ++i)
        most = std::max(most, std::abs(double{seen.rgba[i]} - expected.rgba[i]));
      EXPECT_LT(most, 5e-4) << name;
    }
  }
}

}  // namespace
}  // namespace tessera::public_values_test
