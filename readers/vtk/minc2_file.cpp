// SPDX-License-Identifier: BSD-3-Clause
// MINC 2, which is HDF5, by MINC's own library.
extern "C" {
#include <minc2.h>
}
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "readers/common/readers.hpp"
#include "readers/vtk/grid_numbers.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

struct Axis {
  std::string name;
  misize_t size = 0;
  double start = 0, step = 1;
  std::array<double, 3> cosines{};
};

/// An open volume. Every call that fails throws Error.
class Minc2Volume {
 public:
  explicit Minc2Volume(const std::filesystem::path& file) : source_(file.string()) {
    require(miopen_volume(file.c_str(), MI2_OPEN_READ, &volume_), "it");
  }
  ~Minc2Volume() {
    if (volume_ != nullptr) miclose_volume(volume_);
  }
  Minc2Volume(const Minc2Volume&) = delete;
  Minc2Volume& operator=(const Minc2Volume&) = delete;

  void require(int status, const char* what) const {
    if (status != MI_NOERROR)
      throw scene::bad_input(fmt::format(
          "{}: {} cannot be read as MINC 2; the file is truncated or damaged, write it again", source_, what));
  }

  /// Returns the axes, the slowest first: time, if it has steps, z, y and x, then components, if there are several.
  /// Later reads use this order, whatever the order in the file.
  [[nodiscard]] std::vector<Axis> ordered_axes() const {
    int count = 0;
    require(miget_volume_dimension_count(volume_, MI_DIMCLASS_ANY, MI_DIMATTR_ALL, &count), "its dimensions");
    if (count < 3 || count > most_axes)
      throw scene::bad_input(
          fmt::format("{}: it has {} dimensions; give a volume with three dimensions, not counting time and components",
                      source_, count));
    // Checked here, because the library dereferences a null pointer for a name that the file does not have.
    const std::vector<std::string> names = names_in_file(count);
    std::vector<std::string> wanted;
    for (const char* name : {"time", "zspace", "yspace", "xspace", "vector_dimension"})
      if (std::find(names.begin(), names.end(), name) != names.end()) wanted.emplace_back(name);
    std::vector<char*> pointers;
    for (std::string& name : wanted) pointers.push_back(name.data());
    if (std::count_if(wanted.begin(), wanted.end(), [](const std::string& n) { return n.ends_with("space"); }) != 3 ||
        wanted.size() != names.size() ||
        miset_apparent_dimension_order_by_name(volume_, count, pointers.data()) != MI_NOERROR)
      throw scene::bad_input(
          fmt::format("{}: its dimensions are {}, but only xspace, yspace, zspace, time and vector_dimension are "
                      "supported; give a volume in space",
                      source_, fmt::join(names, ", ")));
    std::array<midimhandle_t, most_axes> dimensions{};
    // The function returns the number of dimensions, or 0 like other successful calls.
    if (miget_volume_dimensions(volume_, MI_DIMCLASS_ANY, MI_DIMATTR_ALL, MI_DIMORDER_APPARENT, count,
                                dimensions.data()) < 0)
      require(MI_ERROR, "its dimensions");
    std::vector<Axis> axes;
    for (int k = 0; k < count; ++k) axes.push_back(axis_of(dimensions[static_cast<std::size_t>(k)]));
    return axes;
  }

  [[nodiscard]] mitype_t type() const {
    mitype_t type = MI_TYPE_DOUBLE;
    require(miget_data_type(volume_, &type), "its type");
    return type;
  }

  /// Reads real values of a part into memory of the caller.
  void read(mitype_t as, const std::vector<misize_t>& first, const std::vector<misize_t>& counts, void* out) const {
    require(miget_real_value_hyperslab(volume_, as, first.data(), counts.data(), out), "its samples");
  }

 private:
  static constexpr int most_axes = 5;

  [[nodiscard]] std::vector<std::string> names_in_file(int count) const {
    std::array<midimhandle_t, most_axes> dimensions{};
    if (miget_volume_dimensions(volume_, MI_DIMCLASS_ANY, MI_DIMATTR_ALL, MI_DIMORDER_FILE, count, dimensions.data()) <
        0)
      require(MI_ERROR, "its dimensions");
    std::vector<std::string> names;
    for (int k = 0; k < count; ++k) names.push_back(name_of(dimensions[static_cast<std::size_t>(k)]));
    return names;
  }

  [[nodiscard]] std::string name_of(midimhandle_t dimension) const {
    char* name = nullptr;
    require(miget_dimension_name(dimension, &name), "a dimension's name");
    const std::string text = name;
    mifree_name(name);
    return text;
  }

  [[nodiscard]] Axis axis_of(midimhandle_t dimension) const {
    Axis axis;
    axis.name = name_of(dimension);
    miboolean_t is_irregular = 0;
    miget_dimension_sampling_flag(dimension, &is_irregular);
    require(miget_dimension_size(dimension, &axis.size), "a dimension's size");
    if (axis.name == "time" && is_irregular == 0) {  // non-uniform times are stored as numbers
      if (miget_dimension_start(dimension, MI_ORDER_FILE, &axis.start) != MI_NOERROR ||
          miget_dimension_separation(dimension, MI_ORDER_FILE, &axis.step) != MI_NOERROR)
        axis.step = 0;
      return axis;
    }
    if (axis.name == "time" || axis.name == "vector_dimension") return axis;
    if (is_irregular != 0)
      throw scene::bad_input(fmt::format("{}: its samples along {} are unevenly spaced; resample it with mincresample",
                                         source_, axis.name));
    require(miget_dimension_start(dimension, MI_ORDER_FILE, &axis.start), "a dimension's start");
    require(miget_dimension_separation(dimension, MI_ORDER_FILE, &axis.step), "a dimension's step");
    require(miget_dimension_cosines(dimension, axis.cosines.data()), "a dimension's direction");
    return axis;
  }

  std::string source_;
  mihandle_t volume_ = nullptr;
};

io::ForeignArray hold_samples(Holdings& holdings, const Minc2Volume& volume, NumberType type,
                              const std::vector<misize_t>& first, const std::vector<misize_t>& counts, int components) {
  std::size_t bytes = io::size_of(type);
  for (const misize_t count : counts)
    if (__builtin_mul_overflow(bytes, count, &bytes)) throw std::bad_alloc();
  GridNumbers numbers{type, std::vector<std::byte>(bytes)};
  volume.read(type == NumberType::float64 ? MI_TYPE_DOUBLE : MI_TYPE_FLOAT, first, counts, numbers.bytes.data());
  return hold_field_numbers(holdings, "image", std::move(numbers), components);
}

}  // namespace

io::ForeignContents read_minc2(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string();
  const Minc2Volume volume(file);
  const std::vector<Axis> axes = volume.ordered_axes();
  io::ForeignContents contents;
  contents.format = "MINC 2";
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  const bool has_time = axes.front().name == "time", has_components = axes.back().name == "vector_dimension";
  contents.time_step = scene::chosen_step(requested, has_time ? axes.front().size : 1, source);
  if (has_time)
    scene::set_times(contents.time_step, scene::even_times(axes.front().start, axes.front().step, axes.front().size));
  const std::size_t step = contents.time_step.step;
  io::ForeignPart& part = contents.parts.emplace_back();
  part.kind = io::ForeignPart::Kind::image;
  std::vector<misize_t> first, counts;
  if (has_time) first.push_back(step), counts.push_back(1);
  const std::size_t z = has_time ? 1 : 0;
  for (std::size_t k = z; k < z + 3; ++k) {
    const Axis& axis = axes[k];
    const std::size_t along = z + 2 - k;  // x is the last of the three axes
    first.push_back(0), counts.push_back(axis.size);
    part.extent[2 * along + 1] = static_cast<std::int64_t>(axis.size) - 1;
    part.spacing[along] = axis.step;
    for (std::size_t row = 0; row < 3; ++row) {
      part.direction[3 * row + along] = axis.cosines[row];
      part.origin[row] += axis.start * axis.cosines[row];
    }
  }
  if (request.value("look", false)) return contents;
  const mitype_t type = volume.type();
  const bool is_wide = type == MI_TYPE_INT || type == MI_TYPE_UINT || type == MI_TYPE_DOUBLE;
  int components = 1;
  if (has_components) {
    constexpr misize_t most_components = 64;
    if (axes.back().size > most_components)
      throw scene::bad_input(fmt::format("{}: its samples have {} components; write at most {}", source,
                                         axes.back().size, most_components));
    first.push_back(0), counts.push_back(axes.back().size);
    components = static_cast<int>(axes.back().size);
  }
  part.point_fields.push_back(hold_samples(holdings, volume, is_wide ? NumberType::float64 : NumberType::float32, first,
                                           counts, std::max(components, 1)));
  return contents;
}

}  // namespace tessera::readers
