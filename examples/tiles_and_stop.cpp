// SPDX-License-Identifier: BSD-3-Clause
// A file's tiles as they are finished; the frame is ended half way, then rendered whole: tiles_and_stop FILE
#include <iostream>

#include "tessera/tessera.hpp"

/// A client that requests a stop after it has received `wanted` pixels.
class Client : public tessera::Sink {
 public:
  explicit Client(long wanted) : wanted_(wanted) {}
  void tile(const tessera::Tile& tile) override {
    pixels += tile.rect.area();  // a real client would send the pixels here
    ++tiles;
    if (pixels >= wanted_) gone.request_stop();
  }
  std::stop_source gone;
  long pixels = 0;
  int tiles = 0;

 private:
  long wanted_;
};

int main(int argc, char** argv) try {
  if (argc != 2) throw tessera::Error(tessera::ErrorCode::bad_input, "arguments: name one mesh or grid");
  const tessera::Dataset data = tessera::Dataset::open(argv[1]);
  const tessera::View view = data.default_view({800, 600});
  const tessera::TransferFunction function = data.transfer_function().function;
  tessera::Session session(data);
  for (const long wanted : {240'000L, 1'000'000L}) {
    Client client(wanted);
    const auto frame = session.render(view, function, {}, &client, client.gone.get_token());
    std::cout << client.tiles << " tiles, " << client.pixels << " pixels: " << (frame.stopped ? "stopped" : "whole")
              << '\n';
  }
} catch (const tessera::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
