#pragma once

#include <string>
#include <vector>

#include "io/cell_block.hpp"

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

namespace tessera::io {

/// Copies a VTK data set's points and cells into a block, checking every offset and index, which VTK's readers do not.
/// Fields keep their VTK arrays alive until they are read. Structured, curvilinear and rectilinear grids become
/// hexahedra. Throws Error(bad_input) naming the cell at fault.
CellBlock block_from_vtk(vtkDataSet& data, const std::string& name, const std::string& source);

/// All blocks of a data set or (nested) multi-block; empty ones are left out, and so are surfaces beside volumes, for
/// which `notes` has a line. Throws Error(bad_input) for images (regular grids) and other data objects.
std::vector<CellBlock> blocks_from_vtk(vtkDataObject& data, const std::string& source, std::vector<std::string>& notes);

/// Adds the arrays of a VTK data set's points or cells as fields. Throws Error(bad_input) for one that has not
/// `expected` tuples.
void add_vtk_fields(vtkDataSet& data, scene::Association association, std::size_t expected, CellBlock& block,
                    const std::string& source);

}  // namespace tessera::io
