// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image.hpp"
#include "tessera/image_file_options.hpp"
#include "tessera/read_progress.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

/// The interface to the options of `tessera render`: converts states of clients to values.
namespace tessera::server {

using Json = nlohmann::json;

/// The image described by a state. Immutable; statements about data refer to the data that it opened, or equal data.
///
/// Keys   equal keys mean equal values, so that a data set, a transfer function and a session are made once for all
///        states that differ in other respects.
class Scene {
 public:
  virtual ~Scene() = default;
  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Keys of the data: data stored under any of them are suitable.
  [[nodiscard]] virtual const std::vector<std::string>& data_keys() const = 0;
  /// The keys under which other scenes would open the same as `data`, which this scene opened; its own key first.
  [[nodiscard]] virtual std::vector<std::string> keys_of(const Dataset& data) const = 0;
  /// Key of its transfer function for given data.
  [[nodiscard]] virtual const std::string& look_key() const = 0;
  /// Key of its settings, without the effect of the function on them.
  [[nodiscard]] virtual const std::string& settings_key() const = 0;

  /// The field in the form of `--field`.
  [[nodiscard]] virtual std::string field_word(const Dataset& data) const = 0;

  /// Reads the data, with all ranks. Throws Error.
  [[nodiscard]] virtual Dataset open(const Communicator& communicator, const ReadProgressFunction& progress) const = 0;
  [[nodiscard]] virtual LoadedTransferFunction function(const Dataset& data) const = 0;
  /// Called once for equal keys, as it may read surfaces from the data's files. Throws Error.
  [[nodiscard]] virtual Settings settings(const Dataset& data, const LoadedTransferFunction& function) const = 0;
  [[nodiscard]] virtual View view(const Dataset& data) const = 0;
  /// How the image is written to a file.
  [[nodiscard]] virtual ImageFileOptions image_options() const = 0;
  /// Whether explain() draws anything.
  [[nodiscard]] virtual bool explains() const = 0;
  /// Draws the annotation of the state over the image: colour bar, axes. Throws Error.
  virtual void explain(Image& image, const View& view, const Dataset& data, const TransferFunction& function) const = 0;
};

/// Reads states: JSON objects whose keys are long options of `tessera render` (docs/SERVER.md). Used by one thread at a
/// time.
class SceneReader {
 public:
  virtual ~SceneReader() = default;
  SceneReader() = default;
  SceneReader(const SceneReader&) = delete;
  SceneReader& operator=(const SceneReader&) = delete;

  /// Throws Error(bad_input) for an unknown key, a value of the wrong type, or words that `render` refuses.
  virtual std::shared_ptr<const Scene> scene(const Json& state) = 0;
  /// A library's message with the names of options.
  [[nodiscard]] virtual std::string worded(const std::string& message) const = 0;
  /// The command line that renders a state's image. Throws as scene().
  virtual std::string command(const Json& state) = 0;
  /// The options with which the server was started, as a state. May be called from any thread.
  [[nodiscard]] virtual Json base() const = 0;
  /// Whether the server was started with an option, which then applies to states without it.
  [[nodiscard]] virtual bool fixes(const std::string& option) const = 0;
  /// The name of the served file, for display.
  [[nodiscard]] virtual std::string input_name() const = 0;
  /// Times of the steps, if there are several with times.
  [[nodiscard]] virtual std::vector<double> times() const = 0;
  /// The same state with the exact integrator.
  [[nodiscard]] virtual Json exact(const Json& state) const = 0;
};

}  // namespace tessera::server
