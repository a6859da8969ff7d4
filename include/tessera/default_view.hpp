// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "tessera/camera.hpp"
#include "tessera/export.hpp"

/// Views not given as a camera: the default view and the named views.
///
/// Up      z, unless the caller specifies another direction. In medical files, which state the anatomical axes, z
///         always points to the head.
/// Default The eye is a little to the right and above: rotated by 30 degrees about the vertical and 25 degrees above
/// the
///         horizon. Flat data, whose height is less than a fifth of both sides, are seen from 60 degrees above the
///         horizon. The side towards the eye is the file's -y, or +x if the data are more than 1.5 times as deep as
///         wide; for a patient, this side is always the face.
/// Fit     The whole box is in the image, with a margin of 5 %.
namespace tessera {
inline namespace v0_1 {

/// The anatomical axes that a file states. z points to the head in both systems.
enum class BodyAxes {
  none,  ///< not stated: the data are not those of a patient
  ras,   ///< x to the patient's right or left, y to the front: NIfTI, MINC, NRRD's RAS and LAS
  lps,   ///< y to the back: DICOM, NRRD's LPS, MetaImage with an AnatomicalOrientation
};

/// Named view directions. For a patient (BodyAxes), `front`, `back`, `left` and `right` show the side of the body with
/// this name; left is the patient's left. For other data, `front` looks along +y, `right` along -x and so on. For all
/// data, `top` looks along -z and `iso` along (-1, 1, -1); the remaining views look along the axis in their names. The
/// z axis points up in the image; in views along z, the y axis points up.
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

/// Returns the view of this name: "front" to "iso", or the axis along which it looks, like "+x" or "-z". Returns
/// nothing for any other word.
TESSERA_EXPORT std::optional<StandardView> standard_view(std::string_view word);

/// A requested view. The default values request the default view described at the top of this file.
struct ViewRequest {
  StandardView view = StandardView::automatic;
  std::optional<glm::dvec3> up{};  ///< world direction that points up in the image, any length but zero
  /// Rotations in degrees, as in vtkCamera: first the eye moves to the right about the up axis, then upwards over the
  /// horizon.
  double azimuth = 0, elevation = 0;
  double zoom = 1;   ///< magnification about the centre of the image, > 0
  bool fit = false;  ///< for a caller's camera: the directions are kept, but the camera is moved so that the whole box
                     ///< is in the image

  bool operator==(const ViewRequest&) const = default;
};

/// Returns the requested view of the box. If `turning`, the view is wide enough for every turn of orbit(). Throws
/// Error(bad_input) for an `up` of zero length or along the view, a number that is not finite, or a zoom that is not
/// positive.
TESSERA_EXPORT Camera view_of_box(const Box& box, ImageSize size, const ViewRequest& request = {},
                                  ProjectionKind projection = ProjectionKind::orthographic,
                                  BodyAxes axes = BodyAxes::none, bool turning = false);

/// Returns a caller's camera with azimuth, elevation, zoom and `fit` applied. If none of these is requested, the camera
/// is returned bit for bit. Throws the same errors as view_of_box(), and Error(bad_input) if the request has a named
/// view or an `up`, because the camera already specifies these.
TESSERA_EXPORT Camera adjusted_view(const Camera& camera, const Box& box, ImageSize size, const ViewRequest& request);

/// Returns a view of the whole box, with a margin of 5 %. The eye is in direction `to_eye` from the centre of the box,
/// and `up` points up in the image. The two vectors may have any length but zero.
TESSERA_EXPORT Camera frame_box_along(const Box& box, ImageSize size, const glm::dvec3& to_eye, const glm::dvec3& up,
                                      ProjectionKind projection = ProjectionKind::orthographic, bool turning = false);

}  // namespace v0_1
}  // namespace tessera
