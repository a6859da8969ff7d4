// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "apps/options/series_choice.hpp"
#include "apps/render/empty_picture.hpp"
#include "apps/render/run_output.hpp"
#include "tessera/job.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/render_options.hpp"
#include "tessera/session.hpp"
#include "tessera/trace.hpp"

namespace tessera::apps {

/// The open time step of a run (one at a time), and the properties of the first step that are used for all steps: view,
/// field, transfer function, tolerance of higher-order cells. Every rank has this object; show() is collective.
class ShownStep {
 public:
  /// The times that the files state are written to `frames`. `options` are completed when data are read, with surfaces
  /// of blocks and default shading. `writing_rank` writes the files. The referenced objects must outlive this object.
  ShownStep(RenderOptions& options, std::vector<FilmFrame>& frames, RunOutput& output, Job& job, int writing_rank,
            Trace* trace);

  /// Opens and prepares the frame's step unless it is already open. Throws Error, also if an output is one of the files
  /// that were read.
  void show(const FilmFrame& frame);
  /// Whether show() has been called, which the functions below require.
  [[nodiscard]] bool is_open() const { return first_.has_value(); }

  [[nodiscard]] Camera camera(const FilmFrame& frame) const {
    return frame.view(first_->box, options_.projection, options_.view, first_->axes);
  }
  [[nodiscard]] const Dataset& data() const { return *data_; }
  [[nodiscard]] const TransferFunction& function() const { return loaded_.function; }
  [[nodiscard]] Session& session() { return *session_; }
  /// Number of tets of the first step; 0 for grids.
  [[nodiscard]] std::uint64_t tets() const { return first_ ? first_->tets : 0; }
  /// Ends the session and thereby its spans in the trace.
  void close_session() { session_.reset(); }

  /// Prints the warnings that need the whole run: values outside the range for which the transfer function was chosen,
  /// and the empty images collected in `empty`. Collective.
  void warn_at_end(const EmptyPictures& empty) const;

 private:
  /// Properties of the first step that all later steps use.
  struct First {
    Box box;
    BodyAxes axes;
    bool shows_shape;
    std::uint64_t tets;
    ReadOptions later_read;
  };
  using Range = std::array<double, 2>;

  void open(const FilmFrame& frame, const ReadOptions& read);
  void open_first();
  void read_block_surfaces(const std::vector<std::filesystem::path>& files, ReadOptions read);
  void choose_for_all_steps();
  void read_within_accuracy();
  void find_function();
  void shade_by_default();
  void note_method();
  void check_outputs_are_not_read() const;
  [[nodiscard]] analysis::Description description() const;
  [[nodiscard]] std::size_t steps() const { return frames_.back().step + 1; }

  RenderOptions& options_;
  std::vector<FilmFrame>& frames_;
  RunOutput& output_;
  Job& job_;
  const int writing_rank_;
  Settings settings_;
  ReadOptions read_;

  std::optional<Dataset> data_;
  std::size_t step_ = 0;  ///< number of the step in data_
  std::optional<Session> session_;
  LoadedTransferFunction loaded_;
  std::optional<SeriesChoice> series_;  ///< chosen field and colours for several steps
  std::optional<First> first_;          ///< none until a step has been shown
  std::optional<Range> colored_range_;  ///< range of the values for which the transfer function was chosen
  Range whole_range_{};                 ///< range of the values of all steps that were read
  double higher_order_pixels_ = 0;      ///< HigherOrderRead::pixel_error of the first step
};

}  // namespace tessera::apps
