// SPDX-License-Identifier: BSD-3-Clause
#include "api/input_file.hpp"

#include <algorithm>
#include <numeric>

#include "api/dataset.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "system/missing_file.hpp"
#include "tessera/time_series.hpp"

namespace tessera {
inline namespace v0_1 {

namespace {

bool is_there_now(const std::filesystem::path& path) {
  std::error_code unreadable;
  return std::filesystem::exists(path, unreadable) || unreadable;
}

}  // namespace

InputFile::Found::Found(const std::filesystem::path& path)
    : is_there(is_there_now(path) || is_time_series(path)),
      file(is_there ? frame::identify_input(path) : io::identify_by_name(path)) {}

bool InputFile::Found::is_volume() const {
  std::call_once(once_, [&] { is_volume_ = io::is_volume(file); });
  return is_volume_;
}

InputFile::InputFile(const std::filesystem::path& file) : found_(std::make_shared<const Found>(file)) {}
const std::filesystem::path& InputFile::path() const { return found_->file.path; }
bool InputFile::opens_as_grid(const ReadOptions& options) const { return !options.grid_as_mesh && found_->is_volume(); }
bool InputFile::opens_as_mesh() const { return io::is_mesh(found_->file); }

std::size_t time_steps_of(const std::filesystem::path& file, const ReadOptions& options) {
  return times_of(file, options).size();
}

std::vector<double> times_of(const std::filesystem::path& file, const ReadOptions& options) {
  return times_of(InputFile(file), options);
}

std::vector<double> times_of(const InputFile& input, const ReadOptions& options) {
  const io::InputFile& file = StateAccess::of(input).file;
  if (!StateAccess::of(input).is_there) throw system::missing_file(file.path);
  const scene::TimeStepRead read = input.opens_as_grid(options) ? io::open_unscanned_volume(file, options).time_step
                                                                : io::time_steps_of_mesh(file, options);
  if (!read.times.empty()) return read.times;
  std::vector<double> numbers(std::max<std::size_t>(read.count, 1));
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return numbers;
}

}  // namespace v0_1
}  // namespace tessera
