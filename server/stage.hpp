// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "server/scene_reader.hpp"
#include "tessera/error.hpp"
#include "tessera/field_queries.hpp"
#include "tessera/job.hpp"
#include "tessera/session.hpp"
#include "tessera/trace.hpp"

namespace tessera::server {

/// An open data set, and the objects that were made from it.
struct HeldData {
  explicit HeldData(Dataset data_) : data(std::move(data_)) {}
  Dataset data;
  std::uint64_t bytes = 0;                                  ///< approximate size in memory
  std::map<std::string, LoadedTransferFunction> functions;  ///< a few functions, by Scene::look_key()
  std::optional<Dataset> preview;                           ///< tessera/coarse_preview.hpp
  bool preview_tried = false;
  std::unique_ptr<Session> preview_session;
  std::string preview_key;
};

/// Renders frames of one scene for long work.
class SceneFrames {
 public:
  explicit SceneFrames(LoadedTransferFunction function) : function_(std::move(function)) {}
  virtual ~SceneFrames() = default;
  SceneFrames(const SceneFrames&) = delete;
  SceneFrames& operator=(const SceneFrames&) = delete;

  virtual RenderedFrame render(const View& view, const FrameSettings& settings, Sink* sink,
                               const std::stop_token& stop) = 0;
  /// The session of the last frame.
  virtual Session& session() = 0;
  [[nodiscard]] const LoadedTransferFunction& function() const { return function_; }

 private:
  LoadedTransferFunction function_;
};

/// Progress of reading data.
struct Reading {
  std::string stage;  ///< "reading wake.vtu"
  std::optional<double> fraction;
};

/// Data sets and sessions of a server. They are made on demand, and the last few are kept within a memory budget. Only
/// the rendering thread uses this object. A single process reads data on a separate thread.
///
/// On several ranks, rank 0 calls the functions, and the others run follow(). Rank 0 first broadcasts every step that
/// requires all ranks.
class Stage {
 public:
  /// `came` is called, from any thread, when reading has ended, successfully or not.
  Stage(SceneReader& reader, Job& job, std::uint64_t memory_bytes, std::function<void()> came,
        std::function<void(const Reading&)> progress);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Returns the scene's data. Returns null while these or other data are being read; the caller must call again when
  /// reading has ended. Throws the error with which the data could not be read.
  std::shared_ptr<HeldData> data(const Json& state, const std::shared_ptr<const Scene>& scene);
  const LoadedTransferFunction& function(HeldData& held, const Scene& scene);

  /// Renders an image of the scene, possibly in another size than the scene's. Collective.
  RenderedFrame render(const Json& state, const Scene& scene, HeldData& held, const View& view,
                       const FrameSettings& settings, Sink* sink, const std::stop_token& stop);
  /// Makes an object that renders frames for long work. A single process renders them in a separate session, on the
  /// calling thread, in parallel with the stage. On several ranks, the stage renders them on its thread. Throws
  /// Error(bad_input) for a size that needs too much memory.
  std::unique_ptr<SceneFrames> frames(const Json& state, const std::shared_ptr<const Scene>& scene,
                                      const std::shared_ptr<HeldData>& held, ImageSize size);
  /// The times of the last frame's stages, as shares of the frame's time. On several ranks, the shares are those of
  /// this rank.
  std::map<std::string, double> stage_times(double frame_ms);
  /// Whether there is a preview (tessera/coarse_preview.hpp) of the scene's data. The first call starts to make the
  /// preview. On several ranks, all ranks make it before the call returns.
  bool has_preview(const Json& state, const std::shared_ptr<HeldData>& held);
  /// Renders an image of the preview, without surfaces of meshes, on this process alone.
  RenderedFrame render_preview(const Scene& scene, HeldData& held, const View& view, Sink* sink,
                               const std::stop_token& stop);
  /// The session of the scene's last image.
  Session& session(const Json& state, const Scene& scene, HeldData& held);

  /// Calls tessera::probe() on all ranks.
  RayProbe probe(const Json& state, const Scene& scene, HeldData& held, const View& view, PixelIndex pixel,
                 std::size_t samples);

  /// The progress of reading, if data are being read.
  [[nodiscard]] std::optional<Reading> reading();

  [[nodiscard]] int ranks() const { return job_.size(); }
  /// Ends follow() on the other ranks.
  void end();
  /// Runs on all ranks except the first. Returns after end().
  void follow();

 private:
  struct Entry {
    std::vector<std::string> keys;  ///< keys of the data; the first is that of the scene that opened them
    std::shared_ptr<HeldData> held;
  };
  struct KeptSession {
    std::string key;
    std::unique_ptr<Trace> trace;  // must outlive the session
    std::unique_ptr<Session> session;
  };
  struct Made {
    std::shared_ptr<HeldData> held;
    std::optional<Dataset> data;
  };

  std::shared_ptr<HeldData> find(const Scene& scene);
  void keep(const Scene& scene, Dataset data);
  void drop(const std::string& key);
  [[nodiscard]] Settings session_settings(const Scene& scene, HeldData& held);
  void read_in_background(std::shared_ptr<const Scene> scene);
  void make_preview_together(const Json& state, HeldData& held);
  /// Throws Error(bad_input) for a size that needs too much memory.
  void check_size(ImageSize size) const;
  Dataset open_together(const Scene& scene);
  void read_together(const Json& state, const Scene& scene);
  /// Returns when all ranks have called it.
  void synchronize_ranks();
  void send_order(const Json& order);
  void execute(const Json& order);

  SceneReader& reader_;
  Job& job_;
  const std::uint64_t memory_bytes_;
  std::function<void()> came_;
  std::function<void(const Reading&)> progress_;
  std::list<Entry> entries_;         ///< most recently used first
  std::list<KeptSession> sessions_;  ///< most recently used first

  std::mutex mutex_;  ///< guards the members below
  std::thread reading_thread_;
  std::optional<Reading> reading_;
  struct Arrived {
    std::shared_ptr<const Scene> scene;
    std::optional<Dataset> data;
    std::optional<Error> error;
  };
  std::optional<Arrived> arrived_;
  const HeldData* making_ = nullptr;  ///< the data whose preview is being made
  std::optional<Made> made_;
  std::thread making_thread_;
  std::stop_source stop_making_;
  std::map<std::string, Error> failed_;  ///< errors of data that could not be read, kept until they are reported
};

}  // namespace tessera::server
