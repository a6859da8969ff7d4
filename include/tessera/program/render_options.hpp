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

/// Conversion of option words to values, for `tessera render` and `serve`. The functions throw Error(bad_input), which
/// states the option, its value and the allowed values. They also throw it for options that would have no effect in
/// combination.
namespace tessera {
inline namespace v0_1 {

/// An option `--surface NAME[:COLOUR[:OPACITY]]` for a block of the input. Where the name ends is only known after the
/// input is read, because names may contain colons.
struct BlockSurfaceWord {
  std::string word;
  std::string name;  ///< until the input is read: the text before the first colon, or the whole word if no colour
                     ///< follows
  std::optional<glm::dvec3> color{};
  double opacity = 1;
};

struct AnnotationOptions {
  /// The annotation, whose texts and title still contain words in braces. None: there is nothing to draw.
  std::optional<Annotation> annotation{};
  std::filesystem::path layer{};  ///< file for the annotation alone; empty: drawn over the image
};

/// The arguments of `tessera render`, checked and converted to values.
struct RenderOptions {
  OptionWords words;  ///< the words from which the other members are made
  FilmPlan plan;
  std::optional<InputFile> first;  ///< the identified input or, for a list of files, the first of them
  ReadOptions read;
  Settings settings;
  FrameSettings frame;
  bool show_balance = false;

  std::string transfer_function;  ///< file or preset; empty: the default function
  TransferFunctionOptions function;
  ViewRequest view;
  ProjectionKind projection = ProjectionKind::orthographic;  ///< projection of the view that frames the data
  ImageFileOptions image;
  AnnotationOptions annotation;

  std::vector<BlockSurfaceWord> block_surfaces;  ///< added to settings.surfaces after the input is read

  bool no_shade = false;                        ///< no shading, even if the default transfer function intends it
  std::optional<double> higher_order_accuracy;  ///< accuracy for read_for_accuracy(); none: `read` contains the
                                                ///< tolerance

  int repeat = 0;  ///< 0: render once and print no times
  int verify = 0;  ///< pixels per frame to check against the reference; 0: none
  std::filesystem::path report, timing, saved_scene;
  std::string scene;                         ///< text of saved_scene
  std::vector<std::filesystem::path> films;  ///< films of all frames, in addition to the plan's images
  double frame_rate = 25;                    ///< of films
  bool to_standard_output = false;           ///< write every image to standard output as .png
  bool report_to_standard_output = false;
  bool progress = false;
  bool quiet = false;

  /// The run's input, or the first of several inputs: a mesh, a grid, or the name of a time series.
  [[nodiscard]] const std::filesystem::path& input() const { return plan.inputs.front(); }
  [[nodiscard]] bool is_grid() const { return plan.grids; }

  /// Calls Dataset::open() without identifying `first` again.
  [[nodiscard]] Dataset open(std::span<const std::filesystem::path> files, const ReadOptions& how,
                             const Communicator& communicator = {}) const;
};

/// The file name `-`, which denotes standard input for reading and standard output for writing.
inline constexpr std::string_view standard_stream = "-";

/// Identifies the input or, for a list of files, the first of them.
InputFile first_input(const OptionWords& words);
/// Whether the options render volumes; `first` is the first input.
bool draws_grids(const OptionWords& words, const InputFile& first);
/// Whether an input is a volume, either by its contents or because options describe it as .raw.
bool is_grid_input(const OptionWords& words, const InputFile& input);

/// The options for reading the input, as a mesh or as a grid.
ReadOptions read_options(const OptionWords& words, bool is_grid);

/// For commands that take only one time step: throws if options of a film are given.
void refuse_time_steps(const OptionWords& words);

RenderOptions render_options(const OptionWords& words);
/// For callers that know whether the input is a grid; the other overload opens the input to find out.
RenderOptions render_options(const OptionWords& words, bool is_grid);

/// The transfer function that the options specify, or the default function. Messages contain the names of the program's
/// options.
LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options);

/// Whether an image is shaded because the default transfer function intends it and no option excludes it.
bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options);

/// Values that replace the words in braces in an annotation's texts.
struct AnnotationValues {
  std::string field, time, file, frame, min, max;
};
AnnotationValues annotation_values(const Dataset& data, double time, const std::string& file, int frame);
/// Returns the annotation with the words in its texts replaced. Throws the same errors as fill_in().
Annotation filled_annotation(const Annotation& annotation, const AnnotationValues& values);

/// Opens the data with the function `open`. Higher-order cells of a mesh are divided as finely as the accuracy of the
/// options requires (read_for_accuracy()).
Dataset open_for_accuracy(const RenderOptions& options, const ReadOptions& read,
                          const std::function<Dataset(const ReadOptions&)>& open,
                          const std::function<TransferFunction(const Dataset&)>& function,
                          const std::function<View(const Dataset&)>& view, const Communicator& communicator);

/// Splits each word into the name of a block of the data, followed by colour and opacity. The name is the longest one
/// that exists; it may contain colons. Throws Error(bad_input) for an invalid colour or opacity.
std::vector<BlockSurfaceWord> found_blocks(std::span<const BlockSurfaceWord> words, const Dataset& data);

/// Returns `surfaces`, scaled like the axes of the data, together with the surfaces of the `blocks`, which are read
/// from `files`. Surfaces of blocks that have the field are coloured by it. `read` contains the options with which the
/// data were read. Throws Error(bad_input) for a block that does not exist.
Surfaces with_block_surfaces(Surfaces surfaces, std::span<const BlockSurfaceWord> blocks, const Dataset& data,
                             std::span<const std::filesystem::path> files, ReadOptions read);

/// Applies `render --like FILE`: takes views, size, field and transfer function from the report of another run
/// (--report), unless options specify them. Images of both runs can then be compared, because the same value has the
/// same colour and the same extinction in both. Throws Error(bad_input) unless the file is the report of a run that
/// rendered a frame.
void apply_like(OptionWords& words);

/// Applies `render --preset NAME`: sets the options of a published method that are not given.
///
/// juliachs-2007  The method of Juliachs, Carrard, Nomine 2007 as published: scanline rasterization of 4-tuples (4.1,
///                4.2), raw segments sent to compositing processes (3), four samples per segment and fragment shaders
///                that sort and blend with 16 bits (4.3), 16 x 16 tiles of 64 pixels per side for a 1024 x 1024 image.
///                With several processes, half of them project, each its own part, and the others composite. OpenGL is
///                Mesa's software renderer unless --backend specifies another.
void apply_method_preset(int ranks, OptionWords& words);

}  // namespace v0_1
}  // namespace tessera
