// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "exchange/message.hpp"

/// Collective operations. Every rank calls these in the same order (channel `agreement`), with a message of the same
/// kind. A rank that is at a different point of the program is detected by the kind of its message, and ends the run.
namespace tessera::exchange {

/// Returns the message of rank `root` on every rank; the messages of other ranks are ignored.
Bytes broadcast(Transport& transport, int root, Bytes message);

/// Returns every rank's message, in rank order, on every rank.
std::vector<Bytes> gather_all(Transport& transport, Bytes message);

/// Returns when all ranks have called it.
void barrier(Transport& transport);

/// Returns the value of rank `root` on every rank.
template <class Value>
Value broadcast_value(Transport& transport, int root, MessageKind kind, const Value& value) {
  return value_of<Value>(broadcast(transport, root, message_of(kind, value)), root, kind);
}

/// Returns every rank's value, in rank order, on every rank.
template <class Value>
std::vector<Value> gather_values(Transport& transport, MessageKind kind, const Value& value) {
  std::vector<Value> values;
  for (const Bytes& message : gather_all(transport, message_of(kind, value)))
    values.push_back(value_of<Value>(message, static_cast<int>(values.size()), kind));
  return values;
}

}  // namespace tessera::exchange
