// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/annotation.hpp"
#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/image_file_options.hpp"
#include "tessera/read_options.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

/// A description, as text, of what to show of the data and how: the options of `tessera render` (docs/REFERENCE.md)
/// with their long names. `render --config`, `serve` and other programs use this form.
///
///   JSON  {"field": "T", "view": "front", "log": true, "iso": [0.5, "0.8:red"], "camera": {"position": [0, 0, 1]}}
///   TOML  field = "T"
///         iso = [0.5, "0.8:red"]
///
/// Values are text as on the command line, numbers, and true or false for options without a value. Options that may be
/// repeated have lists of values. In JSON, a camera and a transfer function may be objects, and an option whose value
/// is null is ignored. Options for the output of a run (`output`, `report`, ...) are kept, but have no effect here.
///
/// A value is checked when it is used: the functions that return values throw Error(bad_input), which states the
/// option, its value and the allowed values. They also throw it for options that have no effect in combination or on
/// this kind of data. The following code writes the same image, byte for byte, as the program:
///
///   const State state = State::from_json(text);
///   const Dataset data = state.open(files);
///   Session session(data, state.settings(data));
///   const LoadedTransferFunction loaded = state.transfer_function(data);
///   RenderedFrame frame = session.render(state.view(data), loaded.function);
///   annotate(frame.image, state.annotation(data), state.view(data), data.bounds(), loaded.function);
///   write_image(frame.image, "picture.png", state.image_file_options());
class TESSERA_EXPORT State {
 public:
  /// The values of each option: "true" for a flag, one text for most options, several for lists.
  using Words = std::map<std::string, std::vector<std::string>, std::less<>>;

  /// These functions throw Error(bad_input), whose message begins with `name`, if the text is not a JSON object or not
  /// TOML of this form, if an option is unknown, or if a value has the wrong type.
  static State from_json(std::string_view text, const std::string& name = "state");
  static State from_toml(std::string_view text, const std::string& name = "state");
  /// json() throws Error(bad_input) for a value that is not UTF-8, such as a path in another encoding; toml() keeps the
  /// bytes of such values.
  [[nodiscard]] std::string json() const;
  [[nodiscard]] std::string toml() const;

  [[nodiscard]] const Words& words() const { return words_; }
  /// Sets the values of an option; without values, the option is removed. Throws the same errors as from_json().
  void set(std::string_view option, std::vector<std::string> values);
  void set(std::string_view option, std::string value) { set(option, std::vector{std::move(value)}); }

  // Conversion to values.

  /// The options for reading a file. open() determines the tolerance of higher-order cells unless an option states it.
  [[nodiscard]] ReadOptions read_options(DataKind kind) const;
  /// Opens a grid or a mesh, in one or several pieces, like Dataset::open() with read_options(). Higher-order cells are
  /// divided as finely as the option `accuracy` requires (read_for_accuracy()). Only one time step of the file is
  /// opened: the step that the option `time-step` states, counted within the file.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const Communicator& communicator = {}) const;
  /// The settings include the surfaces of blocks, which are read from the data's files. They include shading if the
  /// default transfer function intends it and no option excludes it. Throws Error(bad_input) for a block of data
  /// without files.
  [[nodiscard]] Settings settings(const Dataset& data) const;
  [[nodiscard]] LoadedTransferFunction transfer_function(const Dataset& data) const;
  /// The view. If the camera file contains several views, it is the first one.
  [[nodiscard]] View view(const Dataset& data) const;
  /// The annotation with the words in its texts replaced: {field}, {time}, {file}, {min} and {max} by the data's
  /// values, {frame} by `frame`.
  [[nodiscard]] Annotation annotation(const Dataset& data, int frame = 0) const;
  [[nodiscard]] ImageFileOptions image_file_options() const;

  // The reverse: these functions set the options so that the functions above return the given value, and remove options
  // that equal the defaults. They throw Error(bad_input), which names the member, if no option can express the value.

  /// Ignores the members without an option: `shape`, `grid_as_mesh`, `keep_corners`, `trace` and `progress`. Also
  /// ignores the levels of the selection, which are those of the option `iso`.
  void set(const ReadOptions& read);
  /// `kind` determines whether the settings of meshes or of grids are used. Surfaces of triangles cannot be expressed.
  void set(const Settings& settings, DataKind kind);
  void set(const TransferFunction& function);
  void set(const View& view);
  void set(const Annotation& annotation);
  void set(const ImageFileOptions& image);

  bool operator==(const State&) const = default;

 private:
  Words words_;
};

}  // namespace v0_1
}  // namespace tessera
