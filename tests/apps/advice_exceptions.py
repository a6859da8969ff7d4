# SPDX-License-Identifier: BSD-3-Clause
"""Messages with advice that no row provokes, each with the reason; and statements that look like advice but are not.

Patterns are searched for in `FILE:LINE: PARTS .. OF THE MESSAGE` (advice_messages.py). One that is not found, or whose
messages rows produce, fails the test, and so does one that is found more often than it states: a new message needs a row or
its own reason.
"""

OTHER_BUILD = "only a build without the library says so; scripts/configurations.sh makes one"
DEFECT = "a defect of ours, which users are to report"
BIG = "of samples that half of `--memory` has no room for; io/volume/streamed_volumes_test.cpp"
HUGE = "takes more than 2^31 or 2^32 points or cells, or gigabytes"
DISK = "needs a disk that fails while it is read or written"
ROOT = "rights do not bind root, as which tests may run"
RANKS = "needs several processes; apps/mpirun_test.cpp, apps/shared_volumes_test.cpp"
LIBRARY = "only callers of the library can; the program asks the same sooner, in its own words, or has no such option"
ANSWER = "checks a reader's answer; the reader refuses such files sooner, so that a row would need a damaged helper"
HDF5 = "needs HDF5 files, which nothing but HDF5's library writes; io's tests of the format write them"
HELPER = "needs a helper program that speaks and then dies or lies; readers/helper_test.cpp has one"
VTK_XML = "the damage that each names is in io/mesh/vtu_damaged_test.cpp"
RARE = "needs rare cells or bounds that no small file has; io's tests of the format"
STATE = "said of states as JSON and as values; apps/state_test.cpp"
SERVER = "said by a server, which does not end; server/serve_test.py and server/state_words_test.cpp"
TIME = "takes minutes: a limit of time or of tets that sound files do not come near"

EXCEPTIONS = {
    r"apps/main\.cpp:\d+: standard input: only one process has it|^system/scratch_file\.cpp:\d+: ": (2, RANKS),
    r"this build leaves (out|\.(jpg|tif) out); build with": (6, OTHER_BUILD),
    r"this build has no server; configure": (1, OTHER_BUILD),
    r"^api/options/state_words\.cpp:\d+: state|^apps/commands/serve_scene\.cpp:\d+": (9, SERVER),
    r"^api/options/state_(of_values|values)\.cpp|^api/options/state_text\.cpp:\d+: (\{\}: \{\} is (not \{\}|empty; leave)|state: )": (
        6,
        STATE,
    ),
    r"^apps/commands/serve_command\.cpp:\d+|: arguments: serve shows one file": (3, SERVER),
    r"^io/text/json_text\.cpp:\d+: \{\}: has more than": (1, "takes twenty million values; io/text/json_text_test.cpp has fewer"),
    r"^io/scene/json_transfer_function\.cpp:\d+: transfer function: it has no knot": (1, LIBRARY),
    r"please report": (6, DEFECT),
    r"^io/vtk/vtk_array\.cpp:\d+: \{\}: its samples end or break": (1, BIG),
    r"2\^32|points are too many for|it lists more than \{\} blocks": (10, HUGE),
    r"(;|:\d+:) check the disk$|^io/image/image_(jpeg|tiff)\.cpp:\d+: \{\}: cannot be written": (8, DISK),
    r"raise the limit of open files": (1, "needs a process without descriptors; io/formats/input_files_test.cpp has one"),
    r"^io/mesh/pvtu_writer\.cpp:\d+: \{\}: cannot be written": (1, "a folder that takes files and refuses to rename them"),
    r"cannot be opened; check (its permissions|that you may read it)": (3, ROOT),
    r"^io/(volume/brick_file\.cpp:\d+: `block`|mesh/surface_files\.cpp:\d+: \{\}: the largest tet)": (2, LIBRARY),
    r"^io/image/film_file\.cpp:\d+: (: is not a film|\{\}: an image of)": (2, LIBRARY),
    r"^io/(scene/time_series\.cpp:\d+: \{\}: is not a time|volume/volume_reader\.cpp:\d+: \{\}: it does not begin as a \{\}vol)": (
        2,
        LIBRARY,
    ),
    r"^io/image/image_(exr\.cpp:\d+: \{\}: (is|has)|file\.cpp:\d+: background|pfm|png|tiff)": (9, LIBRARY),
    r"^(io/mesh/amr_file|cells/amr/amr_trees)\.cpp:\d+: \{\}: its (points|trees)|^cells/amr/amr_leaves\.cpp:\d+: \{\}: a block of an AMR": (
        3,
        ANSWER,
    ),
    r"^io/foreign/(client/)?foreign_(blocks|grids|numbers)|^cells/cell_block": (16, ANSWER),
    r"^io/vtk/(vtk_xml_(file|grid|numbers)|vtu_(cells|faces))\.cpp": (8, VTK_XML),
    r"^io/foreign/client/foreign_open\.cpp|^readers/common/readers\.hpp": (2, ANSWER),
    r"^readers/[a-z0-9/]+/\w+\.cpp:\d+: \{\}: (nothing can be|it holds \{\}, no|it is a grid of a kind|it cannot be read)": (
        7,
        ANSWER,
    ),
    r"^readers/[a-z0-9/]+/(gmsh_blocks\.cpp:\d+: \{\}: a cell uses|gmsh_file\.cpp:\d+: \{\}: \{\}Gmsh cannot)": (2, ANSWER),
    r"^readers/vtk/vtk_readers\.cpp:\d+: grid or": (1, ANSWER),
    r"^readers/[a-z0-9/]+/(xdmf_rewritten\.cpp:\d+: \{\}: it is not well|gmsh_view_names)": (2, ANSWER),
    r"^readers/tetgen/tetgen_fill\.cpp:\d+: \{\}: TetGen finds nothing": (1, ANSWER),
    r"^readers/[a-z0-9/]+/(hdf5_(kind|file|grid|references)|vtk_hdf_mesh|netcdf_values|med_meshes|minc2_file|amr_files)|^io/mesh/mesh_shares\.cpp:\d+: \{\}: it is named as CGNS": (
        27,
        HDF5,
    ),
    r"^readers/[a-z0-9/]+/cgns_": (18, HDF5),
    r"^readers/vtk/exodus_file\.cpp:\d+: field": (1, RARE),
    r"^readers/[a-z0-9/]+/linear_only": (2, RARE),
    r"^io/mesh/tecplot_numbers\.cpp:\d+: the zone has \{\} values": (1, RARE),
    r"^readers/gmsh/gmsh_elements\.cpp:\d+: \{\}: its cells of": (1, RARE),
    r"^io/foreign/client/(helper_process\.[ch]pp|foreign_fill\.cpp:\d+: filling)|^readers/common/(serve|limits)": (9, HELPER),
    r"^(io/foreign/client/foreign_fill\.cpp:\d+: correct|cells/block_tets\.cpp:\d+: .*order_tolerance|cells/amr/amr_leaves\.cpp:\d+: .*many pieces)": (
        5,
        TIME,
    ),
    r"^readers/vtk/vtk_words\.cpp:\d+: \{\}: VTK's reader fails on it and": (1, RARE),
    r"points in one block; split it$|^system/gzip\.cpp:\d+: it holds more than": (2, HUGE),
}

# Descriptions of options and formats, lines of reports and tables, and notes that only report what was done.
NO_ADVICE = [
    r"api/options/option_table\.cpp",
    r"apps/commands/chart_command\.cpp:\d+: errors: largest",
    r"apps/commands/info_command\.cpp:\d+: (check|renders) ",
    r"apps/interruption\.cpp:\d+: tessera: ended by",
    r"apps/help/manual_page\.cpp",
    r"apps/render/report\.cpp",
    r"apps/commands/convert_command\.cpp:\d+: \{\}: \{\}; field \{\} written to",
    r"io/scene/chrome_trace_reader\.cpp:\d+: name is missing",
    r"io/formats/format_table\.cpp",
    r"readers/dicom/dicom_main\.cpp:\d+: \{\} samples are in several segments",
    r"readers/dicom/dicom_series\.cpp:\d+: (some places have|slices are|values are)",
    r"io/scene/text_transfer_function\.cpp:\d+:  \(extinctions as given",
]
