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

/// What is shown of data, and how, as text: the options of `tessera render` (docs/REFERENCE.md) by their long names.
/// `render --config`, `serve` and programs use this one form.
///
///   JSON  {"field": "T", "view": "front", "log": true, "iso": [0.5, "0.8:red"], "camera": {"position": [0, 0, 1]}}
///   TOML  field = "T"
///         iso = [0.5, "0.8:red"]
///
/// Values are text in the words of the command line, numbers, and true or false for an option without a value; lists
/// for options that may be repeated. In JSON a camera and a transfer function may be objects, and null leaves an option
/// out. Options about what a run writes (`output`, `report`, ...) are kept, and have no effect here.
///
/// A value is read when it is used: the functions that return values throw Error(bad_input) which names the option,
/// what was given and what is allowed, also for options that have no effect together or on this kind of data. The
/// picture is that of the program, to the byte:
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
  /// By option: "true" of a flag, one text of most, several of lists.
  using Words = std::map<std::string, std::vector<std::string>, std::less<>>;

  /// Throw Error(bad_input), which begins with `name`, for text that is no JSON object or no TOML of this form, for a
  /// name that no option has, and for a value of another kind.
  static State from_json(std::string_view text, const std::string& name = "state");
  static State from_toml(std::string_view text, const std::string& name = "state");
  [[nodiscard]] std::string json() const;
  [[nodiscard]] std::string toml() const;

  [[nodiscard]] const Words& words() const { return words_; }
  /// Without values the option is left out. Throws as from_json().
  void set(std::string_view option, std::vector<std::string> values);
  void set(std::string_view option, std::string value) { set(option, std::vector{std::move(value)}); }

  // To values.

  /// How a file is read. The tolerance of higher-order cells is open()'s concern where no option states it.
  [[nodiscard]] ReadOptions read_options(DataKind kind) const;
  /// Opens a mesh, in one piece or several, or a grid, as Dataset::open() with read_options(); higher-order cells as
  /// finely as `accuracy` needs (read_for_accuracy()). One time step: that of the option, counted in the file.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const Communicator& communicator = {}) const;
  /// With the surfaces of blocks, which are read from the data's files, and shaded where the default transfer function
  /// means it to be and no option speaks against it. Throws Error(bad_input) for a block of data without files.
  [[nodiscard]] Settings settings(const Dataset& data) const;
  [[nodiscard]] LoadedTransferFunction transfer_function(const Dataset& data) const;
  /// The first view, of several in a file.
  [[nodiscard]] View view(const Dataset& data) const;
  /// Its texts are filled in: {field}, {time}, {file}, {min} and {max} are the data's; `frame` is {frame}.
  [[nodiscard]] Annotation annotation(const Dataset& data, int frame = 0) const;
  [[nodiscard]] ImageFileOptions image_file_options() const;

  // Of values: sets the options of each so that it is what the functions above return, and leaves out those that are as
  // by default. Throw Error(bad_input) naming what no option can state.

  /// But for what is no option: `shape`, `grid_as_mesh`, `keep_corners`, `trace` and `progress`; and the levels of its
  /// selection, which are those of `iso`.
  void set(const ReadOptions& read);
  /// `kind`: of which the settings of meshes or of grids count. Surfaces of triangles have no words.
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
