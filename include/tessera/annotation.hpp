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

/// Annotations drawn over a finished image: colour bar, axes, outline, scale bar, text.
///
/// Colours   Colours are linear light, premultiplied, as in Image. For an image of display colours, they are display
///           values (AnnotationStyle::display_colors). The image's depth does not change.
/// Lengths   Lengths on the image are in pixels, measured from its top left corner, with y downwards. Lengths of the
///           data are in world units.
/// Text      UTF-8, one font; invalid UTF-8 is shown as U+FFFD. The middle of a text that is too long is left out.
/// Space     Elements that do not fit on a small image are left out.
/// The result depends only on the arguments and on the installed fonts. It has the same bits for any number of threads
/// and processes.
namespace tessera {
inline namespace v0_1 {

/// Position of an element on the image. Elements with the same position are stacked, starting at the image's edge.
enum class Place { top_left, top, top_right, left, right, bottom_left, bottom, bottom_right };

/// The transfer function over a range of values: its colours, drawn opaque, next to a graph of its extinction. The
/// graph is relative to the largest extinction in that range. Ticks are at round values.
struct ColorBar {
  std::string title{};         ///< for example the name and unit of the field
  Place place = Place::right;  ///< the bar is vertical at `left` and `right`, otherwise horizontal
  bool logarithmic = false;    ///< logarithmic scale; the range must be above 0
  /// Values at the ends of the bar. Default: the values of the first and last knot.
  std::optional<std::array<double, 2>> range{};
};

/// The directions of the world's axes, and the extent of the data along them.
struct Axes {
  /// Three arrows in a corner: the directions of the axes in this view, without perspective.
  bool triad = true;
  /// Labels at round values along three edges of the data's box. The edges are chosen from those at the box's
  /// silhouette.
  bool box = false;
  Place place = Place::bottom_left;  ///< position of the triad
};

/// The twelve edges of the data's box, each drawn in front of the data or behind them. An edge between two faces that
/// point away from the eye is behind all of the data and is seen through the image. Any other edge is in front of all
/// of the data. This order is exact, also for an eye inside the box: all edges are then behind the data.
struct Outline {};

/// A bar of a round length. In orthographic views the length is correct everywhere in the image. In perspective views
/// it is correct at the depth of the focal point, which the label states.
struct ScaleBar {
  Place place = Place::bottom_right;
};

struct Text {
  std::string text;
  Place place = Place::top_left;
};

struct AnnotationStyle {
  /// Colour of text and lines. Default: black or white, whichever differs more from the background; black if there is
  /// no background.
  std::optional<glm::dvec3> ink{};
  /// Height of text in pixels; default: depends on the image size.
  std::optional<double> text_size{};
  std::string length_unit{};  ///< unit of world lengths, for example "mm"; empty: not shown
  /// Colour that will be composited behind the image. If it is set, text and lines are outlined in this colour;
  /// otherwise they are outlined in the opposite of their own colour. They are therefore readable over bright and dark
  /// data and on any page.
  std::optional<glm::dvec3> background{};
  bool display_colors = false;  ///< ink, background and the image are display (sRGB) values, not linear light
};

/// All annotations to draw; none by default.
struct Annotation {
  std::optional<ColorBar> color_bar{};
  std::optional<Axes> axes{};
  std::optional<Outline> outline{};
  std::optional<ScaleBar> scale_bar{};
  std::vector<Text> texts{};
  AnnotationStyle style{};
};

/// Draws over `picture`, an image rendered from `view`. `box` is the bounding box of the data (Dataset::bounds()). If
/// the box is empty, neither the outline nor the labelled edges are drawn. Throws the same errors as validate(), and
/// Error(bad_input) if the view is invalid or the size of the image is not that of the view.
TESSERA_EXPORT void annotate(Image& picture, const Annotation& annotation, const View& view, const Box& box,
                             const TransferFunction& transfer_function);

/// Returns the annotation alone, as an image that is transparent elsewhere. Composited over `picture`, it gives the
/// result of annotate(). Lines behind the data have the colour in which they are seen through the image. Throws the
/// same errors as annotate().
TESSERA_EXPORT Image annotation_layer(const Image& picture, const Annotation& annotation, const View& view,
                                      const Box& box, const TransferFunction& transfer_function);

/// Checks before rendering whether the annotation can be drawn. Throws Error(bad_input), with the name of the number,
/// if a number is out of range; Error(bad_input) if the library was built without Cairo (TESSERA_CAIRO); and
/// Error(system_failure) if there is no font.
TESSERA_EXPORT void validate(const Annotation& annotation, const TransferFunction& transfer_function);

/// A word, without its braces, and the text that replaces it.
using AnnotationWord = std::pair<std::string, std::string>;

/// Returns `text` with each word in braces, like "{name}", replaced as `words` specify. A word consists of lower-case
/// letters and _; other braces are not changed. Throws Error(bad_input) for an unknown word and lists the known ones.
TESSERA_EXPORT std::string fill_in(const std::string& text, std::span<const AnnotationWord> words);

}  // namespace v0_1
}  // namespace tessera
