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

/// Conversion of option words to values, shared by `tessera render` and `serve`. Functions throw Error(bad_input)
/// naming the option, its value and the allowed values; also for options that would have no effect together.
namespace tessera {
inline namespace v0_1 {

/// `--surface NAME[:COLOUR[:OPACITY]]` for a block of the input. Which part is the name is only known once the input is
/// read.
struct BlockSurfaceWord {
  std::string word;
  std::string name;  ///< before that, the text before the first colon, or all of it if no colour follows
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};

struct AnnotationOptions {
  /// None: nothing to draw. Texts and title still contain words in braces.
  std::optional<Annotation> annotation{};
  std::filesystem::path layer{};  ///< file for the annotation alone; empty: drawn over the image
};

/// The arguments of `tessera render`, checked and converted to values.
struct RenderOptions {
  OptionWords words;  ///< the words that the other members are made from
  FilmPlan plan;
  std::optional<InputFile> first;  ///< the input or, for a list of files, the first one, as identified
  ReadOptions read;
  Settings settings;
  FrameSettings frame;
  bool show_balance = false;

  std::string transfer_function;  ///< file or preset; empty: the default function
  TransferFunctionOptions function;
  ViewRequest view;
  ProjectionKind projection = ProjectionKind::orthographic;  ///< of the view that frames the data
  ImageFileOptions image;
  AnnotationOptions annotation;

  std::vector<BlockSurfaceWord> block_surfaces;  ///< added to settings.surfaces once the input is read

  bool no_shade = false;                        ///< not even if the default transfer function intends it
  std::optional<double> higher_order_accuracy;  ///< for read_for_accuracy(); none: `read` has the tolerance

  int repeat = 0;  ///< 0: render once and print no times
  int verify = 0;  ///< pixels per frame to check against the reference; 0: none
  std::filesystem::path report, timing, saved_scene;
  std::string scene;                         ///< text of saved_scene
  std::vector<std::filesystem::path> films;  ///< of all frames, in addition to the plan's images
  double frame_rate = 25;                    ///< of films
  bool to_standard_output = false;           ///< every image as .png
  bool report_to_standard_output = false;
  bool progress = false;
  bool quiet = false;

  /// The run's input: a mesh, a grid, or the name of a time series; the first one of several.
  [[nodiscard]] const std::filesystem::path& input() const { return plan.inputs.front(); }
  [[nodiscard]] bool is_grid() const { return plan.grids; }

  /// Dataset::open, without identifying `first` again.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& how,
                             const Communicator& communicator = {}) const;
};

/// `-` as a file's name: standard input for reading, standard output for writing.
inline constexpr std::string_view standard_stream = "-";

/// The input or, for a list of files, the first one.
InputFile first_input(const OptionWords& words);
/// Whether volumes are rendered if `first` is the first input.
bool draws_grids(const OptionWords& words, const InputFile& first);
/// Whether an input is a volume: by its contents, or because options describe it as .raw.
bool is_grid_input(const OptionWords& words, const InputFile& input);

/// How to read the input, as a mesh or as a grid.
ReadOptions read_options(const OptionWords& words, bool is_grid);

/// For commands that take only one time step: throws if options of a film are given.
void refuse_time_steps(const OptionWords& words);

RenderOptions render_options(const OptionWords& words);
/// The same if it is already known whether the input is a grid; otherwise the input is opened to find out.
RenderOptions render_options(const OptionWords& words, bool is_grid);

/// The transfer function that the options name, or the default one; messages use the program's option names.
LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options);

/// Whether an image is shaded because the default transfer function intends it and no option excludes it.
bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options);

/// Values that replace the words in braces in an annotation's texts.
struct AnnotationValues {
  std::string field, time, file, frame, min, max;
};
AnnotationValues annotation_values(const Dataset& data, double time, const std::string& file, int frame);
/// Throws as fill_in().
Annotation filled_annotation(const Annotation& annotation, const AnnotationValues& values);

/// Opens the data as `open` reads them; a mesh with higher-order cells is divided as finely as the options' accuracy
/// requires (read_for_accuracy()).
Dataset open_for_accuracy(const RenderOptions& options, const ReadOptions& read,
                          const std::function<Dataset(const ReadOptions&)>& open,
                          const std::function<TransferFunction(const Dataset&)>& function,
                          const std::function<View(const Dataset&)>& view, const Communicator& communicator);

/// Splits the words into names of blocks of the data and their look: the longest existing name, which may contain
/// colons, followed by colour and opacity. Throws Error(bad_input) for an invalid look.
std::vector<BlockSurfaceWord> found_blocks(std::span<const BlockSurfaceWord> words, const Dataset& data);

/// `surfaces`, scaled like the data's axes, with those of blocks of its files, coloured by its field if they have it.
/// `read` is how the data were read. Throws Error(bad_input) for a block that does not exist.
Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read);

/// `render --like FILE`: takes views, size, field and transfer function from another run's report (--report), unless
/// options give them, so that two images can be compared: the same value has the same colour and the same extinction in
/// both, whatever data they show. Throws Error(bad_input) unless the file is a report of a run that rendered a frame.
void apply_like(OptionWords& words);

/// `render --preset NAME`: all options of a published method that are not given.
///
/// juliachs-2007  Juliachs, Carrard, Nomine 2007 as printed: scanline rasterization of 4-tuples (4.1, 4.2), raw
///                segments sent to compositing processes (3), four samples per segment and fragment shaders that sort
///                and blend with 16 bits (4.3), 16 x 16 tiles of 64 pixels per side for a 1024 x 1024 image. With
///                several processes, half of them project, each its own part, and the others composite. OpenGL is
///                Mesa's software unless --backend names another.
void apply_method_preset(int ranks, OptionWords& words);

}  // namespace v0_1
}  // namespace tessera
