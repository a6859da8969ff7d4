// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "reference/curved/curved_integral.hpp"
#include "reference/smooth_scalar.hpp"
#include "scene/error.hpp"

namespace tessera::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_lengths(const CurvedCells& cells) {
  const std::size_t count = cells.types.size();
  const auto check = [](const char* name, std::size_t found, std::size_t wanted) {
    if (found != wanted)
      throw scene::bad_input(
          fmt::format("curved cells: {} {} where {} are needed; give one for each", found, name, wanted));
  };
  check("offsets", cells.offsets.size(), count + 1);
  const bool of_cells = cells.association == Association::cell;
  check("scalars", cells.scalars.size(), of_cells ? count : cells.positions.size());
  if (!cells.degrees.empty()) check("higher-order degrees", cells.degrees.size(), count);
  for (std::size_t c = 0; c < count; ++c)
    if (cells.offsets[c + 1] < cells.offsets[c] || cells.offsets[c + 1] > cells.connectivity.size())
      throw scene::bad_input(
          fmt::format("curved cells: cell {} ends at {}, not between its begin {} and {}; give offsets "
                      "that do not decrease",
                      c, cells.offsets[c + 1], cells.offsets[c], cells.connectivity.size()));
}

std::span<const std::uint32_t> nodes_of(const CurvedCells& cells, std::size_t cell) {
  return cells.connectivity.subspan(cells.offsets[cell], cells.offsets[cell + 1] - cells.offsets[cell]);
}

void check_nodes(const CurvedCells& cells, std::size_t cell) {
  for (const std::uint32_t node : nodes_of(cells, cell)) {
    if (node >= cells.positions.size())
      throw scene::bad_input(
          fmt::format("curved cells: cell {} uses point {}, but there are only {} points; write all points", cell, node,
                      cells.positions.size()));
    const bool of_points = cells.association == Association::point;
    if (!finite(cells.positions[node]) || (of_points && !std::isfinite(cells.scalars[node])))
      throw scene::bad_input(
          fmt::format("curved cells: point {} of cell {} is not finite; leave the cell out", node, cell));
  }
  if (cells.association == Association::cell && !std::isfinite(cells.scalars[cell]))
    throw scene::bad_input(fmt::format("curved cells: the scalar of cell {} is not finite; leave the cell out", cell));
}

}  // namespace

CurvedReference::CurvedReference(const CurvedCells& cells, const scene::Camera& camera, scene::ImageSize size,
                                 const scene::TransferFunction& transfer_function, scene::Emission emission)
    : size_((scene::validate(camera), scene::validate(size), size)),
      knots_(transfer_function.knots().begin(), transfer_function.knots().end()),
      emission_(emission),
      view_(camera, size) {
  if (knots_.empty()) throw scene::bad_input("transfer function: no knots; give at least one");
  check_lengths(cells);
  std::map<std::tuple<std::uint8_t, std::size_t, std::array<int, 3>>, std::size_t> known;
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    if (without_volume(cells.types[c])) continue;
    check_nodes(cells, c);
    const std::size_t nodes = nodes_of(cells, c).size();
    const std::array<int, 3> orders = cells.degrees.empty() ? std::array{0, 0, 0} : cells.degrees[c];
    const auto [found, is_new] = known.try_emplace({cells.types[c], nodes, orders}, shapes_.size());
    if (is_new) shapes_.push_back(cell_shape(cells.types[c], nodes, orders, fmt::format("curved cells: cell {}", c)));
    add_cell(cells, c, found->second);
  }
}

void CurvedReference::add_cell(const CurvedCells& cells, std::size_t index, std::size_t shape) {
  const Matrix& to_bernstein = shapes_[shape].to_bernstein;
  const std::span<const std::uint32_t> nodes = nodes_of(cells, index);
  Cell cell{shape, index, {}, {}, 0, 0, infinity, infinity, -infinity, -infinity};
  const bool of_points = cells.association == Association::point;
  cell.origin = cells.scalars[of_points ? nodes.front() : index];
  cell.control.resize(to_bernstein.rows);
  cell.field.resize(to_bernstein.rows);
  // Control points are computed from differences to a node, so that a value common to all nodes is exact at all of
  // them.
  const glm::dvec3 from = cells.positions[nodes.front()];
  for (std::size_t row = 0; row < to_bernstein.rows; ++row) {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      sum += to_bernstein(row, node) * (cells.positions[nodes[node]] - from);
      if (of_points) cell.field[row] += to_bernstein(row, node) * (cells.scalars[nodes[node]] - cell.origin);
    }
    cell.control[row] = from + sum;
    cell.change = std::max(cell.change, std::abs(cell.field[row]));
  }
  if (!(cell.change > 0)) cell.field.clear();
  bound(cell);
  cells_.push_back(std::move(cell));
}

void CurvedReference::bound(Cell& cell) const {
  double least_w = infinity, largest_w = 0, deepest = -infinity;
  for (const glm::dvec3& p : cell.control) {
    const ProjectedVertex v = view_.project(p);
    const glm::dvec3& h = v.homogeneous;
    least_w = std::min(least_w, h.z);
    largest_w = std::max(largest_w, std::abs(h.z));
    deepest = std::max(deepest, v.depth);
    cell.x_low = std::min(cell.x_low, h.x / h.z), cell.x_high = std::max(cell.x_high, h.x / h.z);
    cell.y_low = std::min(cell.y_low, h.y / h.z), cell.y_high = std::max(cell.y_high, h.y / h.z);
  }
  if (!(deepest > 0)) {  // the cell is behind the eye
    cell.x_low = cell.y_low = infinity;
    cell.x_high = cell.y_high = -infinity;
  } else if (!(least_w > 1e-6 * largest_w)) {  // the cell is at or across the plane of the eye
    cell.x_low = cell.y_low = -infinity;
    cell.x_high = cell.y_high = infinity;
  } else {  // the quotients are rounded; the margin is larger than the rounding
    const double x_margin = 1e-7 + 1e-9 * std::max(std::abs(cell.x_low), std::abs(cell.x_high));
    const double y_margin = 1e-7 + 1e-9 * std::max(std::abs(cell.y_low), std::abs(cell.y_high));
    cell.x_low -= x_margin, cell.x_high += x_margin;
    cell.y_low -= y_margin, cell.y_high += y_margin;
  }
}

CurvedReference::Frame CurvedReference::frame(double x, double y) const {
  Frame frame{view_.ray(x, y), glm::dvec3(0), glm::dvec3(0), view_.length_per_depth(x, y)};
  const glm::dvec3 along = glm::normalize(frame.ray.step), size = glm::abs(along);
  glm::dvec3 other(0);  // unit vector of the axis along which the ray has its smallest component
  other[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
  frame.across_x = glm::normalize(glm::cross(along, other));
  frame.across_y = glm::cross(along, frame.across_x);
  return frame;
}

CellOnRay CurvedReference::on_ray(const Cell& cell, const Frame& frame, std::vector<glm::dvec3>& control) const {
  const glm::dvec3 depth = frame.ray.step / glm::dot(frame.ray.step, frame.ray.step);
  control.clear();
  glm::dvec3 low(infinity), high(-infinity);
  double farthest = 0;
  for (const glm::dvec3& p : cell.control) {
    const glm::dvec3 from_eye = p - frame.ray.origin;
    control.emplace_back(glm::dot(frame.across_x, from_eye), glm::dot(frame.across_y, from_eye),
                         glm::dot(depth, from_eye));
    low = glm::min(low, control.back()), high = glm::max(high, control.back());
    farthest = std::max(farthest, glm::length(from_eye));
  }
  const glm::dvec3 sides = high - low;
  const double size = std::max({sides.x, sides.y, sides.z});
  // Distances from the eye have a relative rounding error of 1e-16. The tolerances of 1e-14 of the size must cover it.
  constexpr double size_share = 0.05, rounding_share = 0.25;
  const double rounding = size > 0 ? std::max(1.0, rounding_share * farthest / size) : 1;
  return {&shapes_[cell.shape].basis, control, cell.field, std::max(size, size_share * farthest), rounding};
}

std::vector<CurvedReference::Met> CurvedReference::met(double x, double y,
                                                       std::vector<std::vector<glm::dvec3>>& controls) const {
  const Frame frame = this->frame(x, y);
  std::vector<Met> result;
  std::vector<Crossing> crossings;
  for (const Cell& cell : cells_) {
    if (!(cell.x_low <= x && x <= cell.x_high && cell.y_low <= y && y <= cell.y_high)) continue;
    std::vector<glm::dvec3> control;
    const CellOnRay on_ray = this->on_ray(cell, frame, control);
    controls.push_back(std::move(control));  // moving the vector does not move its elements, to which `on_ray` refers
    crossings.clear();
    for (const FacePatch& face : shapes_[cell.shape].faces) find_crossings(on_ray, face, crossings);
    for (InnerPath& path : inner_paths(on_ray, crossings)) {
      const double front = std::max(path.front(), view_.nearest()), back = std::min(path.back(), view_.farthest());
      if (!(front < back)) continue;
      const CurvedSegment segment{front, back, (back - front) * frame.length_per_depth, cell.index};
      result.push_back({segment, std::move(path), &cell});
    }
  }
  std::sort(result.begin(), result.end(), [](const Met& a, const Met& b) {
    return std::tie(a.segment.front, a.segment.back, a.segment.cell) <
           std::tie(b.segment.front, b.segment.back, b.segment.cell);
  });
  return result;
}

std::vector<CurvedSegment> CurvedReference::segments(double x, double y) const {
  std::vector<std::vector<glm::dvec3>> controls;
  std::vector<CurvedSegment> result;
  for (const Met& one : met(x, y, controls)) result.push_back(one.segment);
  return result;
}

Pixel CurvedReference::pixel(double x, double y) const {
  std::vector<std::vector<glm::dvec3>> controls;
  CurvedIntegral integral(knots_, emission_);
  Pixel pixel;
  const double length_per_depth = view_.length_per_depth(x, y);
  for (Met& one : met(x, y, controls)) {
    const double front = one.segment.front, back = one.segment.back;
    if (one.cell->field.empty()) {
      integral.add(SmoothScalar(front, back, 0), length_per_depth, one.cell->origin);
    } else {
      InnerPath& path = one.path;
      const auto scalar = [&path](double depth) { return field_of(path.cell(), path.place(depth), path.room()); };
      for (const SmoothScalar& piece : smooth_pieces(front, back, one.cell->change * path.cell().rounding, scalar))
        integral.add(piece, length_per_depth, one.cell->origin);
    }
    pixel.length += one.segment.length;
    ++pixel.segments;
  }
  std::tie(pixel.r, pixel.g, pixel.b) = std::tuple_cat(integral.color());
  pixel.a = integral.opacity();
  pixel.z = integral.first_visible_depth();
  return pixel;
}

}  // namespace tessera::reference
