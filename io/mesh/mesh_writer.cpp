// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io/mesh/mesh_reader.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

/// Converts a double to the format's float32. NaN and infinity, which readers treat as blank, are preserved.
float to_float(double value, const std::string& file) {
  if (std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max())
    throw scene::bad_input(
        fmt::format("{}: {} does not fit the float32 of .tets; write .vtu, which holds doubles", file, value));
  return static_cast<float>(value);
}

/// Collects small pieces so that there are few writes to the file.
class Chunks {
 public:
  explicit Chunks(system::AtomicFile& file) : file_(file) {}
  template <class T>
  void put(T value) {
    if (used_ + sizeof value > buffer_.size()) flush();
    std::copy_n(reinterpret_cast<const std::byte*>(&value), sizeof value, buffer_.data() + used_);
    used_ += sizeof value;
  }
  void flush() {
    file_.write(buffer_.data(), used_);
    used_ = 0;
  }

 private:
  system::AtomicFile& file_;
  std::vector<std::byte> buffer_ = std::vector<std::byte>(1 << 20);
  std::size_t used_ = 0;
};

}  // namespace

void write_tets(const scene::TetMeshView& mesh, const std::filesystem::path& file) {
  const std::string target = file.string();
  if (mesh.association == scene::Association::cell)
    throw scene::bad_input(fmt::format(
        "{}: .tets stores point data only, but '{}' is cell data; write .vtu, or smooth it", target, mesh.field_name));
  if (mesh.positions.size() > static_cast<std::size_t>(INT32_MAX))
    throw scene::bad_input(fmt::format("{}: {} points are too many for the int32 indices of .tets; write .vtu", target,
                                       mesh.positions.size()));
  system::AtomicFile out(file);
  Chunks chunks(out);
  chunks.put(static_cast<std::int64_t>(mesh.positions.size()));
  chunks.put(static_cast<std::int64_t>(mesh.tets.size()));
  for (const glm::dvec3& p : mesh.positions)
    for (int k = 0; k < 3; ++k) chunks.put(to_float(p[k], target));
  for (const double s : mesh.scalars) chunks.put(to_float(s, target));
  for (const scene::Tet& tet : mesh.tets)
    for (const std::uint32_t v : tet) chunks.put(static_cast<std::int32_t>(v));
  chunks.flush();
  out.commit();
}

}  // namespace tessera::io
