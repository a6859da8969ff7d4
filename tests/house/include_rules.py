#!/usr/bin/env python3
"""Which folder may include which: what each of the library's folders includes of the others, beside the table below.

Every folder may include its own headers, the public ones (tessera/) and scene/; what else, MAY_INCLUDE says. The
compiler holds targets to what they link (cmake/TesseraTarget.cmake); this holds the links to the design: a folder that
links another without being meant to fails here. Foreign headers that one place alone may know are in ONLY_IN.

Says file:line of every include that is not allowed, and of the header lists in TO_GO every line that is no longer
needed; exit status 1 if there is one. Says too, without failing, which allowances of MAY_INCLUDE nobody uses.

    include_rules.py SOURCE_TREE
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

# Beside scene/ and tessera/. None: anything.
MAY_INCLUDE = {
    "include": set(),
    "scene": set(),
    "colormaps": set(),
    "io": {"colormaps"},
    "integrals": set(),
    "exchange": set(),
    "gl": set(),
    "projection": {"gl"},
    "sorting": {"projection", "gl"},
    "volume": {"integrals", "gl"},
    "compositor": {"sorting", "projection", "integrals", "exchange", "gl"},
    "reference": set(),
    "frame": {"compositor", "sorting", "projection", "volume", "integrals", "exchange", "gl", "io", "colormaps",
              "reference"},
    "datasets": set(),
    "analysis": set(),  # and TO_GO
    "apps": {"analysis"},  # and TO_GO
    "examples": set(),
    "bench": None,
    "tests": None,
}
# These may not even include scene/.
PUBLIC_ONLY = {"include", "examples", "analysis", "apps"}

# What callers of the library still take from inside it. Only the public API and, for apps/, analysis/ are meant to
# remain: lines leave these lists, none are added.
TO_GO = {
    "analysis": """
        io/atomic_file.hpp io/chrome_trace_reader.hpp io/input_file.hpp io/json_text.hpp
        reference/ray_reference.hpp
        scene/error.hpp scene/image.hpp
    """,
    "apps": """
        datasets/generate.hpp datasets/modify.hpp datasets/volumes.hpp
        exchange/collectives.hpp exchange/heartbeats.hpp exchange/instruction_sets.hpp exchange/loopback_transport.hpp
        exchange/mpi_transport.hpp exchange/transport.hpp
        frame/compositing_device.hpp frame/dataset.hpp frame/distributed.hpp frame/mesh_input.hpp frame/render.hpp
        frame/roles.hpp frame/session_extras.hpp frame/sort_first.hpp frame/verify.hpp
        io/atomic_file.hpp io/camera_file.hpp io/chrome_trace.hpp io/chrome_trace_reader.hpp io/image_deep_exr.hpp
        io/image_file.hpp io/mesh_parts.hpp io/mesh_reader.hpp io/pvtu_writer.hpp io/time_series.hpp
        io/transfer_function_file.hpp io/volume_reader.hpp io/volume_writer.hpp
        projection/partition.hpp projection/pixel_space.hpp projection/planes_rasterizer.hpp
        projection/scanline_rasterizer.hpp
        reference/grid_reference.hpp reference/reference.hpp
        scene/camera.hpp scene/error.hpp scene/grid.hpp scene/image.hpp scene/mechanisms.hpp scene/mesh_facts.hpp
        scene/optical_model.hpp scene/sample_source.hpp scene/start_thread.hpp scene/tet_mesh.hpp scene/threads.hpp
        scene/trace.hpp
        volume/image_split.hpp volume/render.hpp
    """,
}
TO_GO = {folder: set(headers.split()) for folder, headers in TO_GO.items()}

# Foreign headers, and the folders or files that alone may include them. Tests of io/ write VTK's files by VTK.
ONLY_IN = [
    (r"mpi\.h$", ["exchange/", "include/tessera/mpi.hpp"]),
    (r"vtk", ["io/", "tests/io/"]),
    (r"tetgen\.h$", ["io/tetgen_fill.cpp"]),
    (r"CLI/", ["apps/"]),
    (r"(GL|EGL|KHR)/", ["gl/"]),
    (r"cairo", ["analysis/"]),
]

SUFFIXES = {".cpp", ".hpp", ".h", ".in"}
# Highway includes the file named so itself, once an instruction set.
INCLUDE = re.compile(r'^\s*#\s*(?:include|define\s+HWY_TARGET_INCLUDE)\s*[<"]([^>"]+)[>"]')


def includes(tree):
    """(folder, file, line, header) of every include in the folders of MAY_INCLUDE."""
    for folder in MAY_INCLUDE:
        for file in sorted((tree / folder).rglob("*")):
            if file.suffix in SUFFIXES and file.is_file():
                for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                    if match := INCLUDE.match(line):
                        yield folder, file.relative_to(tree).as_posix(), number, match[1]


def allowed(folder, header):
    of = header.split("/")[0]
    if MAY_INCLUDE[folder] is None or of == "tessera" or (of == folder and folder != "include"):
        return True
    if of == "scene" and folder not in PUBLIC_ONLY:
        return True
    return of in MAY_INCLUDE[folder] or header in TO_GO.get(folder, ())


def unknown_folders(tree):
    """Folders that the build adds and the table lacks."""
    build = (tree / "CMakeLists.txt").read_text(encoding="utf-8")
    return [f for f in re.findall(r"^\s*add_subdirectory\((\w+)\)", build, re.MULTILINE) if f not in MAY_INCLUDE]


def main():
    tree = Path(sys.argv[1])
    faults = [f"CMakeLists.txt: adds {folder}/, which this table does not know" for folder in unknown_folders(tree)]
    files, used = set(), defaultdict(set)
    for folder, file, line, header in includes(tree):
        files.add(file)
        of = header.split("/")[0]
        if of in MAY_INCLUDE or of == "tessera":
            used[folder] |= {of, header}
            if not allowed(folder, header):
                also = sorted({"tessera"} | MAY_INCLUDE[folder] | (set() if folder in PUBLIC_ONLY else {"scene"}))
                faults.append(f'{file}:{line}: includes "{header}"; {folder}/ may include {", ".join(also)}')
        for pattern, places in ONLY_IN:
            if re.match(pattern, header) and not file.startswith(tuple(places)):
                faults.append(f"{file}:{line}: includes {header}; only {' and '.join(places)} may")
    for folder, headers in TO_GO.items():
        for header in sorted(headers - used[folder]):
            faults.append(f"{folder}/ no longer includes {header}: take it out of TO_GO")
    for fault in faults:
        print(fault)
    for folder, others in MAY_INCLUDE.items():
        if unused := sorted((others or set()) - used[folder]):
            print(f"note: {folder}/ may include {', '.join(unused)} and does not")
    left = ", ".join(f"{len(headers)} of {folder}/" for folder, headers in TO_GO.items())
    print(f"{len(files)} files, {len(faults)} includes against the rules; to go: {left}")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
