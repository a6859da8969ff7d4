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

/// What the server is handed by whoever knows the options of `tessera render`: states of clients as values.
namespace tessera::server {

using Json = nlohmann::json;

/// A picture that a state asks for. Immutable; what it says of data is of the data that it opened, or of the like.
///
/// Keys   of equal keys follow equal values, so that a data set, a transfer function and a session are made once for
///        all states that differ in other things.
class Scene {
 public:
  virtual ~Scene() = default;
  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Of what is read: data that was kept under one of them will do.
  [[nodiscard]] virtual const std::vector<std::string>& data_keys() const = 0;
  /// The keys under which `data`, which this opened, is what other scenes would open; this one's first.
  [[nodiscard]] virtual std::vector<std::string> keys_of(const Dataset& data) const = 0;
  /// Of its transfer function, given the data.
  [[nodiscard]] virtual const std::string& look_key() const = 0;
  /// Of its settings, but for what the function does to them.
  [[nodiscard]] virtual const std::string& settings_key() const = 0;

  /// The field as `--field` takes it.
  [[nodiscard]] virtual std::string field_word(const Dataset& data) const = 0;

  /// Reads it, by all ranks. Throws Error.
  [[nodiscard]] virtual Dataset open(const Communicator& communicator, const ReadProgressFunction& progress) const = 0;
  [[nodiscard]] virtual LoadedTransferFunction function(const Dataset& data) const = 0;
  /// Read once for equal keys, for it may read surfaces of the data's files. Throws Error.
  [[nodiscard]] virtual Settings settings(const Dataset& data, const LoadedTransferFunction& function) const = 0;
  [[nodiscard]] virtual View view(const Dataset& data) const = 0;
  /// How the picture becomes a file.
  [[nodiscard]] virtual ImageFileOptions image_options() const = 0;
  /// Whether explain() draws anything.
  [[nodiscard]] virtual bool explains() const = 0;
  /// Draws what the state asks for over the picture: colour bar, axes. Throws Error.
  virtual void explain(Image& image, const View& view, const Dataset& data, const TransferFunction& function) const = 0;
};

/// Reads states: JSON objects whose keys are long options of `tessera render` (docs/SERVER.md). On one thread at a
/// time.
class SceneReader {
 public:
  virtual ~SceneReader() = default;
  SceneReader() = default;
  SceneReader(const SceneReader&) = delete;
  SceneReader& operator=(const SceneReader&) = delete;

  /// Throws Error(bad_input) for a key that is none, a value of another kind, words that `render` refuses.
  virtual std::shared_ptr<const Scene> scene(const Json& state) = 0;
  /// A library's message in the words of options.
  [[nodiscard]] virtual std::string worded(const std::string& message) const = 0;
  /// The command line that makes a state's picture. Throws as scene().
  virtual std::string command(const Json& state) = 0;
  /// What the server was started with, as a state. From any thread.
  [[nodiscard]] virtual Json base() const = 0;
  /// Whether a state that says nothing of an option has it all the same, from there.
  [[nodiscard]] virtual bool fixes(const std::string& option) const = 0;
  /// What is served, for people: a file's name.
  [[nodiscard]] virtual std::string input_name() const = 0;
  /// Times of the steps, if there are several and they have times.
  [[nodiscard]] virtual std::vector<double> times() const = 0;
  /// The state whose picture differs by the integrator alone.
  [[nodiscard]] virtual Json exact(const Json& state) const = 0;
};

}  // namespace tessera::server
