// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// VTK's copy of the CGNS library. It defines names as macros, and two of these conflict with names of other libraries,
// so this header must be included first.
#include <vtk_cgns.h>

#include VTK_CGNS(cgnslib.h)

#undef cg
#undef size_of
#undef type_of
