// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/annotation.hpp"
#include "tessera/camera.hpp"
#include "tessera/dataset.hpp"
#include "tessera/default_view.hpp"
#include "tessera/image_file.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/options.hpp"
#include "tessera/settings.hpp"
#include "tessera/surfaces.hpp"

/// Words of options to values: one place for `tessera render` and `serve`. Functions throw Error(bad_input) naming the
/// option, what it was given and what it takes; also for options that would have no effect together.
namespace tessera {
inline namespace v0_1 {

/// `--surface NAME[:COLOUR[:OPACITY]]` of a block of the input. Which of it is the name is known once that is read.
struct BlockSurfaceWord {
  std::string word;
  std::string name;  ///< until then what stands before the first colon, or all if no colour follows
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};

struct AnnotationOptions {
  /// Nothing to be drawn: none. Texts and title have words in braces still.
  std::optional<Annotation> annotation{};
  std::filesystem::path layer{};  ///< where the annotation goes alone; empty: over the picture
};

/// How `tessera render` was called, checked and in values.
struct RenderOptions {
  OptionWords words;  ///< that all of this is made of
  FilmPlan plan;
  std::optional<InputFile> first;  ///< the input or, of a list of files, its first one, as it was identified
  ReadOptions read;
  Settings settings;
  FrameSettings frame;
  bool show_balance = false;

  std::string transfer_function;  ///< file or preset; empty: the default one
  TransferFunctionOptions function;
  ViewRequest view;
  ProjectionKind projection = ProjectionKind::orthographic;  ///< of the view that frames the data
  ImageFileOptions image;
  AnnotationOptions annotation;

  std::vector<BlockSurfaceWord> block_surfaces;  ///< beside settings.surfaces, which has them once the input is read

  bool no_shade = false;                        ///< not even where the default transfer function asks for it
  std::optional<double> higher_order_accuracy;  ///< of read_for_accuracy(); none: `read` has the tolerance

  int repeat = 0;  ///< 0: render once and print no times
  int verify = 0;  ///< pixels a frame to check against the reference; 0: none
  std::filesystem::path report, timing, saved_scene;
  std::string scene;                         ///< text of saved_scene
  std::vector<std::filesystem::path> films;  ///< of all frames, beside the plan's pictures
  double frame_rate = 25;                    ///< of films
  bool to_standard_output = false;           ///< every picture as .png
  bool report_to_standard_output = false;
  bool progress = false;
  bool quiet = false;

  /// The run's input: a mesh, a grid, or what names a time series; of several the first.
  [[nodiscard]] const std::filesystem::path& input() const { return plan.inputs.front(); }
  [[nodiscard]] bool is_grid() const { return plan.grids; }

  /// Dataset::open, which does not identify `first` again.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& how,
                             const Communicator& communicator = {}) const;
};

/// `-` as a file's name: standard input where it is read, standard output where it is written.
inline constexpr std::string_view standard_stream = "-";

/// The input or, of a list of files, its first one.
InputFile first_input(const OptionWords& words);
/// Whether volumes are drawn, if that is the first input.
bool draws_grids(const OptionWords& words, const InputFile& first);
/// Whether an input is a volume: by its content, or because options describe it as .raw.
bool is_grid_input(const OptionWords& words, const InputFile& input);

/// How the input is read, as a mesh or as a grid.
ReadOptions read_options(const OptionWords& words, bool is_grid);

/// Of commands that take but one time step: throws for the words of a film.
void refuse_time_steps(const OptionWords& words);

RenderOptions render_options(const OptionWords& words);
/// The same where it is known already whether the input is a grid, which else is looked into.
RenderOptions render_options(const OptionWords& words, bool is_grid);

/// The transfer function that the options name, or the default one, its words as the program says them.
LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options);

/// Whether a picture is shaded because the default transfer function means it to be, and no option speaks against it.
bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options);

/// What stands for the words in braces of an annotation's texts.
struct AnnotationValues {
  std::string field, time, file, frame, min, max;
};
AnnotationValues annotation_values(const Dataset& data, double time, const std::string& file, int frame);
/// Throws as fill_in().
Annotation filled_annotation(const Annotation& annotation, const AnnotationValues& values);

/// The data as `open` reads them with options; a mesh with higher-order cells as finely as the options' accuracy needs
/// (read_for_accuracy()).
Dataset open_for_accuracy(const RenderOptions& options, const ReadOptions& read,
                          const std::function<Dataset(const ReadOptions&)>& open,
                          const std::function<TransferFunction(const Dataset&)>& function,
                          const std::function<View(const Dataset&)>& view, const Communicator& communicator);

/// The blocks that words name in what was read: the longest name that there is, which may hold colons, and a look
/// behind it. Throws Error(bad_input) for what is no look.
std::vector<BlockSurfaceWord> found_blocks(std::span<const BlockSurfaceWord> words, const Dataset& data);

/// `surfaces`, scaled as the data's axes are, with those of blocks of its files, coloured by its field where they have
/// it. `read` is how the data were read. Throws Error(bad_input) for a block that is not there.
Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read);

/// `render --like FILE`: the words that another run's report (--report) has for views, size, field and transfer
/// function, where none are given, so that two pictures can be compared: the same value has the same colour and the
/// same extinction in both, whatever data they show. Throws Error(bad_input) unless the file is a report of a run that
/// rendered a frame.
void apply_like(OptionWords& words);

/// `render --preset NAME`: a published method as a whole, option by option, where none is given.
///
/// juliachs-2007  Juliachs, Carrard, Nomine 2007 as printed: scanline rasterization of 4-tuples (4.1, 4.2), raw
///                segments sent to compositing processes (3), four samples a segment and fragment shaders that sort and
///                blend with 16 bits (4.3), 16 x 16 tiles, 64 pixels a side of a 1024 x 1024 picture; half of several
///                processes project, each its own part, the others composite. OpenGL is Mesa's software unless
///                --backend names another.
void apply_method_preset(int ranks, OptionWords& words);

}  // namespace v0_1
}  // namespace tessera
