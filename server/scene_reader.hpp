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

/// The image described by a state. Immutable. The data that are passed to member functions are those that this scene
/// opened, or equal data.
///
/// Keys   Equal keys mean equal values, so that a data set, a transfer function or a session is made only once for all
///        states that differ in other respects.
class Scene {
 public:
  virtual ~Scene() = default;
  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Keys of the data. Data stored under any of these keys are suitable.
  [[nodiscard]] virtual const std::vector<std::string>& data_keys() const = 0;
  /// Keys of scenes that would open the same data as `data`, which this scene opened. The scene's own key is first.
  [[nodiscard]] virtual std::vector<std::string> keys_of(const Dataset& data) const = 0;
  /// Key of the scene's transfer function for given data.
  [[nodiscard]] virtual const std::string& look_key() const = 0;
  /// Key of the scene's settings, without the effect of the transfer function on them.
  [[nodiscard]] virtual const std::string& settings_key() const = 0;

  /// The field in the form of `--field`.
  [[nodiscard]] virtual std::string field_word(const Dataset& data) const = 0;

  /// Reads the data on all ranks. Throws Error.
  [[nodiscard]] virtual Dataset open(const Communicator& communicator, const ReadProgressFunction& progress) const = 0;
  [[nodiscard]] virtual LoadedTransferFunction function(const Dataset& data) const = 0;
  /// Returns the settings. Called only once for equal keys, because the function may read surfaces from the data's
  /// files. Throws Error.
  [[nodiscard]] virtual Settings settings(const Dataset& data, const LoadedTransferFunction& function) const = 0;
  [[nodiscard]] virtual View view(const Dataset& data) const = 0;
  /// Options for writing the image to a file.
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

  /// Reads a state. Throws Error(bad_input) for an unknown key, a value of the wrong type, and words for which `render`
  /// reports an error.
  virtual std::shared_ptr<const Scene> scene(const Json& state) = 0;
  /// Returns a library's message with the names of options instead of settings.
  [[nodiscard]] virtual std::string worded(const std::string& message) const = 0;
  /// Returns the command line that renders a state's image. Throws the same errors as scene().
  virtual std::string command(const Json& state) = 0;
  /// The options with which the server was started, as a state. May be called from any thread.
  [[nodiscard]] virtual Json base() const = 0;
  /// Whether the server was started with this option, which then applies to states that do not have it.
  [[nodiscard]] virtual bool fixes(const std::string& option) const = 0;
  /// The name of the served file, for display.
  [[nodiscard]] virtual std::string input_name() const = 0;
  /// The times of the steps, if there are several steps with times.
  [[nodiscard]] virtual std::vector<double> times() const = 0;
  /// Returns the state with the exact integrator.
  [[nodiscard]] virtual Json exact(const Json& state) const = 0;
};

}  // namespace tessera::server
