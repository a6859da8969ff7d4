// MINC 2, which is HDF5, by MINC's own library.
extern "C" {
#include <minc2.h>
}
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/helper/readers.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

struct Axis {
  std::string name;
  misize_t size = 0;
  double start = 0, step = 1;
  std::array<double, 3> cosines{};
};

/// An open volume. Every call that fails ends in Error.
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
          "{}: {} cannot be read as MINC 2; the file is truncated or damaged, write it anew", source_, what));
  }

  /// Slowest first: time, if it has steps, z, y and x. Later reads are in this order, whatever the file's.
  [[nodiscard]] std::vector<Axis> ordered_axes() const {
    int count = 0;
    require(miget_volume_dimension_count(volume_, MI_DIMCLASS_ANY, MI_DIMATTR_ALL, &count), "its dimensions");
    std::array<char, 5> time{"time"};
    std::array<char, 7> z{"zspace"}, y{"yspace"}, x{"xspace"};
    const std::array<char*, 4> names = {time.data(), z.data(), y.data(), x.data()};
    if (count != 3 && count != 4)
      throw scene::bad_input(
          fmt::format("{}: it has {} dimensions; give a volume of three, or four with time", source_, count));
    std::array<char*, 4> wanted{};
    std::copy_n(names.end() - count, count, wanted.begin());
    if (miset_apparent_dimension_order_by_name(volume_, count, wanted.data()) != MI_NOERROR)
      throw scene::bad_input(fmt::format(
          "{}: its dimensions are other than xspace, yspace, zspace and time; give a volume of scalars in space",
          source_));
    std::array<midimhandle_t, 4> dimensions{};
    // It gives their number, or 0 as other calls where all is well.
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

  /// Real values of a part; room for them is the caller's business.
  void read(mitype_t as, const std::vector<misize_t>& first, const std::vector<misize_t>& counts, void* out) const {
    require(miget_real_value_hyperslab(volume_, as, first.data(), counts.data(), out), "its samples");
  }

 private:
  [[nodiscard]] Axis axis_of(midimhandle_t dimension) const {
    Axis axis;
    char* name = nullptr;
    require(miget_dimension_name(dimension, &name), "a dimension's name");
    axis.name = name;
    mifree_name(name);
    miboolean_t is_irregular = 0;
    miget_dimension_sampling_flag(dimension, &is_irregular);
    require(miget_dimension_size(dimension, &axis.size), "a dimension's size");
    if (axis.name == "time") return axis;
    if (is_irregular != 0)
      throw scene::bad_input(
          fmt::format("{}: its samples along {} are uneven; resample it with mincresample", source_, axis.name));
    require(miget_dimension_start(dimension, MI_ORDER_FILE, &axis.start), "a dimension's start");
    require(miget_dimension_separation(dimension, MI_ORDER_FILE, &axis.step), "a dimension's step");
    require(miget_dimension_cosines(dimension, axis.cosines.data()), "a dimension's direction");
    return axis;
  }

  std::string source_;
  mihandle_t volume_ = nullptr;
};

template <class T>
ForeignArray hold_samples(Holdings& holdings, const Minc2Volume& volume, NumberType type, mitype_t as,
                          const std::vector<misize_t>& first, const std::vector<misize_t>& counts) {
  std::size_t samples = 1;
  for (const misize_t count : counts)
    if (__builtin_mul_overflow(samples, count, &samples)) throw std::bad_alloc();
  std::vector<T> values(samples);
  volume.read(as, first, counts, values.data());
  ForeignArray array{.name = "image", .type = type};
  std::array<double, 4096> some{};
  for (std::size_t at = 0; at < samples; at += some.size()) {
    const std::size_t n = std::min(some.size(), samples - at);
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(at), n, some.begin());
    array.tally.add(std::span(some).first(n));
  }
  return hold_vector(holdings, std::move(array), std::move(values));
}

}  // namespace

ForeignContents read_minc2(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string();
  const Minc2Volume volume(file);
  const std::vector<Axis> axes = volume.ordered_axes();
  ForeignContents contents;
  contents.format = "MINC 2";
  std::optional<std::size_t> wish;
  if (const auto step = request.find("time_step"); step != request.end()) wish = step->get<std::size_t>();
  contents.time_step = chosen_step(wish, axes.size() == 4 ? axes.front().size : 1, source);
  const std::size_t step = contents.time_step.step;
  ForeignPart& part = contents.parts.emplace_back();
  part.kind = ForeignPart::Kind::image;
  std::vector<misize_t> first, counts;
  if (axes.size() == 4) first.push_back(step), counts.push_back(1);
  for (std::size_t k = axes.size() - 3; k < axes.size(); ++k) {
    const Axis& axis = axes[k];
    const std::size_t along = axes.size() - 1 - k;  // x is the last of them
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
  part.point_fields.push_back(
      is_wide ? hold_samples<double>(holdings, volume, NumberType::float64, MI_TYPE_DOUBLE, first, counts)
              : hold_samples<float>(holdings, volume, NumberType::float32, MI_TYPE_FLOAT, first, counts));
  return contents;
}

}  // namespace tessera::io::helper
