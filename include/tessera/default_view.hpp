// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "tessera/camera.hpp"
#include "tessera/export.hpp"

/// Views that nobody wrote down as a camera: the default one, and those that have a name.
///
/// Up      z, unless the caller says otherwise: a body, a mug, a reservoir stands. Medical files say where z leads (to
///         the head, in all of them), and which way the patient looks.
/// Default a little from the right and from above: 30 degrees round the vertical, 25 above it. What is flat (lower than
///         a fifth of both its sides) is seen from 60 degrees above. The side towards the eye is the file's -y, or the
///         one at +x if the body is more than half again as deep as wide; of a patient always the face.
/// Fit     the box is all in the picture, with a margin of 5 %.
namespace tessera {
inline namespace v0_1 {

/// What a file says of a patient's axes. z leads to the head in both.
enum class BodyAxes {
  none,  ///< nothing: no patient
  ras,   ///< x to the patient's right or left, y to the front: NIfTI, MINC, NRRD's RAS and LAS
  lps,   ///< y to the back: DICOM, NRRD's LPS, MetaImage with an AnatomicalOrientation
};

/// Named directions. Of a patient (BodyAxes) `front`, `back`, `left` and `right` show that side of the body, the left
/// one being the patient's. Of anything else `front` looks along +y, `right` along -x and so on. `top` looks along -z,
/// `iso` along (-1, 1, -1). The others look along an axis, whatever the data. Up in the picture is z, in views along z
/// it is y.
enum class StandardView {
  automatic,
  front,
  back,
  left,
  right,
  top,
  bottom,
  iso,
  along_x,
  against_x,
  along_y,
  against_y,
  along_z,
  against_z
};

/// "front" ... "iso", or "+x", "-z": the axis that is looked along. Nothing if it is no such word.
TESSERA_EXPORT std::optional<StandardView> standard_view(std::string_view word);

/// What is asked of a view. The defaults are those above.
struct ViewRequest {
  StandardView view = StandardView::automatic;
  std::optional<glm::dvec3> up{};  ///< world direction that points up in the picture, any length but zero
  /// Degrees, as vtkCamera's: the eye goes round the up axis to the right; then over the horizon, upwards. In this
  /// order.
  double azimuth = 0, elevation = 0;
  double zoom = 1;   ///< what is in the picture's middle is so many times as large, > 0
  bool fit = false;  ///< of a caller's camera: keep its directions, frame the box anew

  bool operator==(const ViewRequest&) const = default;
};

/// The view asked for of this box. `turning`: wide enough for every turn of orbit(). Throws Error(bad_input) for an
/// `up` of no length or along the view, a number that is not finite, a zoom that is not positive.
TESSERA_EXPORT Camera view_of_box(const Box& box, ImageSize size, const ViewRequest& request = {},
                                  ProjectionKind projection = ProjectionKind::orthographic,
                                  BodyAxes axes = BodyAxes::none, bool turning = false);

/// A caller's camera with azimuth, elevation, zoom and `fit` applied; the same bits if none is asked. Throws as above,
/// and for a named view or an `up`, which the camera has already.
TESSERA_EXPORT Camera adjusted_view(const Camera& camera, const Box& box, ImageSize size, const ViewRequest& request);

/// A view of the whole box: the eye lies in direction `to_eye` from its centre, `up` points up; neither need be of
/// length one. The box is all in the picture, with a margin of 5 %.
TESSERA_EXPORT Camera frame_box_along(const Box& box, ImageSize size, const glm::dvec3& to_eye, const glm::dvec3& up,
                                      ProjectionKind projection = ProjectionKind::orthographic, bool turning = false);

}  // namespace v0_1
}  // namespace tessera
