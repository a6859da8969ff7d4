// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/export.hpp"
#include "tessera/image.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

/// Explanations drawn over a finished image in its own colours: colour bar, axes, outline, scale bar, text.
///
/// Colours   linear light, premultiplied, as in Image; display values for images of display colours
///           (AnnotationStyle::display_colors). The depth of the image does not change.
/// Lengths   on the image in pixels, from its top left corner, y downwards; those of the data in world units.
/// Text      UTF-8, one font; invalid UTF-8 is shown as U+FFFD. A text that is too long loses its middle.
/// Space     elements that do not fit on a small image are left out.
/// The result depends only on the arguments and on the fonts installed: it has the same bits for any number of threads
/// and processes.
namespace tessera {
inline namespace v0_1 {

/// Position of an element on the image. Elements with the same position are stacked, starting at the image's edge.
enum class Place { top_left, top, top_right, left, right, bottom_left, bottom, bottom_right };

/// The transfer function over a range of values: its colours, drawn opaque, next to a graph of its extinction relative
/// to the largest in that range. Ticks are at round values.
struct ColorBar {
  std::string title{};         ///< for example the field's name and its unit
  Place place = Place::right;  ///< upright at the left and right, otherwise horizontal
  bool logarithmic = false;    ///< the range must be above 0
  /// Values at the ends of the bar; default: those of the first and last knot.
  std::optional<std::array<double, 2>> range{};
};

/// The directions of the world's axes, and the extent of the data along them.
struct Axes {
  /// Three arrows in a corner: the directions of the axes in this view, without perspective.
  bool triad = true;
  /// Round values along three edges of the data's box, chosen from the edges at its silhouette.
  bool box = false;
  Place place = Place::bottom_left;  ///< of the triad
};

/// The twelve edges of the data's box, in front of the data or behind them. An edge between two faces that point away
/// from the eye is behind all of the data and is seen through the image; any other edge is in front of all of it. The
/// order is therefore exact, also for an eye inside the box (all edges are then behind).
struct Outline {};

/// A bar of a round length. Orthographic views: the length holds everywhere across the view. Perspective: it holds at
/// the depth of the focal point, which the label states.
struct ScaleBar {
  Place place = Place::bottom_right;
};

struct Text {
  std::string text;
  Place place = Place::top_left;
};

struct AnnotationStyle {
  /// Text and lines; default: black or white, whichever differs more from the background; black without a background.
  std::optional<glm::dvec3> ink{};
  /// Height of text in pixels; default: depends on the image size.
  std::optional<double> text_size{};
  std::string length_unit{};  ///< of the world: "mm"; empty: not shown
  /// What will be composited behind the image. Text and lines are then outlined in this colour, otherwise in the
  /// opposite of their own, so that they can be read over bright and dark data and on any page.
  std::optional<glm::dvec3> background{};
  bool display_colors = false;  ///< ink, background and the image are display (sRGB) values, not linear light
};

/// Everything to draw; nothing by default.
struct Annotation {
  std::optional<ColorBar> color_bar{};
  std::optional<Axes> axes{};
  std::optional<Outline> outline{};
  std::optional<ScaleBar> scale_bar{};
  std::vector<Text> texts{};
  AnnotationStyle style{};
};

/// Draws over `picture`, an image rendered from `view`. `box` is that of the data (Dataset::bounds()); if it is empty,
/// neither the outline nor the labelled edges are drawn. Throws as validate(), and Error(bad_input) for an invalid view
/// or an image of another size.
TESSERA_EXPORT void annotate(Image& picture, const Annotation& annotation, const View& view, const Box& box,
                             const TransferFunction& transfer_function);

/// The annotation alone, with alpha, transparent elsewhere: composited over `picture` it gives the result of
/// annotate(). Lines behind the data have the colour in which they are seen through the image. Throws as annotate().
TESSERA_EXPORT Image annotation_layer(const Image& picture, const Annotation& annotation, const View& view,
                                      const Box& box, const TransferFunction& transfer_function);

/// Checks before rendering whether the annotation can be drawn. Throws Error(bad_input) for a number out of range,
/// naming it, and if the library was built without Cairo (TESSERA_CAIRO); Error(system_failure) if there is no font.
TESSERA_EXPORT void validate(const Annotation& annotation, const TransferFunction& transfer_function);

/// A word in braces and the text that replaces it.
using AnnotationWord = std::pair<std::string, std::string>;

/// `text` with "{name}" replaced for each of `words`. Throws Error(bad_input) for an unknown word in braces (lower-case
/// letters and _), listing the known ones; other braces stay.
TESSERA_EXPORT std::string fill_in(const std::string& text, std::span<const AnnotationWord> words);

}  // namespace v0_1
}  // namespace tessera
