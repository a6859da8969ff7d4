// SPDX-License-Identifier: BSD-3-Clause
// NIfTI-1 and NIfTI-2. Source: Cox et al., "A (sort of) new image data format standard: NIfTI-1", 2004, and the headers
// nifti1.h and nifti2.h of the NIfTI Data Format Working Group. VTK's reader leaves slope, intercept and orientation to
// its caller and keeps all samples in memory, so the header is read here.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "io/files/input_file.hpp"
#include "io/volume/volume_formats.hpp"
#include "scene/byte_order.hpp"
#include "scene/time_step_read.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t header_size_1 = 348, header_size_2 = 540;

std::vector<std::byte> first_bytes(std::string_view beginning) {
  const auto bytes = std::as_bytes(std::span(beginning.substr(0, header_size_2)));
  return {bytes.begin(), bytes.end()};
}

/// Reads the header, up to 540 bytes, inflated if the file is gzip.
std::vector<std::byte> header_bytes(const std::filesystem::path& file) {
  constexpr std::size_t enough = 1 << 16;  // sufficient even for gzip, which adds a file name and expands little
  const std::string beginning = read_beginning(file, enough);
  return system::looks_like_gzip(beginning)
             ? system::inflate_beginning(std::as_bytes(std::span(beginning)), header_size_2)
             : first_bytes(beginning);
}

class NiftiHeader {
 public:
  explicit NiftiHeader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {
    if (bytes_.size() < header_size_1) return;
    for (const bool swapped : {false, true}) {
      swapped_ = swapped;
      const auto size = get<std::int32_t>(0);
      if (size == static_cast<std::int32_t>(header_size_1) && magic(344, "n+1")) version_ = 1;
      if (size == static_cast<std::int32_t>(header_size_1) && magic(344, "ni1")) version_ = 1, separate_ = true;
      if (size == static_cast<std::int32_t>(header_size_2) && bytes_.size() >= header_size_2 && magic(4, "ni2"))
        version_ = 2, separate_ = true;
      if (size == static_cast<std::int32_t>(header_size_2) && bytes_.size() >= header_size_2 && magic(4, "n+2"))
        version_ = 2;
      if (version_ != 0) return;
    }
  }

  /// 0: not NIfTI.
  [[nodiscard]] int version() const { return version_; }
  /// Whether the header is that of Analyze 7.5, which has the same size, dimensions, types and spacing, but no magic
  /// word.
  [[nodiscard]] bool is_analyze() {
    if (version_ != 0 || bytes_.size() < header_size_1) return false;
    for (const bool swapped : {false, true}) {
      swapped_ = swapped;
      const auto dimensions = get<std::int16_t>(40);
      if (get<std::int32_t>(0) == static_cast<std::int32_t>(header_size_1) && dimensions >= 1 && dimensions <= 7) {
        version_ = 1, separate_ = true;
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool separate() const { return separate_; }
  [[nodiscard]] bool swapped() const { return swapped_; }
  [[nodiscard]] std::int64_t dim(std::size_t k) const {
    return version_ == 1 ? get<std::int16_t>(40 + 2 * k) : get<std::int64_t>(16 + 8 * k);
  }
  [[nodiscard]] int datatype() const { return get<std::int16_t>(version_ == 1 ? 70 : 12); }
  [[nodiscard]] double pixdim(std::size_t k) const { return real(76 + 4 * k, 104 + 8 * k); }
  [[nodiscard]] double vox_offset() const {
    return version_ == 1 ? get<float>(108) : static_cast<double>(get<std::int64_t>(168));
  }
  [[nodiscard]] double slope() const { return real(112, 176); }
  [[nodiscard]] double intercept() const { return real(116, 184); }
  [[nodiscard]] int qform_code() const { return version_ == 1 ? get<std::int16_t>(252) : get<std::int32_t>(344); }
  [[nodiscard]] int sform_code() const { return version_ == 1 ? get<std::int16_t>(254) : get<std::int32_t>(348); }
  /// Number k of quatern_b, c, d, qoffset_x, y, z.
  [[nodiscard]] double quaternion(std::size_t k) const { return real(256 + 4 * k, 352 + 8 * k); }
  [[nodiscard]] int intent() const { return version_ == 1 ? get<std::int16_t>(68) : get<std::int32_t>(504); }
  /// xyzt_units without the bits for time: 1 is m, 2 mm, 3 um, and 0 not stated.
  [[nodiscard]] int length_unit() const { return (version_ == 1 ? get<std::int8_t>(123) : get<std::int32_t>(500)) & 7; }
  /// The time unit in xyzt_units, in seconds; 0 if it is not stated or not a unit of time.
  [[nodiscard]] double time_unit() const {
    const int code = (version_ == 1 ? get<std::int8_t>(123) : get<std::int32_t>(500)) & 0x38;
    return code == 8 ? 1 : code == 16 ? 1e-3 : code == 24 ? 1e-6 : 0;
  }
  [[nodiscard]] double time_offset() const { return real(136, 224); }
  [[nodiscard]] double srow(std::size_t row, std::size_t column) const {
    return real(280 + 16 * row + 4 * column, 400 + 32 * row + 8 * column);
  }

 private:
  [[nodiscard]] bool magic(std::size_t at, const char* text) const {
    return std::memcmp(bytes_.data() + at, text, 4) == 0;
  }
  template <class T>
  [[nodiscard]] T get(std::size_t at) const {
    return scene::load<T>(bytes_.data() + at, swapped_);
  }
  [[nodiscard]] double real(std::size_t at_1, std::size_t at_2) const {
    return version_ == 1 ? static_cast<double>(get<float>(at_1)) : get<double>(at_2);
  }

  std::vector<std::byte> bytes_;
  int version_ = 0;
  bool separate_ = false, swapped_ = false;
};

struct NiftiType {
  int code;
  scene::NumberType type;
  int components;
};
constexpr std::array nifti_types = {
    NiftiType{2, scene::NumberType::uint8, 1},    NiftiType{4, scene::NumberType::int16, 1},
    NiftiType{8, scene::NumberType::int32, 1},    NiftiType{16, scene::NumberType::float32, 1},
    NiftiType{64, scene::NumberType::float64, 1}, NiftiType{128, scene::NumberType::uint8, 3},
    NiftiType{256, scene::NumberType::int8, 1},   NiftiType{512, scene::NumberType::uint16, 1},
    NiftiType{768, scene::NumberType::uint32, 1}, NiftiType{2304, scene::NumberType::uint8, 4},
    NiftiType{1024, scene::NumberType::int64, 1}, NiftiType{1280, scene::NumberType::uint64, 1}};

/// nifti1.h, "METHOD 2": the rotation of a unit quaternion with a >= 0. The third axis is mirrored if qfac is -1.
std::array<glm::dvec3, 3> quaternion_steps(const NiftiHeader& header, const glm::dvec3& spacing) {
  double b = header.quaternion(0), c = header.quaternion(1), d = header.quaternion(2);
  double a = 1 - (b * b + c * c + d * d);
  if (a < 1e-7) {  // a half turn: rounding may have made a^2 slightly negative
    const double length = std::sqrt(b * b + c * c + d * d);
    b /= length, c /= length, d /= length, a = 0;
  } else {
    a = std::sqrt(a);
  }
  const double mirror = header.pixdim(0) < 0 ? -1 : 1;
  return {glm::dvec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)) * spacing.x,
          glm::dvec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)) * spacing.y,
          glm::dvec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b) * spacing.z * mirror};
}

/// Sets anatomical axes if the coordinates are those of a scanner or an atlas (codes 1, 3, 4), or in millimetres.
/// Libraries write the other codes for data of any kind; in that case the axes apply only if the values look like those
/// of CT.
void set_nifti_axes(const NiftiHeader& header, int code, StoredVolume& volume) {
  const bool is_body = code == 1 || code == 3 || code == 4 || header.length_unit() == 2;
  (is_body ? volume.body_axes : volume.axes_if_ct) = BodyAxes::ras;
}

/// Sets tags for the meaning of the values and the unit of length.
void set_nifti_tags(const NiftiHeader& header, StoredVolume& volume) {
  constexpr int label_intent = 1002, neuro_name_intent = 1005;  // nifti1.h
  volume.tags.labels = header.intent() == label_intent || header.intent() == neuro_name_intent;
  constexpr std::array units = {"", "m", "mm", "um"};
  if (const int unit = header.length_unit(); unit > 0 && unit < 4)
    volume.tags.length_unit = units[static_cast<std::size_t>(unit)];
}

void set_nifti_geometry(const NiftiHeader& header, const std::filesystem::path& file, StoredVolume& volume) {
  scene::GridGeometry& g = volume.grid.geometry;
  glm::dvec3 spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) spacing[static_cast<int>(axis)] = std::abs(header.pixdim(axis + 1));
  if (header.sform_code() > 0) {
    std::array<glm::dvec3, 3> steps;
    for (std::size_t column = 0; column < 3; ++column)
      steps[column] = {header.srow(0, column), header.srow(1, column), header.srow(2, column)};
    scene::set_axes(g, steps);
    g.origin = {header.srow(0, 3), header.srow(1, 3), header.srow(2, 3)};
    set_nifti_axes(header, header.sform_code(), volume);
    volume.notes.emplace_back("placed by its sform");
  } else if (header.qform_code() > 0) {
    scene::set_axes(g, quaternion_steps(header, spacing));
    g.spacing = spacing;  // the given spacing, which has no rounding errors of the quaternion
    g.origin = {header.quaternion(3), header.quaternion(4), header.quaternion(5)};
    set_nifti_axes(header, header.qform_code(), volume);
    volume.notes.emplace_back("placed by its qform");
  } else {
    g.spacing = spacing;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (!(g.spacing[axis] > 0) || !std::isfinite(g.spacing[axis]))
      throw damaged(file, fmt::format("the spacing along {} is {}", "xyz"[axis], g.spacing[axis]));
}

/// Sets sizes, steps and components.
void set_nifti_dimensions(const NiftiHeader& header, const std::filesystem::path& file, StoredVolume& volume) {
  const std::int64_t dimensions = header.dim(0);
  if (dimensions < 1 || dimensions > 7) throw damaged(file, fmt::format("its header states {} dimensions", dimensions));
  for (std::size_t k = 1; k <= static_cast<std::size_t>(dimensions); ++k) {
    if (header.dim(k) < 1) throw damaged(file, fmt::format("dimension {} is {}", k, header.dim(k)));
    if (k > 5 && header.dim(k) > 1)
      throw scene::bad_input(
          fmt::format("{}: it has {} dimensions, and dimension {} has {} entries; only three dimensions, time and "
                      "components are supported, write one volume alone",
                      file.string(), dimensions, k, header.dim(k)));
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    volume.grid.geometry.points[axis] = static_cast<std::int64_t>(axis) < dimensions ? header.dim(axis + 1) : 1;
  if (dimensions >= 4) volume.steps = static_cast<std::uint64_t>(header.dim(4));
  if (dimensions < 5 || header.dim(5) == 1) return;
  // NIfTI stores all steps of a component before the next component; volumes with both are not supported.
  if (volume.components > 1 || volume.steps > 1 || header.dim(5) > 64)
    throw scene::bad_input(
        fmt::format("{}: dimension 5 has {} components and dimension 4 has {} time steps; write only one of the two, "
                    "with at most 64 components",
                    file.string(), header.dim(5), volume.steps));
  volume.components = static_cast<int>(header.dim(5));
  volume.planar = true;
}

void set_nifti_type(const NiftiHeader& header, const std::filesystem::path& file, StoredVolume& volume) {
  const auto* type = std::find_if(nifti_types.begin(), nifti_types.end(),
                                  [&](const NiftiType& known) { return known.code == header.datatype(); });
  if (type == nifti_types.end())
    throw scene::bad_input(fmt::format("{}: its data type {} is not supported; write integers or 32 or 64-bit floats",
                                       file.string(), header.datatype()));
  volume.set_type(type->type);
  volume.components = type->components;
  volume.swapped = header.swapped();
}

/// Returns the file of samples for a separate header: x.img for x.hdr, compressed or not.
std::filesystem::path image_of_header(const std::filesystem::path& header) {
  std::filesystem::path stem = header;
  if (system::lower_extension(stem) == ".gz") stem.replace_extension();
  const bool capitals = stem.extension() == ".HDR";
  stem.replace_extension(capitals ? ".IMG" : ".img");
  for (const char* end : {"", ".gz"}) {
    std::filesystem::path image = stem;
    image += end;
    std::error_code unknown;
    if (std::filesystem::is_regular_file(image, unknown)) return image;
  }
  throw scene::bad_input(
      fmt::format("{}: its samples are in {}, which does not exist; put that file next to the header", header.string(),
                  stem.filename().string()));
}

/// Returns the header's name: x.hdr for x.img; any other file is the header itself.
std::filesystem::path header_of_image(const std::filesystem::path& file) {
  std::filesystem::path stem = file;
  if (system::lower_extension(stem) == ".gz") stem.replace_extension();
  if (system::lower_extension(stem) != ".img") return file;
  stem.replace_extension(stem.extension() == ".IMG" ? ".HDR" : ".hdr");
  for (const char* end : {"", ".gz"}) {
    std::filesystem::path header = stem;
    header += end;
    std::error_code unknown;
    if (std::filesystem::is_regular_file(header, unknown)) return header;
  }
  throw scene::bad_input(fmt::format("{}: its header {} does not exist; put that file next to the samples",
                                     file.string(), stem.filename().string()));
}

/// `file` is the header's path; `input` is the header or the samples.
void set_nifti_payload(const NiftiHeader& header, const std::filesystem::path& file, const InputFile& input,
                       StoredVolume& volume) {
  const double offset = header.vox_offset();
  if (!(offset >= 0 && offset < 1e9)) throw damaged(file, fmt::format("its samples begin at byte {}", offset));
  // If one file contains header and samples, the samples begin after the header, even if old writers stored 0.
  const double least =
      header.separate() ? 0 : static_cast<double>(header.version() == 1 ? header_size_1 : header_size_2) + 4;
  volume.offset = static_cast<std::uint64_t>(std::max(offset, least));
  volume.payload = header.separate() ? image_of_header(file) : file;
  const bool is_input = volume.payload == input.path;
  if (is_input) volume.payload_size = input.size;
  volume.compressed = volume.compressed_whole =
      is_input ? input.is_gzip : system::looks_like_gzip(read_beginning(volume.payload, 2));
}

StoredVolume read_nifti_header(const NiftiHeader& header, const std::filesystem::path& file, const InputFile& input) {
  if (header.version() == 0)
    throw damaged(file, "it does not begin with a whole NIfTI header (348 or 540 bytes with its magic word)");
  StoredVolume volume;
  volume.format = fmt::format("NIfTI-{}", header.version());
  set_nifti_type(header, file, volume);
  set_nifti_dimensions(header, file, volume);
  if (header.slope() != 0 && std::isfinite(header.slope()) && std::isfinite(header.intercept())) {
    volume.grid.scale = header.slope();
    volume.grid.shift = header.intercept();
    if (volume.grid.scale != 1 || volume.grid.shift != 0)
      volume.notes.push_back(fmt::format("values are {:.9g} * sample + {:.9g}, as its header states", volume.grid.scale,
                                         volume.grid.shift));
  }
  set_nifti_geometry(header, file, volume);
  set_nifti_tags(header, volume);
  volume.times =
      scene::even_times(header.time_offset() * header.time_unit(), header.pixdim(4) * header.time_unit(), volume.steps);
  set_nifti_payload(header, file, input, volume);
  return volume;
}

StoredVolume read_analyze_header(const InputFile& input) {
  const std::filesystem::path header_file = header_of_image(input.path);
  NiftiHeader header(header_file == input.path ? first_bytes(input.beginning) : header_bytes(header_file));
  if (header.version() != 0) return read_nifti_header(header, header_file, input);
  if (!header.is_analyze())
    throw damaged(header_file,
                  "it does not begin like an Analyze 7.5 or NIfTI header, whose first number is its size, 348");
  StoredVolume volume;
  volume.format = "Analyze 7.5";
  set_nifti_type(header, header_file, volume);
  set_nifti_dimensions(header, header_file, volume);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Many writers omit spacings, and some store them with a sign.
    const double spacing = std::abs(header.pixdim(axis + 1));
    volume.grid.geometry.spacing[static_cast<int>(axis)] = spacing > 0 && std::isfinite(spacing) ? spacing : 1;
  }
  volume.notes.emplace_back("Analyze 7.5 does not define left and right: the axes are used as stored in the file");
  set_nifti_payload(header, header_file, input, volume);
  return volume;
}

}  // namespace

VolumeFile open_nifti(const InputFile& file, const VolumeOptions& options) {
  return open_stored(read_nifti_header(NiftiHeader(first_bytes(file.beginning)), file.path, file), options, file.name);
}

VolumeFile open_analyze(const InputFile& file, const VolumeOptions& options) {
  return open_stored(read_analyze_header(file), options, file.name);
}

}  // namespace tessera::io
