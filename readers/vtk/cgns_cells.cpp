// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/cgns_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "cells/curved/node_orders.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

using ElementType = CGNS_ENUMT(ElementType_t);

/// Returns the node order of a supported three-dimensional element; null for others.
const cells::NodeOrder* order_of(ElementType type) {
  struct Solid {
    ElementType type;
    cells::CurvedFamily shape;
    std::size_t nodes;
  };
  constexpr std::array solids = {
      Solid{CGNS_ENUMV(TETRA_4), cells::CurvedFamily::tet, 4},
      Solid{CGNS_ENUMV(TETRA_10), cells::CurvedFamily::tet, 10},
      Solid{CGNS_ENUMV(TETRA_16), cells::CurvedFamily::tet, 16},
      Solid{CGNS_ENUMV(TETRA_20), cells::CurvedFamily::tet, 20},
      Solid{CGNS_ENUMV(PYRA_5), cells::CurvedFamily::pyramid, 5},
      Solid{CGNS_ENUMV(PYRA_13), cells::CurvedFamily::pyramid, 13},
      Solid{CGNS_ENUMV(PYRA_14), cells::CurvedFamily::pyramid, 14},
      Solid{CGNS_ENUMV(PYRA_21), cells::CurvedFamily::pyramid, 21},
      Solid{CGNS_ENUMV(PYRA_29), cells::CurvedFamily::pyramid, 29},
      Solid{CGNS_ENUMV(PYRA_30), cells::CurvedFamily::pyramid, 30},
      Solid{CGNS_ENUMV(PENTA_6), cells::CurvedFamily::wedge, 6},
      Solid{CGNS_ENUMV(PENTA_15), cells::CurvedFamily::wedge, 15},
      Solid{CGNS_ENUMV(PENTA_18), cells::CurvedFamily::wedge, 18},
      Solid{CGNS_ENUMV(PENTA_24), cells::CurvedFamily::wedge, 24},
      Solid{CGNS_ENUMV(PENTA_38), cells::CurvedFamily::wedge, 38},
      Solid{CGNS_ENUMV(PENTA_40), cells::CurvedFamily::wedge, 40},
      Solid{CGNS_ENUMV(HEXA_8), cells::CurvedFamily::hexahedron, 8},
      Solid{CGNS_ENUMV(HEXA_20), cells::CurvedFamily::hexahedron, 20},
      Solid{CGNS_ENUMV(HEXA_27), cells::CurvedFamily::hexahedron, 27},
      Solid{CGNS_ENUMV(HEXA_32), cells::CurvedFamily::hexahedron, 32},
      Solid{CGNS_ENUMV(HEXA_56), cells::CurvedFamily::hexahedron, 56},
      Solid{CGNS_ENUMV(HEXA_64), cells::CurvedFamily::hexahedron, 64},
  };
  const auto* const found = std::ranges::find(solids, type, &Solid::type);
  return found == solids.end() ? nullptr
                               : cells::find_node_order(cells::NodeConvention::cgns, found->shape, found->nodes);
}

/// Returns the number of corners of a face; 0 if the type is not a face.
int corners_of_face(ElementType type) {
  switch (type) {
    case CGNS_ENUMV(TRI_3):
    case CGNS_ENUMV(TRI_6):
    case CGNS_ENUMV(TRI_9):
    case CGNS_ENUMV(TRI_10):
      return 3;
    case CGNS_ENUMV(QUAD_4):
    case CGNS_ENUMV(QUAD_8):
    case CGNS_ENUMV(QUAD_9):
    case CGNS_ENUMV(QUAD_12):
    case CGNS_ENUMV(QUAD_16):
      return 4;
    default:
      return 0;
  }
}

/// Whether a type is that of points, lines or faces. Those of low order have the lowest type numbers; those of higher
/// orders have further ranges of numbers.
bool is_below_three(ElementType type) {
  return type <= CGNS_ENUMV(QUAD_9) || corners_of_face(type) > 0 ||
         (type >= CGNS_ENUMV(BAR_4) && type <= CGNS_ENUMV(QUAD_16)) || type == CGNS_ENUMV(BAR_5) ||
         (type >= CGNS_ENUMV(TRI_12) && type <= CGNS_ENUMV(QUAD_25)) || type == CGNS_ENUMV(NGON_n);
}

/// Description of a section of elements by the library.
struct Section {
  int number = 0;
  std::string name{};
  ElementType type{};
  cgsize_t first = 0, last = 0;  ///< numbers of the section's first and last element
  bool has_parents = false;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(last - first + 1); }
};

std::vector<Section> sections_of(const CgnsZone& zone) {
  int count = 0;
  require_cgns(cg_nsections(zone.file, zone.base, zone.zone, &count), zone);
  std::vector<Section> sections;
  for (int k = 1; k <= count; ++k) {
    Section section{.number = k};
    std::array<char, 34> name{};
    int boundary = 0, parents = 0;
    require_cgns(cg_section_read(zone.file, zone.base, zone.zone, k, name.data(), &section.type, &section.first,
                                 &section.last, &boundary, &parents),
                 zone);
    section.name = name.data();
    section.has_parents = parents != 0;
    if (section.first < 1 || section.last < section.first)
      throw scene::bad_input(
          fmt::format("{}: section '{}' has the elements {} to {}; the file is damaged, export it "
                      "again",
                      zone.where, section.name, section.first, section.last));
    sections.push_back(std::move(section));
  }
  return sections;
}

/// The numbers in a section: nodes, or, for NFACE_n, faces. Those of element k are from offsets[k] to offsets[k + 1].
/// The numbers of an element of a MIXED section begin with its type.
struct Elements {
  std::vector<cgsize_t> numbers, offsets, parents;

  [[nodiscard]] std::span<const cgsize_t> of(std::size_t k) const {
    return std::span(numbers).subspan(static_cast<std::size_t>(offsets[k]),
                                      static_cast<std::size_t>(offsets[k + 1] - offsets[k]));
  }
};

[[noreturn]] void refuse(const CgnsZone& zone, const Section& section, const std::string& what) {
  throw scene::bad_input(fmt::format("{}: section '{}' {}", zone.where, section.name, what));
}

Elements elements_of(const CgnsZone& zone, const Section& section) {
  Elements elements;
  cgsize_t size = 0;
  require_cgns(cg_ElementDataSize(zone.file, zone.base, zone.zone, section.number, &size), zone);
  if (size < 0 || section.count() > static_cast<std::size_t>(size))
    refuse(zone, section,
           fmt::format("has {} elements of {} numbers; the file is damaged, export it again", section.count(), size));
  elements.numbers.resize(static_cast<std::size_t>(size));
  if (section.has_parents) elements.parents.resize(4 * section.count());
  cgsize_t* const parents = section.has_parents ? elements.parents.data() : nullptr;
  const bool has_lengths =
      section.type == CGNS_ENUMV(MIXED) || section.type == CGNS_ENUMV(NGON_n) || section.type == CGNS_ENUMV(NFACE_n);
  if (has_lengths) {
    elements.offsets.resize(section.count() + 1);
    require_cgns(cg_poly_elements_read(zone.file, zone.base, zone.zone, section.number, elements.numbers.data(),
                                       elements.offsets.data(), parents),
                 zone);
  } else {
    require_cgns(cg_elements_read(zone.file, zone.base, zone.zone, section.number, elements.numbers.data(), parents),
                 zone);
    const cgsize_t nodes = size / static_cast<cgsize_t>(section.count());
    for (std::size_t k = 0; k <= section.count(); ++k) elements.offsets.push_back(static_cast<cgsize_t>(k) * nodes);
  }
  for (std::size_t k = 0; k < section.count(); ++k)
    if (elements.offsets[0] < 0 || elements.offsets[k + 1] < elements.offsets[k] || elements.offsets[k + 1] > size)
      refuse(zone, section, "has offsets that do not fit its elements; the file is damaged, export it again");
  return elements;
}

/// Reads the sections in the order of their elements' numbers, and adds the cells.
class Cells {
 public:
  Cells(const CgnsZone& zone, cells::CellBlock& block) : zone_(zone), block_(block), sections_(sections_of(zone)) {
    std::ranges::sort(sections_, {}, &Section::first);
    for (std::size_t k = 0; k + 1 < sections_.size(); ++k)
      if (sections_[k + 1].first <= sections_[k].last)
        refuse(zone_, sections_[k + 1],
               fmt::format("repeats the number {} of section '{}'; export the file again", sections_[k + 1].first,
                           sections_[k].name));
    block_.offsets.assign(1, 0);
  }

  void add_all() {
    const bool has_polyhedra = std::ranges::any_of(sections_, &Cells::is_of_polyhedra);
    if (has_polyhedra) read_faces();
    for (const Section& section : sections_) add_section(section);
    if (has_polyhedra && block_.types.empty()) add_parents();
    if (block_.faces.empty()) return;
    block_.face_locations.resize(block_.types.size(), cells::CellBlock::no_faces);
  }

 private:
  using Face = std::span<const cgsize_t>;

  struct FaceSection {
    Section section;
    Elements elements;
  };

  static bool is_of_polyhedra(const Section& section) {
    return section.type == CGNS_ENUMV(NFACE_n) || section.type == CGNS_ENUMV(NGON_n);
  }

  void read_faces() {
    for (const Section& section : sections_)
      if (section.type == CGNS_ENUMV(NGON_n) || corners_of_face(section.type) > 0)
        faces_.push_back({section, elements_of(zone_, section)});
  }

  /// Returns a face; no value if it does not exist.
  [[nodiscard]] std::optional<Face> face(cgsize_t number) const {
    for (const FaceSection& of : faces_) {
      if (number < of.section.first || number > of.section.last) continue;
      const Face nodes = of.elements.of(static_cast<std::size_t>(number - of.section.first));
      const int corners = corners_of_face(of.section.type);
      return corners > 0 ? nodes.first(std::min<std::size_t>(static_cast<std::size_t>(corners), nodes.size())) : nodes;
    }
    return std::nullopt;
  }

  static std::uint32_t point(cgsize_t node) {
    return node < 1 || node > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(node - 1);
  }

  void add_solid(ElementType type, Face nodes, const Section& section) {
    const cells::NodeOrder* const solid = order_of(type);
    if (solid == nullptr) {
      if (is_below_three(type)) return;
      refuse(zone_, section,
             fmt::format("has elements {}, which are not supported; export elements of order 1 to 3",
                         cg_ElementTypeName(type)));
    }
    if (nodes.size() < solid->nodes)
      refuse(zone_, section, "has an element with too few nodes; the file is damaged, export it again");
    block_.types.push_back(vtk_number(solid->type));
    for (std::size_t k = 0; k < solid->nodes; ++k)
      block_.connectivity.push_back(point(nodes[solid->from.empty() ? k : solid->from[k]]));
    block_.offsets.push_back(block_.connectivity.size());
  }

  void add_section(const Section& section) {
    if (section.type != CGNS_ENUMV(MIXED) && is_below_three(section.type)) return;
    const Elements elements = elements_of(zone_, section);
    for (std::size_t k = 0; k < section.count(); ++k) {
      const Face numbers = elements.of(k);
      if (section.type == CGNS_ENUMV(NFACE_n)) {
        add_polyhedron(numbers);
      } else if (section.type == CGNS_ENUMV(MIXED)) {
        if (numbers.empty()) refuse(zone_, section, "has an element without a type; the file is damaged, export again");
        add_solid(static_cast<ElementType>(numbers[0]), numbers.subspan(1), section);
      } else {
        add_solid(section.type, numbers, section);
      }
    }
  }

  /// Adds a polyhedron. The sign of a face states its direction in the cell, which is not needed here.
  void add_polyhedron(Face numbers) {
    block_.face_locations.resize(block_.types.size(), cells::CellBlock::no_faces);
    block_.face_locations.push_back(static_cast<std::int64_t>(block_.faces.size()));
    block_.faces.push_back(static_cast<std::uint32_t>(numbers.size()));
    const std::size_t first = block_.connectivity.size();
    for (const cgsize_t number : numbers) {
      const std::optional<Face> nodes = face(std::abs(number));
      if (!nodes)
        throw scene::bad_input(
            fmt::format("{}: a polyhedron uses face {}, which is in no section; the file is damaged, export it again",
                        zone_.where, number));
      block_.faces.push_back(static_cast<std::uint32_t>(nodes->size()));
      for (const cgsize_t node : *nodes) {
        block_.faces.push_back(point(node));
        block_.connectivity.push_back(point(node));
      }
    }
    const auto corners = std::span(block_.connectivity).subspan(first);
    std::ranges::sort(corners);
    const auto repeated = std::ranges::unique(corners);
    block_.connectivity.resize(block_.connectivity.size() - repeated.size());
    block_.types.push_back(vtk_number(CellType::polyhedron));
    block_.offsets.push_back(block_.connectivity.size());
  }

  /// Adds cells that are defined only by the faces between them, in the order of the numbers by which the faces refer
  /// to them.
  void add_parents() {
    std::map<cgsize_t, std::vector<cgsize_t>> cells;
    for (const FaceSection& of : faces_)
      for (std::size_t k = 0; k < 2 * of.section.count() && of.section.has_parents; ++k)
        if (const cgsize_t cell = of.elements.parents[k]; cell > 0)
          cells[cell].push_back(of.section.first + static_cast<cgsize_t>(k % of.section.count()));
    for (const auto& [number, faces] : cells) add_polyhedron(faces);
  }

  const CgnsZone& zone_;
  cells::CellBlock& block_;
  std::vector<Section> sections_;
  std::vector<FaceSection> faces_;
};

}  // namespace

void require_cgns(int status, const CgnsZone& zone) {
  if (status == CG_OK) return;
  const std::string line = printable_ascii(std::string_view(cg_get_error()).substr(0, 160));
  throw scene::bad_input(fmt::format(
      "{}: the CGNS library reports '{}'; the file is truncated or damaged, export it again", zone.where, line));
}

bool is_plain(const CgnsZone& zone) {
  cgsize_t next = 1;
  for (const Section& section : sections_of(zone)) {
    if (section.type == CGNS_ENUMV(MIXED) || section.type == CGNS_ENUMV(NGON_n) || section.type == CGNS_ENUMV(NFACE_n))
      return false;
    if (is_below_three(section.type)) {
      if (section.first <= zone.size[1]) return false;
      continue;
    }
    const cells::NodeOrder* const solid = order_of(section.type);
    // Cells of higher order and unsupported cells are not left to VTK, which uses another node order for some of them.
    if (section.first != next || solid == nullptr || solid->nodes > 8) return false;
    next = section.last + 1;
  }
  return next == zone.size[1] + 1;
}

void set_cells(const CgnsZone& zone, cells::CellBlock& block) { Cells(zone, block).add_all(); }

}  // namespace tessera::readers
