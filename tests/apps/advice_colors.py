# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about cameras, transfer functions, ranges, lists of files and traces."""

from advice_files import COLOR_MAP, JSON_CAMERA, KNOTS, PVCC, PVD, SERIES, TETRAHEDRON, TEXT_CAMERA, TRACE, unstructured
from advice_row import damaged, row

R = "render m.vtu -o a.png --size 16x16 "


def camera(name, whole, old, new, advice):
    return damaged(name, whole, old, new, advice, R + "--camera")


def colors(whole, old, new, advice):
    return damaged("tf", whole, old, new, advice, R + "--transfer-function")


def listed(name, whole, old, new, advice):
    assert old in whole, old
    return row(
        f"render {name} -o a.png --size 16x16 --time-step 0",
        advice,
        None,
        {name: whole.replace(old, new, 1)},
        {name: whole},
    )


def traced(old, new, advice):
    return damaged("t.json", TRACE, old, new, advice, "timing")


def knots(text, advice):
    """Knots on the command line, then two valid ones."""
    command = R + "--transfer-function '{}'"
    return row(command.format(text), advice, command.format('{"knots": [[0, 1, 0, 0, 1], [1, 0, 0, 1, 1]]}'))


ROWS = [
    # knots as JSON
    knots('{"knots": 5}', "write [[value, red, green, blue, extinction], ...]"),
    knots('{"knots": [[0, 1]]}', "write [value, red, green, blue, extinction]"),
    knots('{"knots": [[0, 1, 0, 0, "much"]]}', "its extinction is not a finite number; write one"),
    knots('{"knots": [[0, 1, 0, -1, 1]]}', "its blue is -1; it must not be negative"),
    knots('{"knots": [[1, 0, 0, 1, 1], [0, 1, 0, 0, 1]]}', "sort the knots by value"),
    knots('{"knots": [[0, 1, 0, 0, 1]], "points": 1}', "is unknown next to knots; leave it out"),
    # colours and ranges
    row(R + "--range 1", "write MIN,MAX", R + "--range 0,1"),
    row(R + "--range 1,0", "write the smaller number first", R + "--range 0,1"),
    row(R + "--opacity-points 0:0,5", "write T:A", R + "--opacity-points 0:0,0.5:0.1"),
    row(R + "--opacity-points 0:0,2:1", "write 0 to 1, ascending", R + "--opacity-points 0:0,1:1"),
    row(R + "--opacity-points 0:0,1:2", "is not 0 to 1", R + "--opacity-points 0:0,1:1"),
    row(R + "--rescale", "name one, or leave it out", R),
    row(R + "--iso 7", "choose a value between", R + "--iso 0.5"),
    row(R + "--iso 0.5:red:3", "above 0 and at most 1", R + "--iso 0.5:red:0.5"),
    row(
        R + "--transfer-function /proc/self/mem",
        "it cannot be read as text; check that it is the right file",
        R + "--transfer-function viridis",
    ),
    row(R + "--transfer-function coolwarm", "did you mean cool-warm?", R + "--transfer-function cool-warm"),
    row(R + "--transfer-function zzzz", "the presets are", R + "--transfer-function viridis"),
    # transfer functions as text
    colors(KNOTS, "0 1 0 0 0.5", "0 1 0 0 0,5", "write decimals with a point"),
    colors(KNOTS, "0.5", "half", "each line is `value r g b extinction`"),
    colors(KNOTS, " 0.5", "", "instead of 5; each line is `value r g b extinction`"),
    colors(KNOTS, "0.5", "-1", "it must not be negative"),
    colors(KNOTS, "1 0 0 1 2", "-1 0 0 1 2", "sort the lines by value"),
    colors(KNOTS, KNOTS, "# nothing\n", "give at least one line `value r g b extinction`"),
    row(
        R + "--transfer-function tf --opacity-points 0:0,1:1",
        "leave it out",
        R + "--transfer-function tf",
        {"tf": KNOTS},
    ),
    row(
        R + "--transfer-function tf",
        "is XML, which is not read as a transfer function",
        None,
        {"tf": "<a/>"},
        {"tf": COLOR_MAP},
    ),
    row(
        R + "--transfer-function big",
        "check that it is the right file",
        R + "--transfer-function tf",
        {"big": b"#" * (65 << 20), "tf": KNOTS},
    ),
    row(
        R + "--transfer-function folder", "name a file in it", R + "--transfer-function folder/tf", {"folder/tf": KNOTS}
    ),
    # ParaView's
    colors(COLOR_MAP, '"RGB"', "7", "export the map again"),
    colors(COLOR_MAP, "[0, 0, 0, 1, 1, 1, 0, 0]", "7", "it is 4 numbers a point"),
    colors(COLOR_MAP, "1, 1, 0, 0]", "1, 1, 0]", "the list is cut or a number is missing"),
    colors(COLOR_MAP, "1, 1, 0, 0]", '1, 1, 0, "0"]', "write 4 numbers a point"),
    colors(COLOR_MAP, "1, 1, 0, 0]", "1, 255, 0, 0]", "components are 0 to 1, not bytes"),
    colors(COLOR_MAP, "[0, 0, 0.5, 0", "[0, 9, 0.5, 0", "it must be 0 to 1"),
    colors(COLOR_MAP, '"RGB"', '"CMYK"', "is not known; RGB, HSV, Lab"),
    colors(COLOR_MAP, 'Distance": 1', 'Distance": 0', "it is a length in world units"),
    colors(COLOR_MAP, COLOR_MAP, "[]", "export a colour map into it"),
    colors(COLOR_MAP, COLOR_MAP, "[1]", "a map is an object with RGBPoints"),
    colors(COLOR_MAP, "RGBPoints", "IndexedColors", "give a continuous map with RGBPoints"),
    colors(COLOR_MAP, "RGBPoints", "Colors", "export the map from ParaView's colour map editor"),
    colors(COLOR_MAP, "}]", "]", "not valid JSON"),
    colors(COLOR_MAP, ": 1}", ": 1e999}", "correct it or export it again"),
    colors(COLOR_MAP, '"Name": "two"', '"Name": "two", "Name": "three"', "is given twice in one object; keep one"),
    colors(COLOR_MAP, COLOR_MAP, "[" * 70 + "]" * 70, "levels deep; "),
    row(
        "render b.vtu -o a.png --size 16x16 --transfer-function tf",
        "taken for a preset and stretched over the field; --range",
        "render b.vtu -o a.png --size 16x16 --transfer-function tf --range 0,1",
        {"tf": COLOR_MAP, "b.vtu": TETRAHEDRON},
    ),
    # cameras
    camera("c.txt", TEXT_CAMERA, "0 0 9", "0 0 nine", "each line is a word and its numbers"),
    camera("c.txt", TEXT_CAMERA, "view_up 0 1 0\n", "view_up 0 1 0\nview_up 0 1 0\n", "is given twice; keep one"),
    camera("c.txt", TEXT_CAMERA, "0 0 9", "0 9", "numbers; it takes 3"),
    camera("c.txt", TEXT_CAMERA, "view_up", "up", "is not a word of a camera; position, focal_point"),
    camera("c.txt", TEXT_CAMERA, "position 0 0 9\n", "", "give the eye's place, three numbers"),
    camera("c.txt", TEXT_CAMERA, "focal_point 0 0 0\n", "", "give the point it looks at"),
    camera(
        "c.txt",
        TEXT_CAMERA,
        "parallel_scale 2",
        "parallel_scale 2\nview_angle 9",
        "keep the first for an orthographic view",
    ),
    camera("c.txt", TEXT_CAMERA, "parallel_scale 2\n", "", "give the first for an orthographic view"),
    camera("c.txt", TEXT_CAMERA, "parallel_scale 2", "parallel_scale 2\nsize 0 9", "each is a whole number, 1 to"),
    camera(
        "c.txt", TEXT_CAMERA, TEXT_CAMERA, "\n", "is empty; give position, focal_point and parallel_scale or view_angle"
    ),
    camera("d.json", JSON_CAMERA, JSON_CAMERA, "[7]", 'is not an object; a view is {"position"'),
    camera("d.json", JSON_CAMERA, JSON_CAMERA, "[]", "give at least one view"),
    camera("d.json", JSON_CAMERA, "9", '"9"', "give numbers only"),
    camera("c.pvcc", PVCC, "PVCameraConfiguration", "Camera", "save the camera in ParaView as .pvcc"),
    camera("c.pvcc", PVCC, "CameraViewUp", "CameraPosition", "is given twice; keep one"),
    camera("c.pvcc", PVCC, 'value="5"', 'value="five"', "which is not a finite number; save the camera again"),
    camera("c.pvcc", PVCC, 'index="2"', 'index="3"', "it must be 0, 1 or 2"),
    camera("c.pvcc", PVCC, 'index="2"', 'index="1"', "twice; keep one"),
    camera("c.pvcc", PVCC, "<PVC", "<!DOCTYPE a>\n<PVC", "a ParaView camera has none, save it again"),
    camera("c.pvcc", PVCC, "</Proxy>", "", "not valid XML"),
    camera("c.pvcc", PVCC, "CameraPosition", "Position", "CameraPosition is missing; save the camera again"),
    camera("c.pvcc", PVCC, '<Element index="2" value="5"/>', "", "2 of 3 numbers; save the camera again"),
    # lists of files
    row(
        "render q%d.vtu -o a%d.png --size 16x16",
        "it would be like q1.vtu",
        "render q%d.vtu -o a%d.png --size 16x16",
        {},
        {"q1.vtu": TETRAHEDRON},
    ),
    row("render nowhere/q%d.vtu -o a%d.png", "check its name", R),
    row(
        "render t%d.vtu -o a%d.png --size 16x16",
        "choose steps that have it with --time-step FIRST:LAST",
        "render t%d.vtu -o a%d.png --size 16x16 --time-step 1:2",
        {"t0.vtu": unstructured(), "t1.vtu": TETRAHEDRON, "t2.vtu": TETRAHEDRON},
    ),
    row(
        "render t%d.vtu -o a%d.png --size 16x16",
        "choose it with --field, or steps with --time-step FIRST:LAST",
        "render t%d.vtu -o a%d.png --size 16x16 --field f",
        {**{f"t{k}.vtu": TETRAHEDRON.replace("0 250 500 1000", "0 0 0 0") for k in range(7)}, "t4.vtu": TETRAHEDRON},
    ),
    row("convert s.series o.vtu", "give one of its meshes", "convert m.vtu o.vtu", {"s.series": SERIES}),
    row(
        "info s.series --time-step 2",
        "there is no time step 2, it has 2; count from 0",
        "info s.series --time-step 1",
        {"s.series": SERIES},
    ),
    row(R + "--warp v:1", "it has no vectors at its points", R),
    row(R + "--warp v:x", "write NAME, NAME:FACTOR or off", R),
    row(R + "--warp :2", "write NAME, NAME:FACTOR or off", R),
    listed("s.pvd", PVD, "VTKFile", "Folder", "check that it is a .pvd"),
    listed("s.pvd", PVD, 'timestep="0"', 'timestep="never"', "write it again"),
    listed("s.pvd", PVD, 'file="m.vtu"', 'file=""', "names no file; write it again"),
    row(
        "render s.pvd -o a.png --size 16x16 --time-step 0",
        "it lists no DataSet; write it again",
        None,
        {"s.pvd": PVD.replace("DataSet", "Set")},
        {"s.pvd": PVD},
    ),
    listed("s.pvd", PVD, "</Collection>", "", "truncated or damaged, write it again"),
    listed("s.series", SERIES, "files", "file", "check that it is a ParaView file series"),
    listed("s.series", SERIES, SERIES, '{"files": []}', "it lists no file; write it again"),
    listed("s.series", SERIES, '"name": "m.vtu", "time": 1', '"time": 1', "write it again"),
    row(
        "render s.series -o a.png --size 16x16 --time-step 2",
        "there is no time step 2, it has 2; count from 0",
        "render s.series -o a.png --size 16x16 --time-step 1",
        {"s.series": SERIES},
    ),
    row(R + "--time-step 2", "leave it out", R),
    # traces
    row("timing t.json", "give a file that tessera render --timing wrote", None, {"t.json": "{}"}, {"t.json": TRACE}),
    traced('"ts": 0', '"ts": 1e99', "correct it or trace the run again"),
    traced('"width": 9', '"width": 0.5', "it must be a whole number from 0 to"),
    traced("traceEvents", "trace\nEvents", "correct it or export it again"),
]
