#pragma once

class vtkDataObject;

namespace tessera::io::helper {

enum class PlaneOrder {
  whole,   ///< as it was read
  planes,  ///< numbers have been put in order
  none     ///< most cells have no volume or the other orientation in either order
};

/// Grids of PLOT3D, and their solutions, that may have been written plane by plane (/PLANES): the coordinates x, y and
/// z of all points of a plane, then of the next. Such a file is as long as one that is written whole, as VTK's reader
/// takes it, but the cells tell. Not for files with IBLANK.
PlaneOrder order_planes(vtkDataObject& data);

}  // namespace tessera::io::helper
