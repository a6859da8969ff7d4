#include <gtest/gtest.h>

#include "datasets/boxes.hpp"
#include "frame/render.hpp"
#include "reference/judge.hpp"

/// Thin dense sheets, through which a ray goes a hundred-thousandth of what their faces span in depth.
namespace tessera::frame {
namespace {

struct Sheet {
  double thickness, length, ahead, beside, view_angle, extinction;
};

class Sheets : public testing::TestWithParam<Sheet> {};
INSTANTIATE_TEST_SUITE_P(Frame, Sheets,
                         testing::Values(Sheet{3e-4, 2, 0.12, 1.73, 140, 300}, Sheet{5e-4, 2.5, 0.105, 2.02, 125, 77},
                                         Sheet{7e-4, 2, 0.24, 0.42, 149, 520}, Sheet{2.5e-4, 1, 0.057, 0.93, 147, 87},
                                         Sheet{1.1e-3, 3.1, 0.042, 1.2, 131, 87},
                                         Sheet{6e-3, 2.2, 0.24, 3.1, 115, 220}));

/// The eye looks along a sheet beside it: depth is the sheet's length, rays at the window's edge go through its
/// thickness.
TEST_P(Sheets, KeepTheirThicknessUnderWidePerspective) {
  const Sheet sheet = GetParam();
  scene::TetMesh mesh = datasets::regular_split(2, 1, 2, {2, sheet.thickness, sheet.length / 2},
                                                {-2, -sheet.thickness, -sheet.ahead - sheet.length});
  scene::Camera camera;
  camera.position = {0.031, sheet.beside, 0};
  camera.focal_point = {0.031, sheet.beside, -1};
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = sheet.view_angle;
  constexpr scene::ImageSize size{40, 40};
  const auto [low, high] = scene::scalar_range(mesh);
  const scene::TransferFunction function(
      {{low, {0.2, 0.4, 0.9}, sheet.extinction}, {high, {0.9, 0.5, 0.2}, 0.7 * sheet.extinction}});
  for (const double bound : {2e-5, 1e-5}) {
    RenderSettings settings;
    settings.integrator.kind = bound == 2e-5 ? scene::IntegratorKind::exact : scene::IntegratorKind::automatic;
    settings.integrator.accuracy = bound;
    const scene::Image image = Renderer(mesh, settings).render(camera, size, function);
    const reference::Reference reference(mesh, camera, size, function);
    const reference::Judgement judgement = reference::judge(image, reference, bound);
    EXPECT_LE(judgement.max_error_not_excused, bound) << judgement.over_bound << " over";
  }
}

}  // namespace
}  // namespace tessera::frame
