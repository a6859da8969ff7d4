// SPDX-License-Identifier: BSD-3-Clause
// The picture that `tessera render FILE --config STATE.toml -o picture.png` makes: picture_of_state FILE STATE.json
#include <filesystem>
#include <iostream>

#include "tessera/tessera.hpp"

int main(int argc, char** argv) try {
  if (argc != 3) throw tessera::bad_input("arguments: give a mesh or a grid, and a state as JSON or TOML");
  const std::filesystem::path files[] = {argv[1]}, name = argv[2];
  const std::string text = tessera::read_text(name);
  const tessera::State state = name.extension() == ".toml" ? tessera::State::from_toml(text, name.string())
                                                           : tessera::State::from_json(text, name.string());
  const tessera::Dataset data = state.open(files);
  const tessera::View view = state.view(data);
  const tessera::LoadedTransferFunction loaded = state.transfer_function(data);

  auto frame = tessera::Session(data, state.settings(data)).render(view, loaded.function);
  tessera::annotate(frame.image, state.annotation(data), view, data.bounds(), loaded.function);
  tessera::write_image(frame.image, "picture.png", state.image_file_options());
  std::cout << "picture.png\n";
} catch (const tessera::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
