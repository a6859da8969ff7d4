// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "exchange/message.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "scene/grid.hpp"

/// Messages shared by the descriptions of data sets.
namespace tessera::frame {

/// Appends texts in the format: u64 count, texts.
void append_texts(exchange::Bytes& message, const std::vector<std::string>& texts);
std::vector<std::string> take_texts(exchange::MessageReader& reader);

scene::Association take_association(exchange::MessageReader& reader);

/// Appends a field in the format: text name, u8 association, i32 components, text type, f64 low, high, u64 nan_count,
/// u8 active, u8 ids.
void append_field(exchange::Bytes& message, const cells::FieldSummary& field);
cells::FieldSummary take_field(exchange::MessageReader& reader);

/// Appends fields in the format: u64 count, fields.
void append_fields(exchange::Bytes& message, const std::vector<cells::FieldSummary>& fields);
std::vector<cells::FieldSummary> take_fields(exchange::MessageReader& reader);

/// Appends a time step in the format: u64 steps, u64 step, list of f64 times.
void append_time_step(exchange::Bytes& message, const scene::TimeStepRead& read);
scene::TimeStepRead take_time_step(exchange::MessageReader& reader);

}  // namespace tessera::frame
