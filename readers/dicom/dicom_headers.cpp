// SPDX-License-Identifier: BSD-3-Clause
#include "readers/dicom/dicom_headers.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "system/descriptor.hpp"

namespace tessera::readers {
namespace {

using Three = std::array<double, 3>;

Three three_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 vector_of(const nlohmann::json& json) {
  const auto v = json.get<Three>();
  return {v[0], v[1], v[2]};
}

/// Converts texts of a header, which may contain arbitrary bytes, to binary values, because JSON strings must not
/// contain them.
nlohmann::json binary(const std::string& text) {
  return nlohmann::json::binary(std::vector<std::uint8_t>(text.begin(), text.end()));
}
std::string text_of(const nlohmann::json& json) {
  const auto& bytes = json.get_binary();
  return {bytes.begin(), bytes.end()};
}

nlohmann::json json_of(const std::vector<DicomFrame>& frames) {
  nlohmann::json list = nlohmann::json::array();
  for (const DicomFrame& f : frames)
    list.push_back({three_of(f.position), three_of(f.row), three_of(f.column), f.slope, f.intercept, f.time.value,
                    f.time.unit, f.spacing.x, f.spacing.y, f.segment});
  return list;
}

nlohmann::json json_of(const DicomSegments& segments) {
  nlohmann::json list = nlohmann::json::array({binary(segments.type)});
  for (const auto& [number, name] : segments.names) list.push_back({number, binary(name)});
  return list;
}

DicomSegments segments_of(const nlohmann::json& j) {
  DicomSegments segments{.type = text_of(j.at(0)), .names = {}};
  for (std::size_t k = 1; k < j.size(); ++k)
    segments.names.emplace_back(j.at(k).at(0).get<std::int64_t>(), text_of(j.at(k).at(1)));
  return segments;
}

DicomFrame frame_of(const nlohmann::json& j) {
  return {vector_of(j.at(0)),
          vector_of(j.at(1)),
          vector_of(j.at(2)),
          j.at(3),
          j.at(4),
          {j.at(5), j.at(6)},
          {j.at(7), j.at(8)},
          j.at(9)};
}

nlohmann::json json_of(const DicomSlice& s) {
  return nlohmann::json::array({binary(s.series),
                                binary(s.modality),
                                binary(s.unit),
                                s.columns,
                                s.rows,
                                s.frames,
                                s.components,
                                s.is_packed,
                                s.bytes,
                                s.has_position,
                                three_of(s.position),
                                three_of(s.row),
                                three_of(s.column),
                                three_of(s.spacing),
                                s.slope,
                                s.intercept,
                                s.number,
                                {s.time.value, s.time.unit},
                                s.samples_end,
                                s.padding ? nlohmann::json(*s.padding) : nlohmann::json(),
                                json_of(s.each),
                                s.frames_note,
                                s.bits,
                                s.is_mosaic,
                                json_of(s.segments)});
}

DicomSlice slice_of(const nlohmann::json& j, const std::filesystem::path& file) {
  DicomSlice s;
  s.file = file;
  s.series = text_of(j.at(0)), s.modality = text_of(j.at(1)), s.unit = text_of(j.at(2));
  j.at(3).get_to(s.columns), j.at(4).get_to(s.rows), j.at(5).get_to(s.frames);
  j.at(6).get_to(s.components), j.at(7).get_to(s.is_packed), j.at(8).get_to(s.bytes);
  j.at(9).get_to(s.has_position);
  s.position = vector_of(j.at(10)), s.row = vector_of(j.at(11)), s.column = vector_of(j.at(12));
  s.spacing = vector_of(j.at(13));
  j.at(14).get_to(s.slope), j.at(15).get_to(s.intercept), j.at(16).get_to(s.number);
  s.time = {j.at(17).at(0), j.at(17).at(1)};
  j.at(18).get_to(s.samples_end);
  if (!j.at(19).is_null()) s.padding = j.at(19).get<std::array<double, 2>>();
  for (const nlohmann::json& frame : j.at(20)) s.each.push_back(frame_of(frame));
  j.at(21).get_to(s.frames_note);
  j.at(22).get_to(s.bits);
  j.at(23).get_to(s.is_mosaic);
  s.segments = segments_of(j.at(24));
  return s;
}

/// Runs in the forked process: sends each file's header as its length and CBOR. A length of 0 means that the file is
/// not an image.
[[noreturn]] void send_headers(int to, std::span<const std::filesystem::path> files) {
  for (const std::filesystem::path& file : files) {
    std::vector<std::uint8_t> bytes;
    if (const auto slice = read_dicom_header(file)) bytes = nlohmann::json::to_cbor(json_of(*slice));
    const auto length = static_cast<std::uint32_t>(bytes.size());
    if (!system::write_all(to, &length, sizeof length) || !system::write_all(to, bytes.data(), bytes.size())) break;
  }
  ::_exit(0);
}

/// Reads headers in a forked process. Returns the number of files that it has read, or found not to be images.
std::size_t read_some(std::span<const std::filesystem::path> files, std::vector<DicomSlice>& slices) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category());
  system::Descriptor out(ends[1]);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(::fdopen(ends[0], "rb"), std::fclose);
  const auto take = [&](void* bytes, std::size_t count) { return std::fread(bytes, 1, count, in.get()) == count; };
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category());
  if (child == 0) send_headers(out.get(), files);
  out = system::Descriptor();
  std::size_t done = 0;
  for (std::uint32_t length = 0; done < files.size() && take(&length, sizeof length); ++done) {
    std::vector<std::uint8_t> bytes(length);
    if (!take(bytes.data(), length)) break;
    if (length > 0) slices.push_back(slice_of(nlohmann::json::from_cbor(bytes), files[done]));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return done;
}

}  // namespace

std::vector<DicomSlice> read_dicom_headers(std::span<const std::filesystem::path> files) {
  std::vector<DicomSlice> slices;
  for (std::size_t first = 0; first < files.size();)
    first += read_some(files.subspan(first), slices) + 1;  // skips the file at which the process died, if any
  return slices;
}

}  // namespace tessera::readers
