"""Messages with advice that no row provokes, each with the reason; and statements that look like advice and are none.

Patterns are looked for in `FILE:LINE: PARTS .. OF THE MESSAGE` (advice_messages.py). One that is not found, or whose
message a row does make, fails the test, so that neither list outlives its reason.
"""

EXCEPTIONS = {}

# Descriptions of options and formats, lines of reports and tables, and notes that only say what was done.
NO_ADVICE = [
    r"apps/annotation_options\.cpp:\d+: --annotat",
    r"apps/chart_command\.cpp:\d+: errors: largest",
    r"apps/command_line\.cpp:\d+: --block",
    r"apps/info_command\.cpp:\d+: (check|renders) ",
    r"apps/interruption\.cpp:\d+: tessera: ended by",
    r"apps/manual_page\.cpp",
    r"apps/report\.cpp",
    r"apps/convert_command\.cpp:\d+: \{\}: \{\}; field \{\} written to",
    r"io/chrome_trace_reader\.cpp:\d+: name is missing",
    r"io/file_kinds\.cpp:\d+: (closed|VTK XML|AMReX|Enzo|FLASH|Exodus|OpenFOAM|VTKHDF|MED|Fluent|AVS|Gmsh|Medit|I-DEAS|Nastran|SU2|PLOT3D)",
    r"io/file_kinds\.cpp:\d+: (raw tetra|NetCDF|MINC|MetaImage|NRRD|NIfTI|Analyze|DICOM)",
    r"io/helper/dicom_series\.cpp:\d+: (some places have|slices are)",
    r"io/text_transfer_function\.cpp:\d+:  \(extinctions as they stand",
]
