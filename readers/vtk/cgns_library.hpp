// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// VTK's copy of the CGNS library. Its names are macros, and two of them conflict with ours. Include it first.
#include <vtk_cgns.h>

#include VTK_CGNS(cgnslib.h)

#undef cg
#undef size_of
#undef type_of
