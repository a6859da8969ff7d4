// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/unv_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "io/files/whole_file.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Reads a universal file line by line.
class Universal {
 public:
  Universal(std::string_view text, std::string source) : text_(text), source_(std::move(source)) {}

  void check() {
    while (next()) {
      if (!is_mark() || !next()) continue;
      if (is_mark() && !next()) break;  // if there are two marks, the first ends a dataset
      const long dataset = whole_numbers<1>()[0];
      known_.insert(dataset);
      while (next() && !is_mark()) read_record(dataset);
    }
    require_new_datasets();
    for (const auto& [system, point] : points_in_)
      if (const auto what = other_systems_.find(system); what != other_systems_.end())
        throw scene::bad_input(fmt::format(
            "{}: point {} is in the coordinate system {}, which is {}; export points in the global coordinate system",
            source_, point, system, what->second));
  }

 private:
  bool next() {
    if (std::exchange(is_again_, false)) return true;
    if (text_.empty()) return false;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line_ = std::string(text_.substr(0, std::min<std::size_t>(end, 200)));
    text_.remove_prefix(std::min(end + 1, text_.size()));
    return true;
  }

  [[nodiscard]] bool is_mark() const { return line_.starts_with("    -1"); }

  template <std::size_t count>
  [[nodiscard]] std::array<long, count> whole_numbers() const {
    std::array<long, count> numbers{};
    const char* at = line_.c_str();
    for (long& number : numbers) {
      char* end = nullptr;
      number = std::strtol(at, &end, 10);
      at = end;
    }
    return numbers;
  }

  void read_record(long dataset) {
    if (dataset == 2411) {
      const auto [point, system] = whole_numbers<2>();
      points_in_.emplace(system, point);
      next();
    } else if (dataset == 2412) {
      read_element();
    } else if (dataset == 2420) {
      read_systems();
    }
  }

  void read_element() {
    const auto [element, type, physical, material, color, nodes] = whole_numbers<6>();
    static constexpr std::array<long, 7> beams = {11, 21, 22, 23, 24, 31, 32};
    static constexpr std::array<std::pair<long, const char*>, 4> cubic = {
        {{103, "thick shell wedge"}, {106, "thick shell brick"}, {114, "wedge"}, {117, "brick"}}};
    for (const auto& [number, name] : cubic)
      if (type == number)
        throw scene::bad_input(
            fmt::format("{}: element {} is a cubic {} (type {}), which Gmsh's library does not support; export "
                        "elements of first or second order",
                        source_, element, name, type));
    if (std::ranges::count(beams, type) > 0) next();
    for (long k = 0; k < nodes && next(); k += 8) {
    }
  }

  /// Reads coordinate systems. Must be called after reading the part's number; the part's name follows, then all
  /// systems up to the end of the dataset.
  void read_systems() {
    next();
    while (next() && !is_mark()) {
      const auto [system, type] = whole_numbers<2>();
      next();  // its name
      bool is_global = true;
      for (std::size_t row = 0; row < 4 && next() && !is_mark(); ++row) {
        std::ranges::replace(line_, 'D', 'E');
        std::array<double, 3> axis{};
        std::sscanf(line_.c_str(), "%lf %lf %lf", &axis[0], &axis[1], &axis[2]);
        for (std::size_t a = 0; a < 3; ++a) is_global = is_global && axis[a] == (a == row ? 1 : 0);
      }
      if (type != 0)
        other_systems_[system] = type == 1 ? "cylindrical" : "spherical";
      else if (!is_global)
        other_systems_[system] = "rotated or moved";
      if (is_mark()) break;
    }
    is_again_ = is_mark();
  }

  void require_new_datasets() const {
    for (const auto& [old_datasets, now, what] :
         {std::tuple(std::array{15L, 781L}, 2411L, "nodes"), std::tuple(std::array{71L, 780L}, 2412L, "elements")})
      for (const long old : old_datasets)
        if (known_.contains(old) && !known_.contains(now))
          throw scene::bad_input(
              fmt::format("{}: its {} are in dataset {}, which older versions wrote, but Gmsh's library reads only "
                          "dataset {}; export it with a newer version, or in another format",
                          source_, what, old, now));
  }

  std::string_view text_;
  std::string source_, line_;
  bool is_again_ = false;  ///< next() returns this line again
  std::set<long> known_;
  std::map<long, long> points_in_;             ///< for each coordinate system, one of its points
  std::map<long, std::string> other_systems_;  ///< systems other than the global one, with a description
};

}  // namespace

void require_read_unv(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  Universal(mapped.text(), file.string()).check();
}

}  // namespace tessera::readers
