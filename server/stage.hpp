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

/// A data set that is at hand, and what was made of it.
struct HeldData {
  explicit HeldData(Dataset data_) : data(std::move(data_)) {}
  Dataset data;
  std::uint64_t bytes = 0;                                  ///< about, in memory
  std::map<std::string, LoadedTransferFunction> functions;  ///< by Scene::look_key(), a few
  std::optional<Dataset> stand_in;                          ///< tessera/coarse_stand_in.hpp
  bool stand_in_tried = false;
  std::unique_ptr<Session> stand_in_session;
  std::string stand_in_key;
};

/// Frames of one scene, for work that takes long.
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

/// How far the reading of data is.
struct Reading {
  std::string stage;  ///< "reading wake.vtu"
  std::optional<double> fraction;
};

/// Data sets and sessions of a server, made when they are asked for and kept for the next time: the last few, within a
/// budget of memory. Used by the one thread that renders; reads on a thread of its own, where the process is alone.
///
/// On several ranks rank 0 calls it and the others follow(): every step that needs all of them is told to them first.
class Stage {
 public:
  /// `came`: reading has ended, well or not; from any thread.
  Stage(SceneReader& reader, Job& job, std::uint64_t memory_bytes, std::function<void()> came,
        std::function<void(const Reading&)> progress);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// The scene's data. Null: it is being read, or other data is; to be asked for again once that has come. Throws what
  /// its reading threw.
  std::shared_ptr<HeldData> data(const Json& state, const std::shared_ptr<const Scene>& scene);
  const LoadedTransferFunction& function(HeldData& held, const Scene& scene);

  /// A picture of the scene, in a size that may be another than the scene's. Collective.
  RenderedFrame render(const Json& state, const Scene& scene, HeldData& held, const View& view,
                       const FrameSettings& settings, Sink* sink, const std::stop_token& stop);
  /// Frames that a process alone renders by a session of their own, on whichever thread asks for them, while the stage
  /// does other work; on several ranks they are the stage's and of its thread. Throws Error(bad_input) for a size that
  /// takes too much memory.
  std::unique_ptr<SceneFrames> frames(const Json& state, const std::shared_ptr<const Scene>& scene,
                                      const std::shared_ptr<HeldData>& held, ImageSize size);
  /// Of that picture, how long each stage took: its share of the frame's time. Of several ranks of this one.
  std::map<std::string, double> stage_times(double frame_ms);
  /// Whether there is a stand-in for the scene's data; making one begins with the first question. On several ranks all
  /// make it before that is answered.
  bool has_stand_in(const Json& state, const std::shared_ptr<HeldData>& held);
  /// The picture of the stand-in, without surfaces of meshes, by this process alone.
  RenderedFrame render_stand_in(const Scene& scene, HeldData& held, const View& view, Sink* sink,
                                const std::stop_token& stop);
  /// The session of the scene's last picture.
  Session& session(const Json& state, const Scene& scene, HeldData& held);

  /// As tessera::probe(), by all ranks.
  RayProbe probe(const Json& state, const Scene& scene, HeldData& held, const View& view, PixelIndex pixel,
                 std::size_t samples);

  /// What is being read.
  [[nodiscard]] std::optional<Reading> reading();

  [[nodiscard]] int ranks() const { return job_.size(); }
  /// Tells the other ranks that this was all. They return from follow().
  void end();
  /// The part of all ranks but the first. Returns at the end.
  void follow();

 private:
  struct Entry {
    std::vector<std::string> keys;  ///< the first one is the scene's that opened it
    std::shared_ptr<HeldData> held;
  };
  struct KeptSession {
    std::string key;
    std::unique_ptr<Trace> trace;  // outlives the session
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
  void make_stand_in_together(const Json& state, HeldData& held);
  /// Throws Error(bad_input) for what takes too much memory.
  void check_size(ImageSize size) const;
  Dataset open_together(const Scene& scene);
  void read_together(const Json& state, const Scene& scene);
  /// Returns when all ranks have come here.
  void hear_all();
  void tell(const Json& order);
  void obey(const Json& order);

  SceneReader& reader_;
  Job& job_;
  const std::uint64_t memory_bytes_;
  std::function<void()> came_;
  std::function<void(const Reading&)> progress_;
  std::list<Entry> entries_;         ///< the last used one first
  std::list<KeptSession> sessions_;  ///< likewise

  std::mutex mutex_;  ///< of what follows
  std::thread reading_thread_;
  std::optional<Reading> reading_;
  struct Arrived {
    std::shared_ptr<const Scene> scene;
    std::optional<Dataset> data;
    std::optional<Error> error;
  };
  std::optional<Arrived> arrived_;
  const HeldData* making_ = nullptr;  ///< whose stand-in is being made
  std::optional<Made> made_;
  std::thread making_thread_;
  std::stop_source stop_making_;
  std::map<std::string, Error> failed_;  ///< of data that could not be read, until it has been said
};

}  // namespace tessera::server
