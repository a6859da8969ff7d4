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

/// What explains a finished picture: colour bar, axes, outline, scale bar, text, drawn over it in its own colours.
///
/// Colours   linear light, premultiplied, as Image has it; display values for pictures of display colours
///           (AnnotationStyle::display_colors). The picture's depth stays as it is.
/// Lengths   on the picture in pixels, from its top left corner, y downwards; of the data in world units.
/// Text      UTF-8, one font; what is no UTF-8 is shown as U+FFFD. Too long a text loses its middle.
/// Room      what has no room on a small picture is left out.
/// Same bits for any number of threads and processes: all depends on the arguments alone. Fonts are the machine's.
namespace tessera {
inline namespace v0_1 {

/// Where something stands on the picture. What shares a place is stacked, away from the picture's edge.
enum class Place { top_left, top, top_right, left, right, bottom_left, bottom, bottom_right };

/// The transfer function over a range of values: its colours, opaque, and beside them a graph of its extinction, of the
/// largest in that range. Ticks at round values.
struct ColorBar {
  std::string title{};         ///< the field's name, say, and its unit
  Place place = Place::right;  ///< upright at the left and right, else level
  bool logarithmic = false;    ///< the range must be above 0
  /// Values at the bar's ends; default: the first and last knot's.
  std::optional<std::array<double, 2>> range{};
};

/// Which way the world's axes point, and where the data lies along them.
struct Axes {
  /// Three arrows in a corner: the view's directions, without perspective.
  bool triad = true;
  /// Round values along three edges of the data's box, those at its border on the picture.
  bool box = false;
  Place place = Place::bottom_left;  ///< of the triad
};

/// The twelve edges of the data's box, in front of the picture or behind it: an edge between two faces that look away
/// from the eye has all of the data before it, and is seen through the picture; any other has all of it behind. So the
/// order is exact, for an eye inside the box too (all edges are behind then).
struct Outline {};

/// A bar of a round length. Orthographic views: that length across the view, anywhere. Perspective: at the depth of the
/// focal point, which its label says.
struct ScaleBar {
  Place place = Place::bottom_right;
};

struct Text {
  std::string text;
  Place place = Place::top_left;
};

struct AnnotationStyle {
  /// Text and lines; default: black or white, whichever is further from the background; black where there is none.
  std::optional<glm::dvec3> ink{};
  /// Height of text, pixels; default: by the picture's size.
  std::optional<double> text_size{};
  std::string length_unit{};  ///< of the world: "mm"; empty: not said
  /// What will be composited behind the picture. Ink is then surrounded by this colour, else by the opposite of it,
  /// so that it can be read over bright and dark data, and on any page.
  std::optional<glm::dvec3> background{};
  bool display_colors = false;  ///< ink, background and the picture are display (sRGB) values, not linear light
};

/// All that is to be drawn; nothing by default.
struct Annotation {
  std::optional<ColorBar> color_bar{};
  std::optional<Axes> axes{};
  std::optional<Outline> outline{};
  std::optional<ScaleBar> scale_bar{};
  std::vector<Text> texts{};
  AnnotationStyle style{};
};

/// Draws over `picture`, which was rendered of `view`. `box` is the data's (Dataset::bounds()); empty, it has neither
/// outline nor labelled edges.
/// Throws as validate(), and Error(bad_input) for an invalid view or a picture of another size.
TESSERA_EXPORT void annotate(Image& picture, const Annotation& annotation, const View& view, const Box& box,
                             const TransferFunction& transfer_function);

/// The annotation alone, with alpha, transparent elsewhere: composited over `picture` it gives what annotate() makes of
/// it. Lines behind the data have the colour there that they are seen in. Throws as annotate().
TESSERA_EXPORT Image annotation_layer(const Image& picture, const Annotation& annotation, const View& view,
                                      const Box& box, const TransferFunction& transfer_function);

/// Whether it can be drawn, to be asked before rendering. Throws Error(bad_input) for a number out of range, naming it,
/// and where the library was built without Cairo (TESSERA_CAIRO); Error(system_failure) if there is no font.
TESSERA_EXPORT void validate(const Annotation& annotation, const TransferFunction& transfer_function);

/// A word in braces and what it stands for.
using AnnotationWord = std::pair<std::string, std::string>;

/// `text` with "{name}" replaced for each of `words`. Throws Error(bad_input) for another word in braces (small letters
/// and _), naming those that there are; other braces stay.
TESSERA_EXPORT std::string fill_in(const std::string& text, std::span<const AnnotationWord> words);

}  // namespace v0_1
}  // namespace tessera
