# SPDX-License-Identifier: BSD-3-Clause
"""Rows of advice about arguments, the view, parts of the data and methods."""

from advice_files import PLY as SURFACE
from advice_row import row

R = "render m.vtu -o a.png --size 16x16 "
V = "render v.vti -o a.png --size 16x16 "
ONE_CELL = (
    "# vtk DataFile Version 3.0\n-\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
    + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nSCALARS f float 1\nLOOKUP_TABLE default\n1\n"
)

ROWS = [
    row(R + "--light 1,1,1", "add it, or leave --light out", R + "--light 1,1,1 --shade"),
    row(R + "--shade --emission independent", "leave one of the two out", R + "--shade"),
    row(R + "--shade --rasterizer scanline", "use --rasterizer planes", R + "--shade --rasterizer planes"),
    row(
        R + "--shade --compositor gl-compute --backend osmesa", "leave out --compositor and --backend", R + "--shade"
    ),
    row(R + "--camera {", "not valid JSON", R + "--camera c.json"),
    # names and arguments
    row("rendr m.vtu -o a.png", "did you mean render", R),
    row(R + "--feild f", "did you mean --field", R + "--field f"),
    row(R + "--field g", "it has point:'f'", R + "--field point:f"),
    row("render mm.vtu -o a.png --size 16x16", "did you mean m.vtu?", R),
    row("info nowhere/n.vtu", "check the name", "info m.vtu"),
    row(R + "--preset virids", "write --transfer-function viridis", R + "--transfer-function viridis"),
    row("completion tcsh", "use bash, zsh or fish", "completion zsh"),
    row(
        "info folder",
        "name a file in it",
        "render folder/v.raw --dims 2x2x2 --type uint8 -o a.png",
        {"folder/v.raw": "12345678"},
    ),
    row("info empty.vtu", "write it again", "info m.vtu", {"empty.vtu": ""}),
    # the view
    row(R + "--view sideways", "use front, back, left", R + "--view left"),
    row(R + "--up 0,0,0", "give the direction that is up", R + "--up 0,1,0"),
    row(R + "--fit", "name one, or leave it out", R),
    row(R + "--camera c.json --view front", "leave one of the two out", R + "--camera c.json"),
    row(R + "--camera c.json --projection orthographic", "leave one of the two out", R + "--projection orthographic"),
    row("render m.vtu -o a.png --size 0x5", "write WxH, each side 1 to 65536", "render m.vtu -o a.png --size 9x5"),
    row("render m.vtu -o a.png --size 60000x60000", "make it smaller", "render m.vtu -o a.png --size 600x600"),
    # parts of the data
    row(R + "--threshold 1,0", "write the smaller number first", R + "--threshold 0,1"),
    row(R + "--threshold 7,8", "nothing is left to render", R + "--threshold 0,1"),
    row(R + "--clip 0,0,0,0,0,0", "give the side to keep", R + "--clip 0,0,0,0,0,1"),
    row(R + "--clip box:0,0,0,0,1,1", "give two opposite corners", R + "--clip box:0,0,0,1,1,1"),
    row(R + "--block wall", "leave --block out", R),
    row("info m.vtu --time-step 1:2", "give one step", "info m.vtu"),
    # methods
    row(R + "--accuracy 1e-3 --integrator sampled:4", "leave one of the two out", R + "--integrator sampled:4"),
    row(R + "--framebuffer float", "leave one of the two out", R),
    row(R + "--compositor cpu --backend egl", "leave one of the two out", R + "--compositor cpu"),
    row(R + "--egl-device 0", "leave one of the two out", R),
    row(R + "--on-stall abort --stall-timeout 0", "leave one of the two out", R + "--on-stall abort"),
    row(R + "--stall-timeout 0.01", "is not 0 or 0.2 to", R + "--stall-timeout 0.2"),
    row(R + "--deep-accuracy 1e-3", "name one with -o FILE.deep.exr", R + "--deep-accuracy 1e-3 -o a.deep.exr"),
    row(R + "--peel 1", "like 0.95:4", R + "--peel 0.95:4"),
    row(R + "--peel 0.5:65", "has no number of layers, 1 to 64", R + "--peel 0.5:64"),
    row(R + "--peel 0.5 --deep-accuracy 1e-3", "leave one of the two out", R + "--peel 0.5 -o a.deep.exr"),
    row(R + "--peel 0.5 --rasterizer scanline", "use planes", R + "--peel 0.5 --rasterizer planes"),
    row(R + "--peel 0.5 --integrator sampled:4", "use auto or exact", R + "--peel 0.5 --integrator exact"),
    row(V + "--peel 0.5 --integrator sampled", "use auto or exact", V + "--peel 0.5 --integrator exact"),
    row(V + "--peel 0.5 --show balance", "leave one of the two out", V + "--peel 0.5"),
    row(
        "render m.vtu -o a.png --size 64x64 --peel 0.5:64 --memory 1M",
        "raise it, or ask for fewer layers",
        "render m.vtu -o a.png --size 64x64 --peel 0.5:64 --memory 64M",
    ),
    row(R + "--balance even", "leave it out", R),
    row(R + "--clip 0,0,0,0,0,9 --clip 5,0,0,1,0,0", "turn the normal round or move it", R + "--clip 5,0,0,-1,0,0"),
    row(
        R + "--threshold 0,0.5 --clip 0.4,0.4,0.4,1,1,1",
        "move the plane",
        R + "--threshold 0,1 --clip 0.4,0.4,0.4,1,1,1",
    ),
    row(
        R + "--time-step 3:1",
        "give the smaller step first",
        "render s.series -o a.png --size 16x16 --time-step 1",
        {"s.series": '{"files": [{"name": "m.vtu", "time": 0}, {"name": "m.vtu", "time": 1}]}'},
    ),
    # words of arguments
    row("dance m.vtu", "is not a command; use render", R),
    row("info", "see tessera info --help", "info --help"),
    row("info m.vtu --zzzzzz", "see tessera info --help", "info --help"),
    row(R + "--memory 12Q", "write 1M or more, like 512M or 2G", R + "--memory 512M"),
    row(
        R + "--integrator fast", "use exact, sampled:N, preintegrated[:N], partial or auto", R + "--integrator partial"
    ),
    row(R + "--without sleep", "write some of culling", R + "--without culling,skipping,termination,lattice,sharing,merging"),
    row(R + "--background lightgrai", "a colour; did you mean lightgray?", R + "--background lightgray"),
    row(R + "--background qqqqqqqq", "or a name of CSS", R + "--background #102030"),
    row(R + "--background 1,2", "write R,G,B (linear light", R + "--background 0,0.5,1"),
    row(R + "--up 1,2", "three numbers; write X,Y,Z", R + "--up 0,1,0"),
    row(
        "info v.raw --dims 8x8x8 --type float32 --spacing 1,0,1",
        "three numbers above 0; write X,Y,Z",
        "info v.raw --dims 8x8x8 --type float32 --spacing 1,1,1",
    ),
    row("info v.raw --dims 8x8 --type float32", "three sizes; write WxHxD", "info v.raw --dims 8x8x8 --type float32"),
    row(R + "--surface nowhere.ply", "give one of the two, a file as .ply", R + "--surface boundary"),
    row(R + "--surface wall", "give boundary or a file of triangles", R + "--surface boundary"),
    row(V + "--compositor gl-fragment", "leave them out", V),
    row(R + "--compositor gl-fragment --backend cpu", "or use --compositor cpu", R + "--compositor cpu --backend cpu"),
    row(R + "--compositor cpu --backend osmesa", "leave one of the two out", R + "--compositor cpu"),
    row(R + "--rasterizer device", "or use --rasterizer planes", R + "--rasterizer planes"),
    row(R + "--rasterizer device", "add that", R + "--rasterizer device --compositor gl-compute"),
    row(
        R + "--rasterizer device --compositor gl-fragment --backend osmesa",
        "use gl-compute",
        R + "--rasterizer device --compositor gl-compute --backend osmesa",
    ),
    row(R + "--compositor gpu", "is unknown; use cpu", R + "--compositor cpu"),
    row(R + "--without merging --exchange runs", "leave one of the two out", R + "--without merging"),
    row(R + "--higher-order-tets=-1", "a whole number from 0", R + "--higher-order-tets 1"),
    # annotation
    row(R + "--color-bar=middle", "is not a place; use top-left", R + "--color-bar=top-left"),
    row(R + "--color-bar --color-bar-range 1,0", "write the smaller number first", R + "--color-bar --color-bar-range 0,1"),
    row(R + "--color-bar-range 0,1", "give that too, or leave it out", R + "--color-bar --color-bar-range 0,1"),
    row(R + "--outline=2", "takes no value; leave that out", R + "--outline"),
    row(
        "render m.vtu -o a.deep.exr --size 16x16 --outline",
        "name an .exr, .png or .pfm too, or an --annotation-layer",
        "render m.vtu -o a.deep.exr --size 16x16 --outline --annotation-layer l.png",
    ),
    row(V + "--show balance --outline", "leave one of the two out", V + "--show balance"),
    row(
        "render v.vti -o a.deep.exr --size 16x16 --integrator sampled",
        "use auto or exact",
        "render v.vti -o a.deep.exr --size 16x16 --integrator exact",
    ),
    row(
        "render v.vti -o a.deep.exr --size 16x16 --shade",
        "leave --shade out",
        "render v.vti -o a.deep.exr --size 16x16",
    ),
    row("render v.vti -o a.deep.exr --size 16x16 --show balance", "name an .exr, .png or .pfm", V + "--show balance"),
    # files of options
    row(
        R + "--config s.toml", "did you mean view?", None, {"s.toml": "veiw = 'left'\n"}, {"s.toml": "view = 'left'\n"}
    ),
    row(R + "--config s.toml", "see tessera render --help-all", "render --help-all", {"s.toml": "qqqqqqqqqq = 1\n"}),
    row(R + "--config s.toml", "leave it out", R, {"s.toml": "config = 't.toml'\n"}),
    row(R + "--config s.toml", "takes one value; give one", None, {"s.toml": "iso = '1'\nzoom = [1, 2]\n"}, {"s.toml": "zoom = 2\n"}),
    row(R + "--config s.toml", "by two names; keep one", None, {"s.toml": "opacity = 1\nopacity-scale = 2\n"}, {"s.toml": "opacity = 2\n"}),
    row(V + "--surface walls", "shows a surface in one", V + "--iso 0.5"),
    row(
        "render c.vtk -o a.png --size 16x16 --field f --shade",
        "gives values at the points",
        "render c.vtk -o a.png --size 16x16 --field f --shade --smooth",
        {"c.vtk": ONE_CELL},
    ),
    row(
        R + "--config s.toml",
        "save it as UTF-8",
        None,
        {"s.toml": "size = '8x8'\n".encode("utf-16")},
        {"s.toml": "size = '8x8'\n"},
    ),
    *(
        row(R + "--config s.toml", advice, None, {"s.toml": wrong}, {"s.toml": right})
        for advice, wrong, right in (
            ("end it with ]", "iso = ['0.5'\n", "iso = ['0.5']\n"),
            ("end it with \"", 'size = "8x8\n', 'size = "8x8"\n'),
            ("keep one, or give a list", "size = '8x8'\nsize = '9x9'\n", "size = '9x9'\n"),
            ("write options alone, as in size", "[picture]\nsize = '8x8'\n", 'size = "800x600"\n'),
            ("write an option as in size", "size 8x8\n", 'size = "800x600"\n'),
            ("write one as in size", "the size = 8x8\n", 'size = "800x600"\n'),
            ("put text in quotes", "annotate = two words\n", "annotate = 'two words'\n"),
            ("put text in quotes", "annotate =\n", "annotate = ''\n"),
            ("put a comma between values", "iso = ['0.5' '0.6']\n", "iso = ['0.5', '0.6']\n"),
            ("write true, or leave it out", "color-bar = ''\n", "color-bar = true\n"),
            ("write one list of texts", "iso = [['0.5']]\n", "iso = ['0.5']\n"),
            ("write \\n for a line break", 'annotate = """a\nb"""\n', 'annotate = "a\\nb"\n'),
            ("write \\\\, or put the text in single quotes", 'annotate = "a\\p"\n', "annotate = 'a\\p'\n"),
            ("leave it out", "annotate = 'a\0b'\n", "annotate = 'ab'\n"),
        )
    ),
    # standard streams
    row(
        "render - -o a.png --size 16x16",
        "standard input: it is empty; send a file to it",
        stdin="s",
        before={"s": b""},
        after={"s": SURFACE},
    ),
    row(
        "render - -o a.png --size 16x16",
        "it is a terminal; send a file to it",
        "render - -o a.png --size 16x16",
        terminal="stdin",
        stdin="s",
        before={"s": SURFACE},
    ),
    row("render m.vtu -o - --size 16x16", "is a terminal; send it to a file", terminal="stdout", after={"x": ""}),
    row("info m.vtu", "make room or close the pipe later", terminal="full", after={"x": ""}),
    row("render m.vtu -o - --size 16x16", "make room or close the pipe later", terminal="full", after={"x": ""}),
    row(
        "render - -o a.png --size 16x16",
        "or set TMPDIR to another directory",
        "render s.ply -o a.png --size 16x16",
        stdin="s.ply",
        before={"s.ply": SURFACE},
        env={"TMPDIR": "/proc"},
    ),
]
