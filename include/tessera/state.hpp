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

/// What to show of data, and how, as text: the options of `tessera render` (docs/REFERENCE.md) by their long names.
/// `render --config`, `serve` and programs use this form.
///
///   JSON  {"field": "T", "view": "front", "log": true, "iso": [0.5, "0.8:red"], "camera": {"position": [0, 0, 1]}}
///   TOML  field = "T"
///         iso = [0.5, "0.8:red"]
///
/// Values are text as on the command line, numbers, and true or false for an option without a value; lists for options
/// that may be repeated. In JSON a camera and a transfer function may be objects, and null leaves an option out.
/// Options about a run's output (`output`, `report`, ...) are kept, but have no effect here.
///
/// A value is checked when it is used: the functions that return values throw Error(bad_input), which names the option,
/// its value and the allowed values, also for options that have no effect together or on this kind of data. The image
/// is identical to that of the program, to the byte:
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
  /// By option: "true" for a flag, one text for most options, several for lists.
  using Words = std::map<std::string, std::vector<std::string>, std::less<>>;

  /// Throw Error(bad_input), which begins with `name`, for text that is not a JSON object or not TOML of this form, for
  /// an unknown option, and for a value of the wrong type.
  static State from_json(std::string_view text, const std::string& name = "state");
  static State from_toml(std::string_view text, const std::string& name = "state");
  /// Throws Error(bad_input) for a value that is not UTF-8, like a path of other bytes; toml() keeps its bytes.
  [[nodiscard]] std::string json() const;
  [[nodiscard]] std::string toml() const;

  [[nodiscard]] const Words& words() const { return words_; }
  /// Without values the option is removed. Throws as from_json().
  void set(std::string_view option, std::vector<std::string> values);
  void set(std::string_view option, std::string value) { set(option, std::vector{std::move(value)}); }

  // To values.

  /// How a file is read. open() determines the tolerance of higher-order cells unless an option states it.
  [[nodiscard]] ReadOptions read_options(DataKind kind) const;
  /// Opens a mesh, in one or several pieces, or a grid, as Dataset::open() with read_options(); higher-order cells are
  /// divided as finely as `accuracy` requires (read_for_accuracy()). Opens one time step: that of the option, counted
  /// in the file.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const Communicator& communicator = {}) const;
  /// Includes the surfaces of blocks, which are read from the data's files, and shading if the default transfer
  /// function intends it and no option excludes it. Throws Error(bad_input) for a block of data without files.
  [[nodiscard]] Settings settings(const Dataset& data) const;
  [[nodiscard]] LoadedTransferFunction transfer_function(const Dataset& data) const;
  /// The view; the first one of a file with several.
  [[nodiscard]] View view(const Dataset& data) const;
  /// With its texts filled in: {field}, {time}, {file}, {min} and {max} from the data; `frame` replaces {frame}.
  [[nodiscard]] Annotation annotation(const Dataset& data, int frame = 0) const;
  [[nodiscard]] ImageFileOptions image_file_options() const;

  // The reverse: sets the options of each value to what the functions above return, and removes those that equal the
  // defaults. They throw Error(bad_input) naming what no option can express.

  /// Except for members without an option: `shape`, `grid_as_mesh`, `keep_corners`, `trace` and `progress`; and the
  /// levels of its selection, which are those of `iso`.
  void set(const ReadOptions& read);
  /// `kind`: whether the settings of meshes or of grids count. Surfaces of triangles cannot be expressed.
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
