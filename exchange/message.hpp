// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "exchange/transport.hpp"

/// How values become the bytes of a message, and all kinds of messages.
///
/// A message is a MessageHeader followed by the content of its kind. Values are little endian and follow each other
/// without gaps; structures have no padding. A list is a 64-bit number of values and the values; a text is a list of
/// bytes. All ranks run the same program: readers refuse any other version and unexpected kinds or lengths.
namespace tessera::exchange {

static_assert(std::endian::native == std::endian::little, "messages are little endian");

inline constexpr std::uint32_t wire_magic = 0x57535354;  ///< "TSSW"
inline constexpr std::uint16_t wire_version = 33;        ///< incremented whenever a message changes

/// All kinds, by channel, and what follows the header.
enum class MessageKind : std::uint16_t {
  // Channel fragments; the structures are in wire.hpp.
  begin = 1,    ///< u64 frame, FrameBegin, bits (lowest first), one per tile of the receiver: 1: parts follow
  parts = 2,    ///< u64 frame; repeated: PartHeader, `bytes` bytes of records
  end = 3,      ///< u64 frame, FrameEnd: the sender has finished the frame; its counters. Also on channel tiles
  packet = 51,  ///< PacketHeader (exchange/direct/direct_send.cpp); unless stopped or empty: pixels (packed_pixels.hpp)
                ///< and, if kept, f32 error estimates row by row
  // Channel credit.
  credit = 4,  ///< u64 bytes that the receiver may send again
  // Channel tiles.
  tiles = 5,   ///< u64 frame; repeated: u64 tile, its pixels (packed_pixels.hpp), u64 number of deep samples in the
               ///< tile; unless that is 0: u32 number of samples of each pixel, all samples (scene::DeepImageSample)
  region = 6,  ///< RegionHeader (frame/grid/volume_frames.hpp), list of rectangles; unless stopped, for each rectangle:
               ///< pixels (packed_pixels.hpp) of 64 rows at a time and, if kept, f32 error estimates row by row
  deep_rows = 7,  ///< u64 number of samples of each pixel of the sender's rows, all samples (scene::DeepImageSample)
  // Channel frames.
  frame_left = 8,  ///< nothing: a frame has been assembled
  // Channel stop.
  stop = 9,  ///< u64 number of the run to stop; 0, which a rank sends to itself: the run is over
  // Channel mesh.
  mesh_chunk = 10,  ///< MeshChunkHeader and arrays (frame/ranks/mesh_chunk.hpp)
  cell_keys = 61,  ///< u8: 1: the sender's last message; list of u64 keys of cells (frame/ranks/shared_repetitions.cpp)
  cell_ranges = 11,  ///< u64 first cell, u64 number of cells; f32 lowest, then f32 highest value of each cell
  // Channel timing.
  clock_question = 12,  ///< nothing
  clock_answer = 13,    ///< f64 microseconds of the sender's clock
  trace_events = 14,    ///< text
  // Channel agreement: collectives (collectives.hpp) and their content.
  gathered = 15,          ///< list of messages, each a list of bytes: the messages of all ranks, from rank 0
  barrier = 16,           ///< nothing
  reduction = 17,         ///< list of u64 (frame/ranks/reduce.hpp)
  instruction_sets = 18,  ///< i64 Highway's target bits
  host = 19,              ///< text: the machine's name
  device = 20,            ///< text: the compositing device's name, empty on ranks without one
  read_in_parts = 21,     ///< u8: 1: all projectors read parts of the file
  field_tallies = 22,     ///< u64 number of fields; for each field: the field, NumberTally, u8 blocks_count_up; then
                          ///< f64[6] box of the higher-order cells, texts: block names
  part_summary = 23,      ///< MeshCounts, HigherOrderCells, TimeStepRead, texts: notes on reading, notes on cells,
                          ///< surfaces; u64 size of used_points
  mesh_description = 24,  ///< MeshCounts, HigherOrderCells, u64 number of fields, fields, texts: notes, names of
                          ///< blocks, names of surfaces; text format, u64 time steps, u64 step, list of f64 times,
                          ///< f64[3] axis scale, text field, u8 association
  mesh_facts = 25,        ///< f64 box[6], f64 scalar range[2], u64 tets, u8 association
  mesh_volume = 26,       ///< 128-bit scene::VolumeSum
  tet_count = 27,         ///< u64
  tet_table = 28,         ///< list of u64: for each projector, how many tets or messages this rank has for it
  longest_edge = 29,      ///< f32
  frames_complete = 30,   ///< u64 complete frames; for a mesh also u64: 1: the other frames must be rendered again
  sink_failed = 31,       ///< u8: 1: rank 0's sink threw an exception
  cell_totals = 32,       ///< f64 lowest, f64 highest, u64 blank samples
  row_costs = 33,         ///< i32 x0, y0, x1, y1 of a region of the map; list of u64: one sum per row of the region
  column_costs = 34,      ///< the region as in row_costs; for each requested map row, a list of u64: one sum per column
  seconds = 35,           ///< f64 processor time of the last frame, in total or per thread (frame/grid/sort_first.cpp)
  of_job = 36,            ///< list of bytes: defined by the caller (tessera/job.hpp)
  higher_order = 37,      ///< u64[128] numbers of tets, by deviation (cells/curved/higher_order_plan.hpp); or the
                          ///< difference between two images (api/queries/higher_order.cpp)
  process_on_host = 38,   ///< name and process of a rank (exchange/one_line.cpp)
  arguments = 58,         ///< list of bytes: the arguments of the sender (first_contact.cpp)
  field_samples = 39,     ///< list of scene::FieldSample: from a rank's part (api/queries/field_samples.cpp)
  open_faces = 47,        ///< list of OpenFace (frame/mesh/boundary_faces.cpp): faces of only one tet of a rank's part
  ray_tets = 48,          ///< list of RayTet (api/queries/probe.cpp): the tets of a rank's part that a ray meets
  curved_part =
      40,  ///< a rank's part of a caller's mesh (frame/ranks/curved_parts.cpp); then MeshCounts, HigherOrderCells
  fill_tally = 62,   ///< scene::FillTally: for a rank's part of a field (api/dataset.cpp)
  next_frame = 52,   ///< u8: 1: there is another frame
  machine = 53,      ///< text: the machine on which the sender can share memory; empty: none (shared_pages.cpp)
  pages_offer = 54,  ///< u64 process, u64 key, i64 descriptor of pages for ranks of one machine; -1: none
  pages_seen = 55,   ///< u8: 1: the sender has opened the pages
  tile_times = 59,   ///< u8: 1: the last frame was not stopped; u64 process, f64 time of the process, list of TileTime
  image_split = 60,  ///< u8: 1: list of i32 rows, for each row a list of i32 columns, then for each row a list of i32
                     ///< steps; 0: list of f64 weights of the ranks, empty: keep the present weights
  volume_facts =
      57,           ///< what the sender has read of a volume, and where its samples are (frame/grid/shared_volume.cpp)
  files_read = 64,  ///< repeated: text name, u64 bytes, u64 checksum (api/same_files.cpp)
  volume_labels = 63,  ///< u8 whether values are labels, list of f64: the labels (frame/grid/shared_labels.cpp)
  // Channel fragments, from a rank to itself.
  wake = 56,  ///< nothing: all frames of the list are finished
  // All channels.
  attempt_end = 49,  ///< u8 ErrorCode (0: no error), text; the sender's last message of this attempt (attempt.hpp)
  // Internal to the transport.
  fault = 41,    ///< from a rank to rank 0: the rank's error: u8 ErrorCode, text
  verdict = 42,  ///< from rank 0 to all: the run's error: u8 ErrorCode, text
  done = 43,     ///< from a rank to rank 0, nothing: the sender's last message
  clear = 44,    ///< from rank 0 to all, nothing: no rank sends further messages
  alive = 45,    ///< text: the name of the sender's process (heartbeats.hpp)
  silent = 46,   ///< nothing: the sender has reported that rank 0 is silent
};

struct MessageHeader {
  std::uint32_t magic = wire_magic;
  std::uint16_t version = wire_version;
  MessageKind kind;
};
static_assert(sizeof(MessageHeader) == 8);

/// Appends a value's bytes.
template <class Value>
void append(Bytes& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

/// Appends the values without a count; the reader must know their number.
template <class Values>
void append_values(Bytes& bytes, const Values& values) {
  static_assert(std::is_trivially_copyable_v<typename Values::value_type>);
  const auto raw = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

template <class Values>
void append_list(Bytes& bytes, const Values& values) {
  append(bytes, std::uint64_t{values.size()});
  append_values(bytes, values);
}

inline void append_text(Bytes& bytes, std::string_view text) { append_list(bytes, text); }

/// Returns a message that consists of its header; the caller appends the rest. Reserves memory for `room` more bytes.
Bytes begin_message(MessageKind kind, std::size_t room = 0);

/// Returns a message of one value.
template <class Value>
Bytes message_of(MessageKind kind, const Value& value) {
  Bytes message = begin_message(kind, sizeof value);
  append(message, value);
  return message;
}

/// Takes values from the front of a sequence of bytes. Throws Error(system_failure) if there are too few bytes. A count
/// in the bytes is checked first, so that no memory is allocated for more values than the bytes can contain.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class Value>
  Value take() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take_bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) {
    if (count > left_.size()) refuse_short();
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  template <class Value>
  void take_values(std::span<Value> values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto from = take_bytes(values.size_bytes());
    if (!values.empty()) std::memcpy(values.data(), from.data(), from.size());
  }
  /// Appends `count` values to `values`.
  template <class Value>
  void take_onto(std::vector<Value>& values, std::uint64_t count) {
    if (count > left_.size() / sizeof(Value)) refuse_short();
    const std::size_t before = values.size();
    values.resize(before + count);
    take_values(std::span(values).subspan(before));
  }
  template <class Value>
  std::vector<Value> take_list() {
    std::vector<Value> values;
    take_onto(values, take<std::uint64_t>());
    return values;
  }
  std::string take_text() {
    const auto bytes = take_bytes(take<std::uint64_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[nodiscard]] bool empty() const { return left_.empty(); }
  /// Throws Error(system_failure) if some bytes have not been taken.
  void finish() const {
    if (!empty()) refuse("is longer than it states");
  }
  /// Throws Error(system_failure). Its text contains `what`, and the advice that all ranks must run the same program.
  [[noreturn]] void refuse(std::string_view what) const;

 protected:
  RecordReader(std::span<const std::byte> bytes, int from) : left_(bytes), from_(from) {}

 private:
  [[noreturn]] void refuse_short() const;

  std::span<const std::byte> left_;
  int from_ = -1;  ///< the sending rank, if known
};

/// Reads a message that came from rank `from`. If the message is malformed, throws Error(system_failure) that describes
/// the fault, names the sending rank, and advises that all ranks must run the same program. The bytes must outlive the
/// reader.
class MessageReader : public RecordReader {
 public:
  /// Accepts a message of any kind.
  MessageReader(std::span<const std::byte> message, int from);
  /// Accepts only messages of kind `awaited`.
  MessageReader(std::span<const std::byte> message, int from, MessageKind awaited);
  MessageReader(const Message& message, MessageKind awaited) : MessageReader(message.bytes, message.from, awaited) {}

  [[nodiscard]] MessageKind kind() const { return kind_; }
  /// Throws Error(system_failure) because a message of this kind is not expected here.
  [[noreturn]] void refuse_kind() const;

 private:
  MessageKind kind_;
};

/// Returns the value of a message that contains only one value.
template <class Value>
Value value_of(std::span<const std::byte> message, int from, MessageKind kind) {
  MessageReader reader(message, from, kind);
  const auto value = reader.take<Value>();
  reader.finish();
  return value;
}

}  // namespace tessera::exchange
