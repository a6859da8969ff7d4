#!/usr/bin/env python3
"""Messages that give advice: the advice, followed, works.

Each row is a command that fails, the advice that its message has to give, and the command with that advice followed,
which has to succeed. Data are generated. Says each row that is otherwise; exit status 1 if there is one. At the end it
says how many of the messages of apps/ and io/ give advice, by their source, and how many rows there are.

    advice.py --tessera PROGRAM --source SOURCE_TREE
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

R = "render m.vtu -o a.png --size 32x32 "
V = "render v.vti -o a.png --size 32x32 "

# A command that fails or warns, advice, the mended command.
ROWS = [
    # names and arguments
    ("rendr m.vtu -o a.png", "did you mean render", R),
    (R + "--feild f", "did you mean --field", R + "--field f"),
    (R + "--field g", "it has point:'f'", R + "--field point:f"),
    ("render mm.vtu -o a.png --size 32x32", "m.vtu", R),
    ("info nowhere/m.vtu", "check the name", "info m.vtu"),
    ("completion tcsh", "use bash, zsh or fish", "completion zsh"),
    ("info folder", "name a file in it", "info folder/m.vtu"),
    ("info empty.vtu", "write it anew", "info m.vtu"),
    # the view
    (R + "--view sideways", "use front, back, left", R + "--view left"),
    (R + "--up 0,0,0", "say which way is up", R + "--up 0,1,0"),
    (R + "--fit", "name one, or leave it out", R),
    (R + "--camera c.json --view front", "leave one of the two out", R + "--camera c.json"),
    (R + "--camera c.json --projection orthographic", "leave one of the two out", R + "--projection orthographic"),
    ("render m.vtu -o a.png --size 0x5", "write WxH, each side 1 to 65536", "render m.vtu -o a.png --size 9x5"),
    ("render m.vtu -o a.png --size 60000x60000", "make it smaller", "render m.vtu -o a.png --size 600x600"),
    # colours and ranges
    (R + "--range 1", "write MIN,MAX", R + "--range 0,1"),
    (R + "--range 1,0", "write the smaller number first", R + "--range 0,1"),
    (R + "--opacity-points 0:0,5", "write T:A", R + "--opacity-points 0:0,0.5:0.1"),
    (R + "--opacity-points 0:0,2:1", "write 0 to 1, ascending", R + "--opacity-points 0:0,1:1"),
    (R + "--opacity-points 0:0,1:2", "is not 0 to 1", R + "--opacity-points 0:0,1:1"),
    (R + "--rescale", "name one, or leave it out", R),
    (R + "--iso 7", "choose a value between", R + "--iso 0.5"),
    (R + "--iso 0.5:red:3", "above 0 and at most 1", R + "--iso 0.5:red:0.5"),
    # parts of the data
    (R + "--threshold 1,0", "give the smaller number first", R + "--threshold 0,1"),
    (R + "--threshold 7,8", "nothing is left to render", R + "--threshold 0,1"),
    (R + "--clip 0,0,0,0,0,0", "say which side is to be kept", R + "--clip 0,0,0,0,0,1"),
    (R + "--clip box:0,0,0,0,1,1", "give two opposite corners", R + "--clip box:0,0,0,1,1,1"),
    (R + "--block wall", "leave --block out", R),
    ("info m.vtu --time-step 1:2", "give one step", "info m.vtu"),
    # methods
    (R + "--accuracy 1e-3 --integrator sampled:4", "leave one of the two out", R + "--integrator sampled:4"),
    (R + "--framebuffer float", "leave one of the two out", R),
    (R + "--compositor cpu --backend egl", "leave one of the two out", R + "--compositor cpu"),
    (R + "--egl-device 0", "leave one of the two out", R),
    (R + "--on-stall abort --stall-timeout 0", "leave one of the two out", R + "--on-stall abort"),
    (R + "--stall-timeout 0.01", "is not 0 or 0.2 to", R + "--stall-timeout 0.2"),
    (R + "--deep-accuracy 1e-3", "name one with -o FILE.deep.exr", R + "--deep-accuracy 1e-3 -o a.deep.exr"),
    (R + "--balance even", "leave it out", R),
    # volumes
    (V + "--smooth", "leave it out", V),
    (R + "--light 1,1,1", "add it, or leave --light out", R + "--light 1,1,1 --shade"),
    (R + "--shade --emission independent", "leave one of the two out", R + "--shade"),
    (R + "--shade --rasterizer scanline", "use --rasterizer planes", R + "--shade --rasterizer planes"),
    (R + "--shade --compositor gl-compute --backend osmesa", "leave out --compositor and --backend", R + "--shade"),
    (R + "--camera {", "not valid JSON", R + "--camera c.json"),
    (V + "--light 1,1,1", "add it, or leave --light out", V + "--light 1,1,1 --shade"),
    (V + "--light 0,0,0 --shade", "say which way the light lies", V + "--light 1,1,1 --shade"),
    (V + "--shade --no-shade", "leave one of the two out", V + "--shade"),
    (V + "--cache fifo", "use lru or proximity", V + "--cache proximity"),
    (V + "--preload 3", "add it, or leave --preload out", V + "--preload 3 --cache proximity"),
    (V + "--step 0.5", "use sampled or preintegrated", V + "--step 0.5 --integrator sampled"),
    (V + "--iso 7", "choose a value between", V + "--iso 0.5"),
    (V + "--iso 0.5 --integrator sampled", "leave one of the two out", V + "--iso 0.5 --integrator exact"),
    (V + "--threshold 7,8", "give a wider range", V + "--threshold=-1,1"),
    (V + "--integrator partial", "use auto, exact, sampled or preintegrated", V + "--integrator exact"),
    (V + "--balance best", "use accurate, backface", V + "--balance backface"),
    (V + "--balance-resolution 7", "from 0.001 to 1", V + "--balance-resolution 0.5"),
    (V + "--show cost", "use balance", V + "--show balance"),
    (V + "--type int7", "use int8, uint8", "info v.raw --dims 8x8x8 --type float32"),
    (V + "--endian middle", "use little or big", "info v.raw --dims 8x8x8 --type float32 --endian little"),
    ("info v.raw", "give --dims WxHxD --type", "info v.raw --dims 8x8x8 --type float32"),
    ("info v.raw --dims 9x9x9 --type float32", "give the right dimensions", "info v.raw --dims 8x8x8 --type float32"),
    (V + "--dims 8x8x8", "this one says them itself", V),
    ("info v.vti --check", "leave it out", "info v.vti"),
    # what is written
    ("render m.vtu -o a.bmp", "end it in .exr, .png", R),
    ("render m.vtu -o nowhere/a.png", "make the folder first, or name another", "render m.vtu -o folder/a.png"),
    ("render m.vtu -o folder.png", "name a file, not a folder", "render m.vtu -o folder/a.png"),
    ("render m.vtu -o - -o -", "give it once", "render m.vtu -o - --size 9x9"),
    (R + "-o - --report -", "give one of them a file", R + "-o - --report r.json"),
    (R + "-o - --resume", "leave it out", R + "-o -"),
    (R + "--frame-rate 25", "or leave it out", R),
    (R + "--outline --annotation-layer l.jpg", "name a .png or an .exr", R + "--outline --annotation-layer l.png"),
    ("convert m.vtu a.xyz", "choose .vtu or .tets", "convert m.vtu a.tets"),
    ("convert v.vti a.png", "choose .vti, .vtr, .nrrd", "convert v.vti a.nrrd"),
    ("convert v.vti a.vti --clip 0,0,0,1,0,0", "leave it out", "convert v.vti a.vti"),
    ("convert m.vtu m.vtu", "choose another name", "convert m.vtu b.vtu"),
    ("convert m.vtu b.pvtu --pieces 2 --partition best", "use curve, file or random",
     "convert m.vtu b.pvtu --pieces 2 --partition random"),
    ("convert m.vtu b.vtu --partition file", "give their number too", "convert m.vtu b.pvtu --partition file --pieces 2"),
    ("generate cube b.vtu n", "write NAME=VALUE", "generate cube b.vtu n=2"),
    ("generate cube b.vtu n=2 n=3", "give it once", "generate cube b.vtu n=3"),
    ("chart m.vtu -o a.png", "see tessera chart --help", "chart --help"),
    # a film where no ffmpeg is: pictures in its place
    ("render m.vtu -o a.mp4 --size 32x32", "write a_%04d.png", "render m.vtu -o a_%04d.png --size 32x32"),
    ("render m.vtu -o a_%04d.mp4 --size 32x32", "write a_%04d.png", "render m.vtu -o a_%04d.png --size 32x32"),
    ("render m.vtu -o a.mp4 --orbit 2 --size 32x32", "write a_%04d.png",
     "render m.vtu -o a_%04d.png --orbit 2 --size 32x32"),
    # meshes
    ("info case.foam", "move it into the folder of a case", None),
    ("info open.stl", "close its holes", None),
]

THROWN = re.compile(r"(?:bad_input|\bError)\(((?:[^;]|;\s)*?);\n", re.DOTALL)
ADVICE = re.compile(r"; \w|\buse |\bwrite |\bgive |\bleave |\bname a|did you mean")


def make_data(run, folder: Path):
    for command in ("generate cube m.vtu n=3", "generate ripples v.vti n=8", "convert v.vti v.raw"):
        done = run(command)
        if done.returncode != 0:
            sys.exit(f"{command}: {done.stderr}")
    (folder / "folder.png").mkdir()
    (folder / "folder").mkdir()
    (folder / "folder/m.vtu").write_bytes((folder / "m.vtu").read_bytes())
    (folder / "empty.vtu").touch()
    (folder / "case.foam").touch()
    (folder / "c.json").write_text(
        '{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2}'
    )
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 {}\nendloop\nendfacet\n"
    (folder / "open.stl").write_text("solid a\n" + facet.format(0) + facet.format(1) + "endsolid a\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", required=True)
    parser.add_argument("--source", type=Path, required=True)
    options = parser.parse_args()
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def run(command):
            return subprocess.run([options.tessera, *command.split()], cwd=folder, capture_output=True, timeout=60,
                                  stdin=subprocess.DEVNULL, env={**os.environ, "PATH": "/nowhere"}, errors="replace")

        make_data(run, folder)
        for command, advice, mended in ROWS:
            failed = run(command)
            is_line = failed.returncode in (2, 3) and failed.stderr.count("\n") == 1
            # What the picture does not show is a warning.
            is_warning = failed.returncode == 0 and "warning: " in failed.stderr
            if not (is_line or is_warning) or advice not in failed.stderr:
                wrong.append(f"{command}\n  status {failed.returncode}, '{advice}' awaited: {failed.stderr.strip()}")
            if mended is not None:
                done = run(mended)
                if done.returncode != 0:
                    wrong.append(f"{mended}\n  status {done.returncode}, after '{advice}': {done.stderr.strip()}")
    messages = 0
    for part in ("apps", "io"):
        for file in sorted((options.source / part).rglob("*.cpp")):
            for thrown in THROWN.finditer(file.read_text()):
                text = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', thrown[1]))
                messages += ADVICE.search(text) is not None
    print("\n".join(wrong))
    print(f"{messages} messages of apps/ and io/ give advice; {len(ROWS)} rows, {len(wrong)} wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
