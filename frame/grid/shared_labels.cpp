// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/shared_labels.hpp"

#include "exchange/collectives.hpp"
#include "exchange/message.hpp"

namespace tessera::frame {

scene::LabelValues shared_labels(exchange::Transport& transport, const scene::SampleSource& source, bool stated) {
  if (transport.size() == 1) return scene::label_values(source, stated);
  exchange::Bytes message = exchange::begin_message(exchange::MessageKind::volume_labels);
  if (transport.rank() == 0) {
    const scene::LabelValues own = scene::label_values(source, stated);
    exchange::append(message, static_cast<std::uint8_t>(own.are_labels));
    exchange::append_list(message, own.values);
  }
  const exchange::Bytes common = exchange::broadcast(transport, 0, std::move(message));
  exchange::MessageReader reader(common, 0, exchange::MessageKind::volume_labels);
  scene::LabelValues labels;
  labels.are_labels = reader.take<std::uint8_t>() != 0;
  labels.values = reader.take_list<double>();
  reader.finish();
  return labels;
}

}  // namespace tessera::frame
