// SPDX-License-Identifier: BSD-3-Clause
#include "readers/dicom/dicom_slice.hpp"

#include <fmt/format.h>
#include <gdcmImage.h>
#include <gdcmImageHelper.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <type_traits>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "readers/dicom/dicom_elements.hpp"
#include "readers/dicom/dicom_frames.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

constexpr const char* write_again = "the file is truncated or damaged, write it again or leave it out";

/// Returns the key by which slices at one position are sorted: the first of these values that the file has.
DicomTime time_of(const gdcm::DataSet& data) {
  if (const auto index = dicom_number(data, 0x0020, 0x0100)) return {*index, 0};  // temporal position identifier
  if (const auto trigger = dicom_number(data, 0x0018, 0x1060))
    return {*trigger, 1e-3};                              // time since the heartbeat, in milliseconds
  for (const std::uint16_t element : {0x0022, 0x0023}) {  // dates (acquisition, content); element + 0x10 is the time
    const std::string date = dicom_text(data, 0x0008, element);
    if (const std::string clock = dicom_text(data, 0x0008, static_cast<std::uint16_t>(element + 0x10)); !clock.empty())
      if (const auto moment = dicom_moment(date + clock); moment && date.size() == 8) return {*moment, 1};
  }
  if (const auto acquired = dicom_number(data, 0x0008, 0x0032)) return {dicom_seconds(*acquired), 1};
  if (const auto content = dicom_number(data, 0x0008, 0x0033)) return {dicom_seconds(*content), 1};
  return {};
}

void set_place(const gdcm::File& file, DicomSlice& slice) {
  const gdcm::DataSet& data = file.GetDataSet();
  const std::vector<double> spacing = gdcm::ImageHelper::GetSpacingValue(file);
  for (std::size_t k = 0; k < std::min<std::size_t>(spacing.size(), 3); ++k)
    if (spacing[k] > 0 && std::isfinite(spacing[k])) slice.spacing[static_cast<int>(k)] = spacing[k];
  const bool is_placed = slice.frames > 1 || dicom_numbers(data, 0x0020, 0x0032).size() == 3;
  if (!is_placed)  // GDCM returns 1
    for (const std::uint16_t element : {0x0050, 0x0088})
      if (const auto apart = dicom_number(data, 0x0018, element); apart && *apart != 0)
        slice.spacing.z = std::abs(*apart);
  const std::vector<double> origin = gdcm::ImageHelper::GetOriginValue(file);
  const std::vector<double> axes = gdcm::ImageHelper::GetDirectionCosinesValue(file);
  if (axes.size() == 6) {
    const glm::dvec3 row(axes[0], axes[1], axes[2]), column(axes[3], axes[4], axes[5]);
    const double across = glm::length(glm::cross(row, column));
    if (std::isfinite(across) && across > 0.9) slice.row = glm::normalize(row), slice.column = glm::normalize(column);
  }
  if (is_placed && origin.size() >= 3 &&
      std::all_of(origin.begin(), origin.begin() + 3, [](double x) { return std::isfinite(x); })) {
    slice.position = {origin[0], origin[1], origin[2]};
    slice.has_position = true;
  }
}

bool set_samples(const gdcm::File& file, DicomSlice& slice) {
  const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
  const std::vector<unsigned> sizes = gdcm::ImageHelper::GetDimensionsValue(file);
  if (sizes.size() < 2 || sizes[0] == 0 || sizes[1] == 0) return false;
  slice.columns = sizes[0], slice.rows = sizes[1];
  slice.frames = sizes.size() > 2 ? std::max<std::int64_t>(sizes[2], 1) : 1;
  slice.components = format.GetSamplesPerPixel();
  slice.is_packed = file.GetHeader().GetDataSetTransferSyntax().IsEncapsulated();
  slice.bits = format.GetBitsAllocated();
  const auto samples =
      static_cast<std::uint64_t>(slice.columns * slice.rows) * static_cast<std::uint64_t>(slice.frames);
  slice.bytes = (samples * static_cast<std::uint64_t>(slice.bits) + 7) / 8;
  const std::vector<double> rescale = gdcm::ImageHelper::GetRescaleInterceptSlopeValue(file);
  if (rescale.size() == 2 && std::isfinite(rescale[0]) && std::isfinite(rescale[1]) && rescale[1] != 0)
    slice.intercept = rescale[0], slice.slope = rescale[1];
  return true;
}

std::optional<NumberType> number_type_of(const gdcm::PixelFormat& format) {
  constexpr std::array known = {std::pair(gdcm::PixelFormat::UINT8, NumberType::uint8),
                                std::pair(gdcm::PixelFormat::INT8, NumberType::int8),
                                std::pair(gdcm::PixelFormat::UINT16, NumberType::uint16),
                                std::pair(gdcm::PixelFormat::INT16, NumberType::int16),
                                std::pair(gdcm::PixelFormat::UINT32, NumberType::uint32),
                                std::pair(gdcm::PixelFormat::INT32, NumberType::int32),
                                std::pair(gdcm::PixelFormat::FLOAT32, NumberType::float32),
                                std::pair(gdcm::PixelFormat::FLOAT64, NumberType::float64)};
  for (const auto& [theirs, ours] : known)
    if (format.GetScalarType() == theirs) return ours;
  return std::nullopt;
}

/// Returns a sample that uses only `bits` bits.
template <class T>
T sample_at(const char* bytes, int bits) {
  T sample;
  std::memcpy(&sample, bytes, sizeof(T));
  if constexpr (std::is_integral_v<T>) {
    const int spare = static_cast<int>(sizeof(T) * 8) - bits;
    if (spare > 0 && spare < static_cast<int>(sizeof(T) * 8)) {
      using Unsigned = std::make_unsigned_t<T>;
      sample = static_cast<T>(static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(sample) << spare)) >> spare);
    }
  }
  return sample;
}

/// Returns a 16-bit sample, signed or not like the file's samples; no value if the element is missing.
std::optional<double> sample_in(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element, bool is_signed) {
  const gdcm::Tag tag(group, element);
  if (!data.FindDataElement(tag)) return std::nullopt;
  const gdcm::ByteValue* const value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetLength() != 2) return std::nullopt;
  return is_signed ? sample_at<std::int16_t>(value->GetPointer(), 16)
                   : static_cast<double>(sample_at<std::uint16_t>(value->GetPointer(), 16));
}

/// Returns the padding value or, if the file also has a limit, the range.
std::optional<std::array<double, 2>> padding_of(const gdcm::File& file) {
  const bool is_signed = gdcm::ImageHelper::GetPixelFormatValue(file).GetPixelRepresentation() == 1;
  const std::optional<double> value = sample_in(file.GetDataSet(), 0x0028, 0x0120, is_signed);
  if (!value) return std::nullopt;
  const double limit = sample_in(file.GetDataSet(), 0x0028, 0x0121, is_signed).value_or(*value);
  return std::array{std::min(*value, limit), std::max(*value, limit)};
}

DicomSegments segments_of(const gdcm::DataSet& data) {
  DicomSegments segments{.type = dicom_text(data, 0x0062, 0x0001), .names = {}};
  if (segments.type.empty()) segments.type = "BINARY";
  for (const gdcm::DataSet& segment : dicom_items(data, 0x0062, 0x0002))
    if (const auto number = dicom_count(segment, 0x0062, 0x0004))
      segments.names.emplace_back(static_cast<std::int64_t>(*number), dicom_text(segment, 0x0062, 0x0005));
  return segments;
}

/// Whether the transfer syntax in the header is the deflated one; the header itself is never deflated.
bool is_deflated(const std::filesystem::path& file) {
  return io::read_beginning(file, 1024).find("1.2.840.10008.1.2.1.99") != std::string::npos;
}

}  // namespace

glm::dvec3 DicomSlice::normal() const { return glm::normalize(glm::cross(row, column)); }

std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file) {
  gdcm::Trace::WarningOff(), gdcm::Trace::ErrorOff(), gdcm::Trace::DebugOff();
  try {
    if (is_deflated(file))  // GDCM aborts for deflated files, or returns wrong samples if these are truncated
      throw scene::bad_input(fmt::format(
          "{}: its data set is deflated, which is not supported; convert it with dcmtk: dcmconv +te", file.string()));
    std::ifstream in(file, std::ios::binary);
    gdcm::Reader reader;
    reader.SetStream(in);
    // Stops before the samples, so that the header of a file whose samples are truncated can be read.
    if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0001), {gdcm::Tag(0x7fe0, 0x0010)})) return std::nullopt;
    const gdcm::DataSet& data = reader.GetFile().GetDataSet();
    // Checks for rows and columns, which a DICOMDIR, a report or a plan does not have.
    if (!data.FindDataElement(gdcm::Tag(0x0028, 0x0010)) || !data.FindDataElement(gdcm::Tag(0x0028, 0x0011)))
      return std::nullopt;
    DicomSlice slice;
    slice.file = file;
    slice.series = dicom_text(data, 0x0020, 0x000e);
    slice.modality = dicom_text(data, 0x0008, 0x0060);
    slice.unit = dicom_text(data, 0x0028, 0x1054);
    if (slice.unit.empty()) slice.unit = dicom_text(data, 0x0054, 0x1001);
    if (slice.unit.empty() && slice.modality == "RTDOSE") slice.unit = dicom_text(data, 0x3004, 0x0002);
    if (!set_samples(reader.GetFile(), slice)) return std::nullopt;
    slice.is_mosaic = dicom_text(data, 0x0008, 0x0008).find("\\MOSAIC") != std::string::npos;
    slice.samples_end = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
    set_place(reader.GetFile(), slice);
    slice.number = static_cast<std::int64_t>(std::clamp(dicom_number(data, 0x0020, 0x0013).value_or(0), -1e9, 1e9));
    slice.time = time_of(data);
    if (slice.modality == "SEG") slice.segments = segments_of(data);
    // For labels, the padding value is the value of the background.
    if (slice.segments.type.empty()) slice.padding = padding_of(reader.GetFile());
    if (const auto most = dicom_shorts(data, 0x0062, 0x000e); slice.segments.type == "FRACTIONAL" && !most.empty())
      slice.slope = 1.0 / std::max<double>(most.front(), 1);
    if (slice.frames > 1) set_frames(data, slice);
    return slice;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const scene::Error&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

DicomSamples::DicomSamples(const DicomSlice& slice)
    : frame_size_(static_cast<std::size_t>(slice.columns * slice.rows)), padding_(slice.padding) {
  const std::string source = slice.file.string();
  const auto refuse = [&](const char* what) {
    return scene::bad_input(fmt::format("{}: {}; {}", source, what, write_again));
  };
  // Checked here, because GDCM accepts truncated samples, and compressed samples without their end marker.
  {
    const io::WholeFile mapped(slice.file);
    if (slice.is_packed ? mapped.text().find("\xfe\xff\xdd\xe0") == std::string_view::npos
                        : mapped.text().size() < std::max(slice.samples_end, slice.bytes))
      throw refuse("it ends before its samples do");
  }
  if (slice.bits == 1) {
    take_bits(slice);
    return;
  }
  const auto refuse_bits = [&] {
    return scene::bad_input(
        fmt::format("{}: its samples have {} bits, which is not supported; write 8, 16 or 32", source, slice.bits));
  };
  if (slice.bits % 8 != 0 && slice.bits != 12) throw refuse_bits();  // GDCM aborts on these
  gdcm::ImageReader reader;
  reader.SetFileName(slice.file.c_str());
  if (!reader.Read()) throw refuse("GDCM cannot read its samples");
  const gdcm::Image& image = reader.GetImage();
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const auto samples = static_cast<std::size_t>(slice.columns * slice.rows * slice.frames);
  if (image.GetBufferLength() != samples * format.GetPixelSize() || format.GetSamplesPerPixel() != 1)
    throw refuse("the number of its samples differs from that in its header");
  const std::optional<NumberType> type = number_type_of(format);
  if (!type) throw refuse_bits();
  type_ = *type, bits_ = format.GetBitsStored();
  bytes_.resize(image.GetBufferLength());
  if (!image.GetBuffer(bytes_.data())) throw refuse("GDCM cannot unpack its samples");
  if (bytes_.size() != samples * io::size_of(type_))
    throw refuse("the number of its samples differs from that in its header");
}

/// Unpacks bits. The first sample is the lowest bit; neither rows nor frames are byte-aligned (PS3.5, 8.1.1).
void DicomSamples::take_bits(const DicomSlice& slice) {
  const std::string source = slice.file.string();
  if (slice.is_packed)
    throw scene::bad_input(fmt::format(
        "{}: its 1-bit samples are compressed, which is not supported; convert it to NRRD by dcmqi's segimage2itkimage",
        source));
  gdcm::Reader reader;
  reader.SetFileName(slice.file.c_str());
  const gdcm::Tag samples(0x7fe0, 0x0010);
  const gdcm::ByteValue* const bits = reader.Read() && reader.GetFile().GetDataSet().FindDataElement(samples)
                                          ? reader.GetFile().GetDataSet().GetDataElement(samples).GetByteValue()
                                          : nullptr;
  if (bits == nullptr || bits->GetLength() < slice.bytes)
    throw scene::bad_input(fmt::format("{}: it ends before its samples do; {}", source, write_again));
  has_bits_ = true;
  bytes_.assign(bits->GetPointer(), bits->GetPointer() + slice.bytes);
}

DicomValues DicomSamples::values(const DicomSlice& slice) const {
  DicomValues values;
  const std::size_t count = frame_count(), begin = static_cast<std::size_t>(slice.frame) * count;
  const auto is_whole = [](double v) { return v == std::floor(v); };
  // If values are integers in the order of the samples, they need not be checked one by one.
  const bool is_plain = !padding_ && !slice.joins_frames && !has_bits_ && is_whole(slice.slope) &&
                        is_whole(slice.intercept) && std::abs(slice.slope) < 0x1p20 &&
                        std::abs(slice.intercept) < 0x1p52 && count > 0;
  io::with_number_type(type_, [&](auto zero) {
    using Number = decltype(zero);
    if constexpr (std::is_integral_v<Number>) {
      if (!is_plain) return;
      Number least = std::numeric_limits<Number>::max(), most = std::numeric_limits<Number>::lowest();
      for (std::size_t k = begin; k < begin + count; ++k) {
        const auto sample = sample_at<Number>(bytes_.data() + k * sizeof(Number), bits_);
        least = std::min(least, sample), most = std::max(most, sample);
      }
      const std::array ends{slice.slope * static_cast<double>(least) + slice.intercept,
                            slice.slope * static_cast<double>(most) + slice.intercept};
      values.tally.add(ends);
    }
  });
  if (values.tally.any_finite) return values;
  constexpr std::size_t at_once = 1 << 15;
  std::vector<double> some(std::min(at_once, count));
  for (std::size_t first = 0; first < count; first += at_once) {
    const auto part = std::span(some).first(std::min(at_once, count - first));
    if (slice.joins_frames)
      values.shared += read_joined(slice, first, part);
    else
      read(slice, first, part);
    values.tally.add(part);
    values.are_whole = values.are_whole &&
                       std::all_of(part.begin(), part.end(), [&](double v) { return std::isnan(v) || is_whole(v); });
  }
  return values;
}

void DicomSamples::read(const DicomSlice& slice, std::size_t first, std::span<double> out) const {
  if (slice.joins_frames)
    read_joined(slice, first, out);
  else
    read_frame(slice, slice.frame, first, out);
}

std::uint64_t DicomSamples::read_joined(const DicomSlice& slice, std::size_t first, std::span<double> out) const {
  std::ranges::fill(out, 0);
  std::uint64_t shared = 0;
  std::vector<double> frame(has_bits_ ? 0 : out.size());
  for (const DicomFrameOfSegment& part : slice.joined) {
    if (!has_bits_) read_frame(slice, part.frame, first, frame);
    const std::size_t begin = static_cast<std::size_t>(part.frame) * frame_size_ + first;
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (has_bits_ && (begin + k) % 8 == 0 && bytes_[(begin + k) / 8] == 0) {
        k += 7;  // skips whole bytes of zeros, because most of a segmentation is empty
        continue;
      }
      const double sample = has_bits_ ? slice.slope * bit_at(begin + k) : frame[k];
      if (sample == 0) continue;
      if (out[k] != 0) ++shared;
      out[k] = part.segment > 0 ? static_cast<double>(part.segment) : sample;
    }
  }
  return shared;
}

void DicomSamples::read_frame(const DicomSlice& slice, std::int64_t frame, std::size_t first,
                              std::span<double> out) const {
  first += static_cast<std::size_t>(frame) * frame_count();
  if (has_bits_) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = slice.slope * bit_at(first + k) + slice.intercept;
    return;
  }
  io::with_number_type(type_, [&](auto zero) {
    using Number = decltype(zero);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double sample = sample_at<Number>(bytes_.data() + (first + k) * sizeof(Number), bits_);
      const bool is_padding = padding_ && sample >= (*padding_)[0] && sample <= (*padding_)[1];
      out[k] = is_padding ? std::numeric_limits<double>::quiet_NaN() : slice.slope * sample + slice.intercept;
    }
  });
}

}  // namespace tessera::readers
