// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/grid_pieces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>

#include "io/files/file_beginnings.hpp"
#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "io/text/clean_errors.hpp"
#include "io/text/xml_elements.hpp"
#include "readers/common/readers.hpp"
#include "readers/vtk/extents.hpp"

namespace tessera::readers {
namespace {

/// Names of a kind of grid.
struct KindWords {
  const char *whole, *piece, *extension;
};
KindWords words_of(GridKind kind) {
  switch (kind) {
    case GridKind::image:
      return {"PImageData", "ImageData", ".vti"};
    case GridKind::rectilinear:
      return {"PRectilinearGrid", "RectilinearGrid", ".vtr"};
    case GridKind::structured:
      break;
  }
  return {"PStructuredGrid", "StructuredGrid", ".vts"};
}

struct Piece {
  std::filesystem::path file;
  Extent extent;  ///< extent as stated in the parallel file
};

/// The contents of a parallel file.
struct WholeGrid {
  Extent extent{};
  std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};  ///< for images
  std::vector<Piece> pieces;                                ///< pieces with cells
};

/// Parses the numbers of an attribute; no value if there are too few.
template <class T, std::size_t count>
std::optional<std::array<T, count>> attribute_numbers(const std::string& text) {
  std::istringstream words(text);
  std::array<T, count> numbers{};
  for (T& number : numbers)
    if (!(words >> number)) return std::nullopt;
  return numbers;
}

/// Reads only the parallel file, not the pieces.
WholeGrid read_whole(const std::filesystem::path& file, GridKind kind) {
  allow_for(file);
  const io::WholeFile mapped(file);
  WholeGrid whole;
  const auto extent_of = [&](const io::XmlElement& element, const char* name) {
    const std::string* text = element.find(name);
    const auto extent = text ? attribute_numbers<int, 6>(*text) : std::nullopt;
    if (!extent) throw io::damaged(file, fmt::format("<{}> has no {} of six whole numbers", element.name, name));
    return *extent;
  };
  const auto set_vector = [&](const io::XmlElement& element, const char* name, std::array<double, 3>& vector) {
    const std::string* text = element.find(name);
    if (!text) return;
    const auto numbers = attribute_numbers<double, 3>(*text);
    if (!numbers) throw io::damaged(file, fmt::format("its {} is not three numbers", name));
    vector = *numbers;
  };
  io::each_xml_element(mapped.text(), file.string(), [&](const io::XmlElement& element) {
    if (element.name == words_of(kind).whole) {
      whole.extent = extent_of(element, "WholeExtent");
      set_vector(element, "Origin", whole.origin);
      set_vector(element, "Spacing", whole.spacing);
    }
    if (element.name != "Piece") return;
    const std::string* name = element.find("Source");
    if (!name) throw io::damaged(file, "a piece has no Source");
    const Piece piece{file.parent_path() / *name, extent_of(element, "Extent")};
    if (cells_in(piece.extent) == 0) return;
    if (!holds(whole.extent, piece.extent))
      throw io::damaged(file, fmt::format("a piece has the points {}, but the whole has {}",
                                          fmt::join(piece.extent, " "), fmt::join(whole.extent, " ")));
    whole.pieces.push_back(piece);
  });
  std::vector<Extent> extents;
  for (const Piece& piece : whole.pieces) extents.push_back(piece.extent);
  const double cells = cells_in(whole.extent), covered = cells_covered(extents);
  if (cells == 0)
    throw scene::bad_input(fmt::format("{}: it has no cells, being flat or empty; give a volume", file.string()));
  if (covered < cells)
    throw io::damaged(file, fmt::format("its pieces have {:.0f} of its {:.0f} cells", covered, cells));
  return whole;
}

vtkSmartPointer<vtkDataSet> read_piece(const std::filesystem::path& piece, const std::filesystem::path& file,
                                       GridKind kind, std::vector<std::string>& notes) {
  if (io::vtk_xml_type(io::read_beginning(piece, 4096)) != words_of(kind).piece)
    throw scene::bad_input(fmt::format("{}: it is a piece of {}, but not a {}; write them again", piece.string(),
                                       file.string(), words_of(kind).extension));
  std::string warning;
  vtkSmartPointer<vtkDataSet> data = vtkDataSet::SafeDownCast(read_xml_file(piece, words_of(kind).piece, warning));
  if (!data) throw scene::bad_input(fmt::format("{}: nothing can be read; write the file again", piece.string()));
  const std::string note = "VTK warns: " + warning;
  if (!warning.empty() && std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  return data;
}

/// Largest relative rounding error of a stored value (half a unit in the last place); 0 for integers.
double rounding_of(vtkDataArray& array) {
  if (array.GetDataType() == VTK_FLOAT) return 0x1p-24;
  return array.GetDataType() == VTK_DOUBLE ? 0x1p-53 : 0;
}

Extent extent_of(vtkDataSet& data) {
  Extent extent{};
  if (auto* image = vtkImageData::SafeDownCast(&data)) image->GetExtent(extent.data());
  if (auto* grid = vtkRectilinearGrid::SafeDownCast(&data)) grid->GetExtent(extent.data());
  if (auto* grid = vtkStructuredGrid::SafeDownCast(&data)) grid->GetExtent(extent.data());
  return extent;
}

/// The tuples of a box of points, or of a box of cells, which has one cell fewer than points along each axis.
class TupleBox {
 public:
  TupleBox(const Extent& extent, bool points) {
    for (std::size_t a = 0; a < 3; ++a) {
      first_[a] = extent[2 * a];
      count_[a] = vtkIdType{extent[2 * a + 1]} - extent[2 * a] + (points ? 1 : 0);
    }
  }
  [[nodiscard]] vtkIdType total() const { return count_[0] * count_[1] * count_[2]; }

  /// Copies the tuples of this box from an array that covers `from` to an array that covers `to`.
  void copy(vtkAbstractArray& from_array, const TupleBox& from, vtkAbstractArray& to_array, const TupleBox& to) const {
    for (vtkIdType k = 0; k < count_[2]; ++k)
      for (vtkIdType j = 0; j < count_[1]; ++j)
        to_array.InsertTuples(to.row(first_, j, k), count_[0], from.row(first_, j, k), &from_array);
  }

 private:
  [[nodiscard]] vtkIdType row(const std::array<vtkIdType, 3>& first, vtkIdType j, vtkIdType k) const {
    return ((first[2] + k - first_[2]) * count_[1] + first[1] + j - first_[1]) * count_[0] + first[0] - first_[0];
  }
  std::array<vtkIdType, 3> first_, count_;
};

std::string words_of(vtkAbstractArray& array) {
  return fmt::format("{} x {}", array.GetDataTypeAsString(), array.GetNumberOfComponents());
}

/// Allocates arrays for the whole grid, with the types of the first piece's arrays.
void make_arrays(vtkDataSetAttributes& first, vtkIdType tuples, vtkDataSetAttributes& whole) {
  for (int n = 0; n < first.GetNumberOfArrays(); ++n) {
    vtkAbstractArray& like = *first.GetAbstractArray(n);
    if (like.GetName() == nullptr) continue;
    const auto array = vtkSmartPointer<vtkAbstractArray>::Take(like.NewInstance());
    array->SetName(like.GetName());
    array->SetNumberOfComponents(like.GetNumberOfComponents());
    array->SetNumberOfTuples(tuples);
    whole.AddArray(array);
  }
  for (int kind = 0; kind < vtkDataSetAttributes::NUM_ATTRIBUTES; ++kind)
    if (vtkAbstractArray* active = first.GetAbstractAttribute(kind); active != nullptr && active->GetName() != nullptr)
      whole.SetActiveAttribute(active->GetName(), kind);
}

/// Whether coordinates are finite and strictly monotonic. VTK replaces missing ones by zeros.
bool rises_or_falls(vtkDataArray& coordinates) {
  bool rises = true, falls = true;
  for (vtkIdType i = 0; i < coordinates.GetNumberOfTuples(); ++i) {
    const double x = coordinates.GetComponent(i, 0), before = i > 0 ? coordinates.GetComponent(i - 1, 0) : x;
    if (!std::isfinite(x)) return false;
    rises = rises && (i == 0 || x > before), falls = falls && (i == 0 || x < before);
  }
  return rises || falls;
}

/// Collects the samples and coordinates of the pieces, one piece after the other.
class Assembly {
 public:
  Assembly(const std::filesystem::path& file, const WholeGrid& whole, GridKind kind) : file_(file), whole_(whole) {
    Extent extent = whole_.extent;  // a copy, because VTK's setters take non-const arrays
    if (kind == GridKind::image) {
      vtkNew<vtkImageData> image;
      image->SetExtent(extent.data());
      image->SetOrigin(whole_.origin.data());
      image->SetSpacing(whole_.spacing.data());
      grid_ = image;
    } else if (kind == GridKind::rectilinear) {
      vtkNew<vtkRectilinearGrid> rectilinear;
      rectilinear->SetExtent(extent.data());
      grid_ = rectilinear;
    } else {
      vtkNew<vtkStructuredGrid> structured;
      structured->SetExtent(extent.data());
      grid_ = structured;
    }
  }

  void add(vtkDataSet& data, const Piece& piece) {
    const Extent held = extent_of(data);
    if (!holds(held, piece.extent))
      throw scene::bad_input(fmt::format("{}: its points are {}, but {} states {}; write them again",
                                         piece.file.string(), fmt::join(held, " "), file_.string(),
                                         fmt::join(piece.extent, " ")));
    for (const bool points : {true, false}) {
      auto& from = points ? static_cast<vtkDataSetAttributes&>(*data.GetPointData()) : *data.GetCellData();
      auto& to = points ? static_cast<vtkDataSetAttributes&>(*grid_->GetPointData()) : *grid_->GetCellData();
      const TupleBox whole(whole_.extent, points), in_piece(held, points);
      if (is_first_) make_arrays(from, whole.total(), to);
      for (int n = 0; n < to.GetNumberOfArrays(); ++n) {
        vtkAbstractArray& array = *to.GetAbstractArray(n);
        vtkAbstractArray* const own = from.GetAbstractArray(array.GetName());
        require_equal(own, array, fmt::format("array '{}'", array.GetName()), in_piece, piece);
        TupleBox(piece.extent, points).copy(*own, in_piece, array, whole);
      }
    }
    if (auto* image = vtkImageData::SafeDownCast(&data)) take_direction(*image);
    if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(&data)) take_coordinates(*rectilinear, held, piece);
    if (auto* structured = vtkStructuredGrid::SafeDownCast(&data)) take_points(*structured, held, piece);
    is_first_ = false;
  }

  [[nodiscard]] vtkSmartPointer<vtkDataSet> finished() {
    // Points and cells that a piece marks as duplicates occur only once in the assembled grid, so the mark is removed.
    for (vtkUnsignedCharArray* ghosts : {grid_->GetPointGhostArray(), grid_->GetCellGhostArray()})
      for (vtkIdType n = 0; ghosts != nullptr && n < ghosts->GetNumberOfTuples(); ++n)
        ghosts->SetValue(n, static_cast<unsigned char>(ghosts->GetValue(n) & ~1));
    if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(grid_)) {
      rectilinear->SetXCoordinates(coordinates_[0]);
      rectilinear->SetYCoordinates(coordinates_[1]);
      rectilinear->SetZCoordinates(coordinates_[2]);
    }
    return grid_;
  }

 private:
  /// Throws unless the array has the type and number of components of the first piece's array, and all tuples of the
  /// piece.
  void require_equal(vtkAbstractArray* own, vtkAbstractArray& first, const std::string& name, const TupleBox& in_piece,
                     const Piece& piece) const {
    const std::string found = own ? words_of(*own) : "missing", wanted = words_of(first);
    if (found != wanted)
      throw scene::bad_input(fmt::format("{}: its {} is {}, but that of another piece of {} is {}; write them again",
                                         piece.file.string(), name, found, file_.string(), wanted));
    if (own->GetNumberOfTuples() != in_piece.total())
      throw io::damaged(piece.file, fmt::format("its {} has {} numbers for {} points or cells", name,
                                                own->GetNumberOfTuples(), in_piece.total()));
  }

  void take_points(vtkStructuredGrid& data, const Extent& held, const Piece& piece) {
    auto& structured = *vtkStructuredGrid::SafeDownCast(grid_);
    vtkDataArray* const own = data.GetPoints() ? data.GetPoints()->GetData() : nullptr;
    if (!own) throw io::damaged(piece.file, "it has no points");
    const TupleBox whole(whole_.extent, true), in_piece(held, true);
    if (is_first_) {
      vtkNew<vtkPoints> points;
      points->SetDataType(own->GetDataType());
      points->SetNumberOfPoints(whole.total());
      structured.SetPoints(points);
    }
    vtkDataArray& points = *structured.GetPoints()->GetData();
    require_equal(own, points, "list of points", in_piece, piece);
    TupleBox(piece.extent, true).copy(*own, in_piece, points, whole);
  }

  void take_direction(vtkImageData& piece) {
    auto& image = *vtkImageData::SafeDownCast(grid_);
    if (image.GetDirectionMatrix()->IsIdentity()) image.SetDirectionMatrix(piece.GetDirectionMatrix());
  }

  void take_coordinates(vtkRectilinearGrid& data, const Extent& held, const Piece& piece) {
    const std::array<vtkDataArray*, 3> own{data.GetXCoordinates(), data.GetYCoordinates(), data.GetZCoordinates()};
    for (std::size_t a = 0; a < 3; ++a) {
      const int points = held[2 * a + 1] - held[2 * a] + 1;
      if (!own[a] || own[a]->GetNumberOfTuples() != points || own[a]->GetNumberOfComponents() != 1)
        throw io::damaged(piece.file, fmt::format("it has {} coordinates along {}, but {} points",
                                                  own[a] ? own[a]->GetNumberOfTuples() : 0, "xyz"[a], points));
      if (!rises_or_falls(*own[a]))
        throw io::damaged(piece.file,
                          fmt::format("its coordinates along {} are neither increasing nor decreasing", "xyz"[a]));
      if (is_first_) {
        const int first = whole_.extent[2 * a], last = whole_.extent[2 * a + 1];
        coordinates_[a] = vtkSmartPointer<vtkDataArray>::Take(own[a]->NewInstance());
        coordinates_[a]->SetNumberOfTuples(vtkIdType{last} - first + 1);
        known_[a].resize(static_cast<std::size_t>(vtkIdType{last} - first + 1));
      }
      for (int i = piece.extent[2 * a]; i <= piece.extent[2 * a + 1]; ++i) {
        const int at = i - whole_.extent[2 * a];
        const double x = own[a]->GetComponent(i - held[2 * a], 0);
        if (!known_[a][static_cast<std::size_t>(at)]) {
          known_[a][static_cast<std::size_t>(at)] = true;
          coordinates_[a]->SetComponent(at, 0, x);
          continue;
        }
        const double before = coordinates_[a]->GetComponent(at, 0);
        // Both values come from the same coordinate of a grid, and each was rounded once or twice.
        const double most = 4 * std::max(rounding_of(*own[a]), rounding_of(*coordinates_[a])) * std::abs(before);
        if (!(std::abs(x - before) <= most))
          throw scene::bad_input(fmt::format(
              "{}: its point {} along {} is at {:.9g}, but that of another piece of {} is at {:.9g}; write them again",
              piece.file.string(), i, "xyz"[a], x, file_.string(), before));
      }
    }
  }

  const std::filesystem::path& file_;
  const WholeGrid& whole_;
  bool is_first_ = true;
  vtkSmartPointer<vtkDataSet> grid_;
  std::array<vtkSmartPointer<vtkDataArray>, 3> coordinates_;
  std::array<std::vector<bool>, 3> known_;  ///< which coordinates a piece has set
};

}  // namespace

vtkSmartPointer<vtkDataSet> read_grid_pieces(const std::filesystem::path& file, GridKind kind,
                                             std::vector<std::string>& notes) {
  const WholeGrid whole = read_whole(file, kind);
  Assembly assembly(file, whole, kind);
  for (const Piece& piece : whole.pieces) assembly.add(*read_piece(piece.file, file, kind, notes), piece);
  return assembly.finished();
}

}  // namespace tessera::readers
