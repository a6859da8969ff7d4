// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/field_message.hpp"

namespace tessera::frame {

using exchange::append;
using exchange::append_text;
using exchange::Bytes;
using exchange::MessageReader;

void append_texts(Bytes& message, const std::vector<std::string>& texts) {
  append(message, std::uint64_t{texts.size()});
  for (const std::string& text : texts) append_text(message, text);
}

std::vector<std::string> take_texts(MessageReader& reader) {
  std::vector<std::string> texts;
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) texts.push_back(reader.take_text());
  return texts;
}

scene::Association take_association(MessageReader& reader) {
  return reader.take<std::uint8_t>() == 0 ? scene::Association::point : scene::Association::cell;
}

void append_field(Bytes& message, const cells::FieldSummary& f) {
  append_text(message, f.name);
  append(message, static_cast<std::uint8_t>(f.association));
  append(message, std::int32_t{f.components});
  append_text(message, f.type);
  append(message, f.low);
  append(message, f.high);
  append(message, f.nan_count);
  append(message, std::uint8_t{f.active});
  append(message, std::uint8_t{f.ids});
  append(message, std::uint8_t{f.fractions});
}

cells::FieldSummary take_field(MessageReader& reader) {
  cells::FieldSummary f;
  f.name = reader.take_text();
  f.association = take_association(reader);
  f.components = reader.take<std::int32_t>();
  f.type = reader.take_text();
  f.low = reader.take<double>();
  f.high = reader.take<double>();
  f.nan_count = reader.take<std::uint64_t>();
  f.active = reader.take<std::uint8_t>() != 0;
  f.ids = reader.take<std::uint8_t>() != 0;
  f.fractions = reader.take<std::uint8_t>() != 0;
  return f;
}

void append_fields(Bytes& message, const std::vector<cells::FieldSummary>& fields) {
  append(message, std::uint64_t{fields.size()});
  for (const cells::FieldSummary& field : fields) append_field(message, field);
}

std::vector<cells::FieldSummary> take_fields(MessageReader& reader) {
  std::vector<cells::FieldSummary> fields;
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) fields.push_back(take_field(reader));
  return fields;
}

void append_time_step(Bytes& message, const scene::TimeStepRead& read) {
  append(message, read.count);
  append(message, read.step);
  exchange::append_list(message, read.times);
}

scene::TimeStepRead take_time_step(MessageReader& reader) {
  scene::TimeStepRead read;
  read.count = reader.take<std::uint64_t>();
  read.step = reader.take<std::uint64_t>();
  read.times = reader.take_list<double>();
  return read;
}

}  // namespace tessera::frame
