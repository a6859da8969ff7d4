// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "tessera/camera.hpp"
#include "tessera/export.hpp"

/// Views not given as a camera: the default view and the named views.
///
/// Up      z unless the caller states otherwise. Medical files state the anatomical axes: z points to the head in all
///         of them.
/// Default a little from the right and from above: 30 degrees about the vertical, 25 above the horizon. Flat data
///         (lower than a fifth of both sides) are seen from 60 degrees above. The side towards the eye is the file's
///         -y, or +x if the data are more than half again as deep as wide; for a patient always the face.
/// Fit     the whole box is in the image, with a margin of 5 %.
namespace tessera {
inline namespace v0_1 {

/// The anatomical axes that a file states. z points to the head in both systems.
enum class BodyAxes {
  none,  ///< not stated: not a patient
  ras,   ///< x to the patient's right or left, y to the front: NIfTI, MINC, NRRD's RAS and LAS
  lps,   ///< y to the back: DICOM, NRRD's LPS, MetaImage with an AnatomicalOrientation
};

/// Named directions. For a patient (BodyAxes) `front`, `back`, `left` and `right` show that side of the body; left is
/// the patient's left. For other data `front` looks along +y, `right` along -x and so on. `top` looks along -z, `iso`
/// along (-1, 1, -1). The others look along an axis, whatever the data. Up in the image is z; in views along z it is y.
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

/// "front" ... "iso", or "+x", "-z": the axis of the view direction. Nothing for any other word.
TESSERA_EXPORT std::optional<StandardView> standard_view(std::string_view word);

/// The requested view. The defaults are those above.
struct ViewRequest {
  StandardView view = StandardView::automatic;
  std::optional<glm::dvec3> up{};  ///< world direction that points up in the image, any length but zero
  /// Degrees, as in vtkCamera: the eye moves about the up axis to the right, then upwards over the horizon, in this
  /// order.
  double azimuth = 0, elevation = 0;
  double zoom = 1;   ///< magnification of the middle of the image, > 0
  bool fit = false;  ///< with a caller's camera: keep its directions, but frame the box

  bool operator==(const ViewRequest&) const = default;
};

/// The requested view of this box. `turning`: wide enough for every turn of orbit(). Throws Error(bad_input) for an
/// `up` of zero length or along the view, a number that is not finite, or a zoom that is not positive.
TESSERA_EXPORT Camera view_of_box(const Box& box, ImageSize size, const ViewRequest& request = {},
                                  ProjectionKind projection = ProjectionKind::orthographic,
                                  BodyAxes axes = BodyAxes::none, bool turning = false);

/// A caller's camera with azimuth, elevation, zoom and `fit` applied; the same bits if none is requested. Throws as
/// above, and for a named view or an `up`, which the camera already has.
TESSERA_EXPORT Camera adjusted_view(const Camera& camera, const Box& box, ImageSize size, const ViewRequest& request);

/// A view of the whole box: the eye is in direction `to_eye` from its centre, `up` points up; neither needs unit
/// length. The whole box is in the image, with a margin of 5 %.
TESSERA_EXPORT Camera frame_box_along(const Box& box, ImageSize size, const glm::dvec3& to_eye, const glm::dvec3& up,
                                      ProjectionKind projection = ProjectionKind::orthographic, bool turning = false);

}  // namespace v0_1
}  // namespace tessera
