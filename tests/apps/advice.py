#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Messages that give advice: following the advice works.

A row of ROWS is a shell command that fails or warns, the advice that its message must give, and the command after
following that advice, which must succeed without that message. DAMAGED lists small valid files, and changes of them
that the program must refuse with advice on the place; the whole file is accepted. Each format that the program knows
but does not read is refused with its advice. Data are generated; what messages name is checked in option_names.py.
Reports each row that violates this; exit status 1 if there is one.

    advice.py --tessera PROGRAM [--without-mpi] [--every N] [--only TEXT]
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import guide_files

# R and V render a small mesh and a small volume, S the mesh in another size, I prints what a file holds. toml and knots
# render the mesh with a file of this text.
FUNCTIONS = r"""
R() { tessera render m.vtu -o a.png --size 16x16 "$@" && test -s a.png; }
V() { tessera render v.vti -o a.png --size 16x16 "$@" && test -s a.png; }
S() { tessera render m.vtu -o a.png "$@"; }
I() { tessera info "$@"; }
toml() { printf "$1" > s.toml; R --config s.toml; }
knots() { printf "$1" > f.txt; shift; R --transfer-function f.txt "$@"; }
film() { tessera render -o a%d.png --size 9x9 "$@"; }
ranks() { ASAN_OPTIONS=detect_leaks=0 mpirun -n 2 tessera render m.vtu -o a.png --size 16x16 "$@"; }
at_terminal() { python3 -c 'import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))' "$@"; }
four_axes() { printf "NRRD0004\ntype: uint8\ndimension: 4\n$1sizes: 2 2 2 2\nencoding: hex\n\n%032d" 1 > b.nrrd; }
raw="--dims 8x8x8 --type float32"
"""

ROWS = r'''
# names
tessera rendr m.vtu -o a.png => did you mean render => R
tessera dance m.vtu => is not a command; use render => R
tessera info => see tessera info --help => tessera info --help
I m.vtu --zzzzzz => see tessera info --help => tessera info --help
R --feild f => did you mean --field => R --field f
R --color-bra=left => did you mean --color-bar? => R --color-bar=left
tessera help inof => did you mean info? => tessera help info
R --field ponit:f => did you mean 'point:f'? => R --field point:f
R --transfer-function viridis:peask => did you mean viridis:peaks? => R --transfer-function viridis:peaks
R --field g => it has point:'f' => R --field point:f
I m.vtu --field ff => did you mean 'f'? => I m.vtu --field f
tessera render mm.vtu -o a.png => did you mean m.vtu? => R
I nowhere/n.vtu => check the name => I m.vtu
R --preset virids => write --transfer-function viridis => R --transfer-function viridis
R --transfer-function coolwarm => did you mean cool-warm? => R --transfer-function cool-warm
tessera completion tcsh => use bash, zsh or fish => tessera completion zsh

# words of arguments
S --size 0x5 => write WxH, each side 1 to 65536 => S --size 9x5
S --size 60000x60000 => make the image smaller => S --size 600x600
R --memory 12Q => write 1M or more, like 512M or 2G => R --memory 512M
R --background lightgrai => did you mean lightgray? => R --background lightgray
R --background qqqqqqqq => or a name of CSS => R --background '#102030'
R --background 1,2 => write R,G,B (linear light => R --background 0,0.5,1
R --without sleep => write one or more of culling => R --without culling,skipping,termination,lattice,sharing,merging
R --integrator fast => use exact, sampled:N, preintegrated[:N], partial or auto => R --integrator partial
R --color-bar=middle => is not a place; use top-left => R --color-bar=top-left
R --outline=2 => it takes no value; leave the value out => R --outline

# annotations
R --annotate {tiem} => {tiem} is unknown; use {field} {time} {file} => R --annotate {time}
R --axes=all => use triad, box or both => R --axes=both
R --color-bar-title T => has no effect without --color-bar => R --color-bar --color-bar-title T
R --color-bar --color-bar-range 5 => write LOW,HIGH => R --color-bar --color-bar-range 1,5
R --color-bar --color-bar-range 5,1 => are not in ascending order; write the smaller number first
    => R --color-bar --color-bar-range 1,5
R --color-bar --color-bar-scale cubic => use linear or log => R --color-bar --color-bar-scale log
R --color-bar --color-bar-scale log --color-bar-range=-1,5 => give --color-bar-range
    => R --color-bar --color-bar-range=-1,5
R --annotate a --annotation-size 2000 => it must be 4 to 1000 => R --annotate a --annotation-size 1000
R --annotation-size 20 => has no effect without => R --annotate a --annotation-size 20
R --axes --length-unit mm => has no effect without --axes=box or --scale-bar => R --axes=box --length-unit mm
R --outline --annotation-layer l.pfm => give a .png or an .exr => R --outline --annotation-layer l.png
R --outline --annotation-layer l.deep.exr => give a .png or an .exr => R --outline --annotation-layer l.exr
tessera render m.vtu -o a.deep.exr --outline => also give an .exr, .png or .pfm => R -o a.deep.exr --outline

# files of options
R --config none.toml => there is no such file => R
toml "veiw = 'left'\n" => did you mean view? => toml "view = 'left'\n"
toml "qqqqqqqqqq = 1\n" => see tessera render --help-all => tessera render --help-all
toml "iso = ['0.5'\n" => end it with ] => toml "iso = ['0.5']\n"
toml "color-bar = ''\n" => write true, or leave it out => toml "color-bar = true\n"
toml "[image]\nview = 'left'\n" => write options alone, as in size => toml "view = 'left'\n"
toml 'annotate = """a\nb"""\n' => write \n for a line break => toml 'annotate = "a\\nb"\n'
toml 'annotate = "a\\p"\n' => write \\, or put the text in single quotes => toml "annotate = 'a\\p'\n"
toml "opacity = 1\nopacity-scale = 2\n" => by two names; keep one => toml "opacity = 2\n"
toml "\377\376o\0p\0" => save it as UTF-8 => toml "opacity = 2\n"

# cameras and the view
R --view sideways => use front, back, left => R --view left
R --up 0,0,0 => give the direction that is up => R --up 0,1,0
R --fit => give one, or leave --fit out => R --fit --camera c.json
R --camera c.json --view front => leave one of the two out => R --camera c.json
R --camera c.json --projection orthographic => leave one of the two out => R --projection orthographic
R --camera { => not valid JSON => R --camera c.json
R --shade --light 0,0,0 => give the direction towards the light => R --shade --light 1,1,1

# parts of the data, blocks and steps
R --threshold 1,0 => write the smaller number first => R --threshold 0,1
R --threshold 7,8 => nothing is left to render => R --threshold 0,1
R --threshold 1 => is not two numbers; write MIN,MAX => R --threshold 0,1
R --clip 1,2,3 => is not PX,PY,PZ,NX,NY,NZ => R --clip 0,0,0,1,2,3
R --clip 9,0,0,1,0,0 => nothing is on the side that --clip keeps => R --clip 0,0,0,1,0,0
R --clip 0,0,0,0,0,0 => points to the side to keep => R --clip 0,0,0,0,0,1
R --clip box:0,0,0,0,1,1 => give two opposite corners => R --clip box:0,0,0,1,1,1
R --threshold 0,0.5 --clip 0.4,0.4,0.4,1,1,1 => move the plane => R --threshold 0,1 --clip 0.4,0.4,0.4,1,1,1
R --clip 0,0,0,0,0,9 --clip 5,0,0,1,0,0 => reverse the normal or move the plane => R --clip 5,0,0,-1,0,0
R --block wall => leave --block out => R
I can.ex2 --block steal => the nearest is 'steel' => I can.ex2 --block steel
I can.ex2 --time-step 3 => there is no time step 3 => I can.ex2 --time-step 2
R --time-step 2 => leave --time-step out => R
I m.vtu --time-step 1:2 => give one step => I m.vtu
I can.ex2 --time-step all => which only render can make => film can.ex2 --time-step all
film can.ex2 --time-step 0:3 => there is no time step 3, it has only 3 => film can.ex2 --time-step 0:2
film can.ex2 --time-step x:3 => is not a whole number from 0 up => film can.ex2 --time-step 0:2
film can.ex2 --time-step 0:2:0 => is not a whole number from 1 up => film can.ex2 --time-step 0:2:1
tessera render can.ex2 -o a.png --size 9x9 --time-step all => need numbers => film can.ex2 --time-step all
film can.ex2 --time-step 2:1 => give the smaller step first => film can.ex2 --time-step 1:2
R --warp v:x => write NAME, NAME:FACTOR or off => R --warp off

# transfer functions
R --range 1,0 => write the smaller number first => R --range 0,1
R --opacity-points 0:0,5 => write T:A => R --opacity-points 0:0,0.5:0.1
R --opacity-points 0:0,2:1 => write 0 to 1, ascending => R --opacity-points 0:0,1:1
R --rescale => give one, or leave --rescale out => R
R --iso 7 => choose a value between => R --iso 0.5
R --transfer-function '{"knots": [[0, 1]]}' => write [value, red, green, blue, extinction]
    => R --transfer-function '{"knots": [[0, 1, 0, 0, 1]]}'
R --transfer-function /proc/self/mem => check that it is the right file => R --transfer-function viridis
knots "0 1 1 1 0\n1 1 1 1 0\n" --iso 50 => ; give it opacity => knots "0 1 1 1 2\n1 1 1 1 3\n"
knots "0 1e-9 0 0 0\n1 1e-9 0 0 0\n" --emission independent => give the transfer function brighter colours
    => knots "0 1 0 0 0\n1 1 0 0 0\n" --emission independent
knots "0 1e5 2e5 3e5 0\n1 3e5 1e5 2e5 0\n" --emission independent => is not kept; give `--accuracy
    => knots "0 1e5 2e5 3e5 0\n1 3e5 1e5 2e5 0\n" --emission independent --accuracy 1

# methods
R --accuracy 1e-3 --integrator sampled:4 => leave one of the two out => R --integrator sampled:4
R --shade --emission independent => leave one of the two out => R --shade
R --shade --rasterizer scanline => use --rasterizer planes => R --shade --rasterizer planes
R --deep-accuracy 1e-3 => give one with -o FILE.deep.exr => R --deep-accuracy 1e-3 -o a.deep.exr
R --peel 1 => like 0.95:4 => R --peel 0.95:4
R --peel 0.5 --deep-accuracy 1e-2 => leave one of the two out => R --peel 0.5
R --peel 0.5 --rasterizer scanline => use planes => R --peel 0.5 --rasterizer planes
R --peel 0.5 --compositor gl-compute => leave out => R --peel 0.5
V --peel 0.5 --show balance => leave one of the two out => V --peel 0.5
V --peel 0.5 --integrator preintegrated => use auto or exact => V --peel 0.5 --integrator auto
R --deep-accuracy 2 -o a.deep.exr => --deep-accuracy 2: it must be 1e-6 to 1 => R --deep-accuracy 1 -o a.deep.exr
R --rasterizer scanline --projection perspective => use an orthographic view, or --rasterizer planes
    => R --rasterizer planes --projection perspective
R --integrator sampled:4 -o a.deep.exr => use exact or auto => R --integrator exact -o a.deep.exr
R --compositor gl-fragment --backend osmesa --exchange runs => use --exchange segments => R --exchange segments
R --backend osmesa,cpu => give one word, or one for each => R --backend cpu
S --memory 1M --size 1024x1024 --threads 1 => raise --memory => S --memory 2M --size 1024x1024 --threads 1
R --peel 0.5 --integrator sampled:4 => use auto or exact => R --peel 0.5 --integrator exact
S --size 64x64 --peel 0.5:64 --memory 1M => raise --memory, or request fewer layers
    => S --size 64x64 --peel 0.5:64 --memory 64M
R --compositor cpu --backend osmesa => leave one of the two out => R --compositor cpu
R --rasterizer device => or use --rasterizer planes => R --rasterizer planes
R --stall-timeout 0.01 => is not 0 or 0.2 to => R --stall-timeout 0.2
tessera render c.vtk -o a.png --size 9x9 --field f --shade => gives values at the points
    => tessera render c.vtk -o a.png --size 9x9 --field f --shade --smooth

# surfaces
R --surface walls => it has no named blocks; give boundary or a file => R --surface a.ply; R --surface boundary
R --surface walls.ply => is neither boundary nor an existing file => R --surface a.ply
R --surface c.vtk => is not a surface of triangles; give a .ply, .stl, .vtp => R --surface a.ply
R --surface boundary:reddish => is not a colour; write R,G,B => R --surface boundary:red
R --surface boundary:red:2 => opacity 2 => R --surface boundary:red:0.5
R --surface boundary --rasterizer scanline => use --rasterizer planes => R --surface boundary --rasterizer planes
R --surface empty.ply => is empty; write the file again => R --surface a.ply
R --iso high => is not a number => R --iso 0.5
R --iso 0.5:red:0 => above 0 and at most 1 => R --iso 0.5:red:1
R --iso 0.5:red:0.5:1 => is not a number => R --iso 0.5:red:0.5
R --iso 0.5 --rasterizer scanline => use --rasterizer planes => R --iso 0.5 --rasterizer planes
R --iso 0.5 --backend osmesa => leave out --compositor and --backend => R --iso 0.5
V --surface boundary => is for meshes => V --iso 0.5
I a.ply --max-volume 1e-15 => or more => I a.ply --max-volume 0.01

# volumes
V --smooth => leave it out => V
V --compositor gl-fragment => leave them out => V
V --integrator partial => use auto, exact, sampled or preintegrated => V --integrator exact
V --distribution sort-last --integrator preintegrated => use --integrator auto, exact or sampled
    => V --distribution sort-last --integrator auto
V -o a.deep.exr --integrator sampled => auto or exact => V -o a.deep.exr --integrator auto
V --iso 0.5 --integrator sampled => leave one of the two out => V --iso 0.5 --integrator exact
V --direct-send synchronous => add that, or leave it out => V
V --type int7 => use int8, uint8 => I v.raw $raw
V $raw => this file states them itself => V
I v.raw => give --dims WxHxD --type => I v.raw $raw
I v.raw --dims 8x8 --type float32 => three sizes; write WxHxD => I v.raw $raw
I v.raw $raw --spacing 1,0,1 => three numbers above 0; write X,Y,Z => I v.raw $raw --spacing 1,1,1
I v.raw $raw --skip 1 => give the right dimensions and type => I v.raw $raw
(printf 12345; cat v.raw) > w.raw; I w.raw $raw => or --skip 5 if a header is before them => I w.raw $raw --skip 5
tessera convert v.vti w.raw => read it with --dims 8x8x8 --type float32 => I w.raw $raw
I v.vti --check => leave it out => I v.vti
four_axes ''; I b.nrrd => add such a line if it is an axis of space
    => four_axes 'kinds: vector domain domain domain\n'; I b.nrrd
gzip a.nhdr; I a.nhdr.gz => unpack it with gunzip => gunzip a.nhdr.gz; I a.nhdr
mv a0.raw b.raw; I a.nhdr => put the file there => mv b.raw a0.raw; I a.nhdr

# inputs
I scans => name a file in it => I scan
I empty.vtu => again => I t.vtu
I t.vtu.txt => lists them => tessera formats
I /dev/null => give one that can be read twice => I v.vti
: | tessera render - -o a.png => it is empty; send a file to it => tessera render - -o a.png --size 9x9 < a.ply
I m.case => it names m.geo, but there is no such file; put it there => cp ensight/m.geo .; I m.case
rm case/constant/polyMesh/faces; I case => but there is no such file; put it there => I cavity
I alone.foam => move it into the directory of a case, or name that directory => mv alone.foam cavity; I cavity/alone.foam
mkdir one; cp scan/slice000.dcm one; I one => give a directory of slices => I scan
cp scan/slice000.dcm a.dcm; printf '' > scan/none.dcm; I scan/none.dcm => again => I scan
mv m_0000.vtu b.vtu; I m.pvtu => there is no such file => mv b.vtu m_0000.vtu; I m.pvtu
tessera render t%d.vtu -o a%d.png => choose steps that have it with --time-step FIRST:LAST
    => tessera render t%d.vtu -o a.png --size 9x9 --time-step 0:0
tessera render q%d.vtu -o a%d.png => which would be like q1.vtu
    => cp t.vtu q1.vtu; tessera render q%d.vtu -o a%d.png --size 9x9
tessera render nowhere/q%d.vtu -o a%d.png => check its name => R
printf words > b.meshb; I b.meshb => check what it is => I a.mesh
printf 123456789 > b.tets; I b.tets => are too few for a .tets header => tessera convert m.vtu b.tets; I b.tets
printf '\n' > b.txt; R --camera b.txt => give position, focal_point => R --camera c.txt
printf '<Xdmf><Domain/></Xdmf>' > b.xdmf; I b.xdmf => give a mesh or a volume => I a.xdmf
echo text > b.dcm; I b.dcm => finds no images in it; give a directory or a file of slices => I scan
printf '(2 3)\n(10 (0 1 ffffffff 0))\n' > b.cas; I b.cas => export CGNS or EnSight => I can.ex2
sed 's/0 0 1</1 1 0</' t.vtu > b.vtu; tessera render b.vtu -o a.png => give a mesh whose cells have volume => I t.vtu
for k in $(seq 71); do echo "INCLUDE '$((k + 1)).bdf'" > $k.bdf; done; I 1.bdf => write them as one file => I a.bdf
cp t1.vtu m_0001.vtu; I m.pvtu => write all pieces with the same fields => cp m_0000.vtu m_0001.vtu; I m.pvtu
tessera timing c.json => give a file that tessera render wrote with --timing => R --timing t.json; tessera timing t.json
R --like c.json => give a file that --report has written => R --report r.json; R --like r.json
echo '[1]' > b.json; R --like b.json => give a file that --report has written => R
echo '{"mesh": 1}' > b.json; R --like b.json => give a file that --report has written => R
echo '{"frames": []}' > b.json; R --like b.json => give a file that --report has written => R
R --like none.json => there is no such file => R

# outputs
tessera render m.vtu -o a.bmp => end it in .exr, .png => R
tessera render m.vtu -o nowhere/a.png => make the directory first, or name another
    => mkdir nowhere; S -o nowhere/a.png --size 9x9
mkdir b.png; R -o b.png => name a file, not a directory => R -o b.png/a.png
R -o - --report - => write one of them to a file => R -o - --report r.json
R -o - --resume => leave --resume out => R -o -
R -o - -o - => give it once => R -o -
tessera render m.vtu -o a.mp4 --peel 0.5 => give names of images => film m.vtu --peel 0.5
tessera render m.vtu -o - --peel 0.5 => give a file with -o => R --peel 0.5
printf 'exit 1' > ffmpeg; chmod +x ffmpeg; PATH=.:$PATH; S -o a.gif --size 9x9 => or write a_%04d.png => S -o a_%04d.png
R --frame-rate 25 => or leave it out => R
R --outline --annotation-layer l.jpg => give a .png or an .exr => R --outline --annotation-layer l.png
tessera render m.vtu -o a.exr --size 9x9 --half --background 1e6,0,0 => write 32-bit floats => R -o a.exr --background 1e6,0,0
tessera render m.vtu -o a.jpg --size 65536x1 => write .png => S --size 65536x1
PATH=/nowhere $program render m.vtu -o a.mp4 => write a_%04d.png => tessera render m.vtu -o a_%04d.png --size 9x9
tessera convert m.vtu a.xyz => choose .vtu or .tets => tessera convert m.vtu a.tets
tessera convert m.vtu a.stl => choose .vtu or .tets => tessera convert m.vtu a.tets
tessera convert m.vtu a.pvtu => only convert --pieces writes a mesh in pieces => tessera convert m.vtu a.pvtu --pieces 2
printf '\223NUMPY' > b.npy; tessera convert b.npy a.nrrd => write it as .raw with NumPy's tofile, or as .nrrd with pynrrd => I v.raw $raw
tessera convert v.vti a.png => choose .vti, .vtr, .nrrd => tessera convert v.vti a.nrrd
tessera convert m.vtu m.vtu => choose another name => tessera convert m.vtu b.vtu
tessera convert c.vtk b.tets => write .vtu, or smooth it => tessera convert c.vtk b.tets --smooth
sed '0,/0 1 2 3</s//0 1 2 1e99</' t.vtu > b.vtu; tessera convert b.vtu b.tets
    => write .vtu, which holds doubles => tessera convert b.vtu a.vtu
tessera convert uneven.vtr b.nrrd => write .vtr or .bricks => tessera convert uneven.vtr b.bricks
tessera convert m.vtu b.vtu --partition file => give the number of pieces too
    => tessera convert m.vtu b.pvtu --partition file --pieces 2
tessera generate castle b.vtu => kinds are demo, cube => tessera generate tet b.vtu
tessera generate cube b.vtu towers=3 => it takes n, jitter => tessera generate cube b.vtu n=3
tessera generate cube b.vtu n=many => is not a number => tessera generate cube b.vtu n=3
tessera generate cube b.vtu n=2 n=3 => give it once => tessera generate cube b.vtu n=3
tessera generate cube b.vtu n=1e9 => n must be in 1 .. 1000 => tessera generate cube b.vtu n=9
tessera generate cube b.vtu n => write NAME=VALUE => tessera generate cube b.vtu n=2
R -o "$(printf 'n%.0s' $(seq 300)).png" => give a shorter name => R
ln -s loop loop; R -o loop/a.png => check the disk and the file system => R
(trap '' XFSZ; ulimit -f 0; tessera convert m.vtu b.vtu) => free some space or name another disk
    => tessera convert m.vtu b.vtu
(ulimit -s 256; R) => ulimit -s 8192 => ulimit -s 8192; R
R > /dev/full -o - => free disk space, or keep the reading program open => R -o - > b.png
at_terminal tessera render m.vtu -o - => is a terminal; send it to a file => R -o - > b.png
TMPDIR=/proc tessera render - -o a.png < a.ply => or set TMPDIR to another directory
    => tessera render - -o a.png --size 9x9 < a.ply

# ranks
R --projectors 2 => or start more with mpirun -n => ranks --projectors 2
ranks --balance even => leave it out => ranks
'''


def lines(rows):
    return "".join(" ".join(map(str, row)) + "\n" for row in rows)


CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]  # outwards
VIEW = '{"position": [0, 0, 9], "focal_point": [0, 0, 0], "view_up": [0, 1, 0], "parallel_scale": 2}'
CAMERA = "position 0 0 9\nfocal_point 0 0 0\nview_up 0 1 0\nparallel_scale 2\n"


def pvcc(name, *numbers):
    elements = "".join(f'<Element index="{index}" value="{number}"/>' for index, number in enumerate(numbers))
    return f'<Property name="Camera{name}">{elements}</Property>\n'


PVCC = (
    '<PVCameraConfiguration version="1.0"><Proxy group="views">\n'
    + pvcc("Position", 0, 0, 5) + pvcc("FocalPoint", 0, 0, 0) + pvcc("ViewUp", 0, 1, 0) + pvcc("ViewAngle", 30)
    + "</Proxy></PVCameraConfiguration>\n"
)
COLORS = """[{"Name": "two", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 1, 1, 1, 0, 0],
 "Points": [0, 0, 0.5, 0, 1, 1, 0.5, 0], "ScalarOpacityUnitDistance": 1}]"""
TRACE = """{"traceEvents": [{"name": "project", "cat": "tessera", "ph": "X", "ts": 0, "dur": 9, "pid": 0, "tid": 0,
 "args": {"cpu_us": 9, "frame": 0, "bytes": 0, "messages": 0}}],
 "otherData": {"tets": 1, "frames": 1, "width": 9, "height": 9, "ranks": 1}}"""
SERIES = '{"file-series-version": "1.0", "files": [{"name": "m.vtu", "time": 0}, {"name": "m.vtu", "time": 1}]}'
NRRD = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n"
DETACHED = NRRD[: NRRD.index("encoding")] + "encoding: raw\ndata file: a%d.raw 0 1 1\n"
META = """ObjectType = Image\nNDims = 3\nBinaryData = False\nDimSize = 2 2 2\nElementType = MET_UCHAR
ElementDataFile = LOCAL\n1 2 3 4 5 6 7 8\n"""


def array(kind, name, values, components=1):
    name = f'Name="{name}" NumberOfComponents="{components}"'
    return f'<DataArray type="{kind}" {name} format="ascii">{values}</DataArray>\n'


def vtk_xml(kind, whole, piece, values, geometry):
    return (
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"><{kind} {whole}>\n<Piece {piece}>\n'
        f"<PointData>{array('Float64', 'f', values)}</PointData>\n{geometry}</Piece></{kind}></VTKFile>\n"
    )


CELLS = array("Int64", "connectivity", "0 1 2 3") + array("Int64", "offsets", 4) + array("UInt8", "types", 10)
VTU = vtk_xml(
    "UnstructuredGrid", "", 'NumberOfPoints="4" NumberOfCells="1"', "0 1 2 3",
    f"<Points>{array('Float64', 'p', '0 0 0 1 0 0 0 1 0 0 0 1', 3)}</Points>\n<Cells>\n{CELLS}</Cells>\n",
)
UNEVEN = vtk_xml(
    "RectilinearGrid", 'WholeExtent="0 2 0 1 0 1"', 'Extent="0 2 0 1 0 1"', "0 1 2 3 4 5 6 7 8 9 10 11",
    f"<Coordinates>{''.join(array('Float64', 'x', axis) for axis in ('0 1 3', '0 1', '0 1'))}</Coordinates>\n",
)
LEGACY = (
    f"# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n{lines(CORNERS)}CELLS 1 5\n"
    "4 0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nSCALARS f float 1\nLOOKUP_TABLE default\n1\n"
)
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    f"property list uchar int vertex_indices\nend_header\n{lines(CORNERS)}{lines((3, *face) for face in FACES)}"
)
SU2 = f"NDIME= 3\nNELEM= 1\n10 0 1 2 3 0\nNPOIN= 4\n{lines((*p, k) for k, p in enumerate(CORNERS))}"
MEDIT = (
    f"MeshVersionFormatted 2\nDimension 3\nVertices\n4\n{lines((*p, 0) for p in CORNERS)}"
    "Tetrahedra\n1\n1 2 3 4 0\nEnd\n"
)
ZONE = """ZONE T="%s", N=4, E=1, DATAPACKING=POINT, ZONETYPE=FETETRAHEDRON
0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n1 2 3 4\n"""
TECPLOT = f'VARIABLES="X" "Y" "Z" "f"\n{ZONE % "a"}'
TWO_ZONES = TECPLOT + ZONE % "b"
NASTRAN = (
    "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,5,0.,0.,1.\n"
    "CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCTETRA,9,1,1,2,3,4\nENDDATA\n"
)
PLOT3D = "2 2 2\n0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1\n0 0 0 0 1 1 1 1\n"
SOLUTION = "2 2 2\n0.5 0 1 0\n" + 5 * "1 2 3 4 5 6 7 8\n"
ITEM = '<DataItem Dimensions="%s" Format="XML" NumberType="Float" Precision="8">%s</DataItem>'
XDMF = f"""<Xdmf Version="3.0"><Domain><Grid Name="mesh" GridType="Uniform">
<Topology TopologyType="Tetrahedron" NumberOfElements="1">{ITEM % ("1 4", "0 1 2 3")}</Topology>
<Geometry GeometryType="XYZ">{ITEM % ("4 3", "0 0 0 1 0 0 0 1 0 0 0 1")}</Geometry>
<Attribute Name="f" AttributeType="Scalar" Center="Node">{ITEM % (4, "1 2 3 4")}</Attribute>
</Grid></Domain></Xdmf>\n"""
ENSIGHT = {
    "m.case": "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: m.geo\n",
    "ensight/m.geo": "made\nhere\nnode id off\nelement id off\npart\n         1\nbox\ncoordinates\n         4\n"
    + "".join(f"{p[axis]:12.5e}\n" for axis in range(3) for p in CORNERS)
    + "tetra4\n         1\n         1         2         3         4\n",
}
FILES = ENSIGHT | {
    "c.json": VIEW, "scans/": "", "empty.vtu": "", "empty.ply": "",
    "t.vtu.txt": "nothing known", "t.vtu": VTU, "t0.vtu": VTU, "t1.vtu": VTU.replace('"f"', '"g"'), "c.vtk": LEGACY,
    "a.ply": PLY, "uneven.vtr": UNEVEN, "a.nhdr": DETACHED, "a0.raw": "1234", "a1.raw": "5678", "a2.raw": "9",
    "alone.foam": "", "a.xyz": PLOT3D,
}

# A command, the file that it reads, its text (none: it is there), and changes: what is replaced, by what, the advice.
DAMAGED = [
    ("R --camera", "c.txt", CAMERA, r"""
view_up 0 1 0\n => view_up 0 1 0\nview_up 0 1 0\n => is given twice; keep one
0 0 9 => 0 9 => numbers; it takes 3
parallel_scale 2 => parallel_scale 2\nview_angle 9 => keep the first for an orthographic view
parallel_scale 2\n => => give the first for an orthographic view
position 0 0 9\n => => give the position of the eye, three numbers"""),
    ("R --camera", "d.json", VIEW, r"""
9 => "9" => give numbers only"""),
    ("R --camera", "c.pvcc", PVCC, r"""
PVCameraConfiguration => Camera => save the camera in ParaView as .pvcc
index="2" => index="3" => it must be 0, 1 or 2
<PVC => <!DOCTYPE a>\n<PVC => a ParaView camera has none, save it again
</Proxy> => => not valid XML
<Element index="2" value="5"/> => => 2 of 3 numbers; save the camera again"""),
    ("R --transfer-function", "f.txt", "0 1 0 0 0.5\n1 0 0 1 2\n", r"""
0 1 0 0 0.5 => 0 1 0 0 0,5 => write decimals with a point
0.5 => -1 => it must not be negative
0 1 0 0 0.5\n1 0 0 1 2\n => # nothing\n => give at least one line `value r g b extinction`"""),
    ("R --transfer-function", "f.json", COLORS, r"""
1, 1, 0, 0] => 1, 1, 0] => the list is cut off or lacks a number
1, 1, 0, 0] => 1, 255, 0, 0] => write components from 0 to 1, not bytes
[0, 0, 0.5, 0 => [0, 9, 0.5, 0 => it must be 0 to 1
Distance": 1 => Distance": 0 => it is a length in world units
RGBPoints => IndexedColors => give a continuous map with RGBPoints
[{ => [1, { => a map is an object with RGBPoints
}] => ] => not valid JSON"""),
    ("tessera timing", "t.json", TRACE, r"""
"ts": 0 => "ts": 1e99 => correct it or trace the run again
"width": 9 => "width": 0.5 => correct it"""),
    ("film", "s.series", SERIES, r"""
files => file => check that it is a ParaView file series
"name": "m.vtu", "time": 0 => "name": "v.vti", "time": 0 => give volumes only
"name": "m.vtu", "time": 1 => "name": "v.vti", "time": 1 => give it alone or among volumes"""),
    ("I", "a.nrrd", NRRD, r"""
 8\n => => of 8 numbers; the file is truncated or damaged
 8\n => 999 => the file is damaged or of another type, write it again
uint8 => block => write integers, float or double
encoding: ascii => encoding: bzip2 => write raw, gzip, ascii or hex
encoding => byte skip: -1\nencoding => state where they begin
dimension: 3\nsizes: => dimension: 4\nkinds: vector domain domain domain\nsizes: 65 => write at most 64
dimension: 3\nsizes: => dimension: 5\nkinds: list domain domain domain time\nsizes: 2 2 => write only one such axis
dimension: 3\nsizes: => dimension: 5\nkinds: vector domain domain domain vector\nsizes: 2 2 => write only one such axis
dimension: 3\nsizes: => dimension: 5\nkinds: time domain domain domain vector\nsizes: 2 2
    => or write one step alone"""),
    ("I", "a.nhdr", DETACHED, r"""
0 1 1 => 0 2 1 => list all its slices
data file => line skip: 1\ndata file => is for one file of samples; leave it out"""),
    ("I", "a.mha", META, r"""
ElementType => CompressedData = True\nElementType => write them as binary numbers
MET_UCHAR => MET_NONE => write MET_UCHAR, MET_SHORT
NDims = 3 => NDims = 2 => a volume has three, or four with time"""),
    ("I", "a.vtu", VTU, r"""
>0 1 2 3</DataArray>\n<DataArray type="Int64" Name="offsets"
    => >0 1 2 9</DataArray>\n<DataArray type="Int64" Name="offsets" => write cells and points from one mesh
>10< => >64< => split such cells into tetrahedra first
>10< => >42< => is a polyhedron without a list of its faces; write it with its faces
NumberOfPoints="4" => NumberOfPoints="99999999999" => export it again
VTKFile type => File type => check that it is one
</VTKFile> => => the file is truncated or damaged, export it again"""),
    ("I", "a.vtk", LEGACY, r"""
# vtk DataFile Version 3.0 => vtk => check that it is a legacy VTK file
SCALARS => SCALRS => correct it, or have the file written again
CELL_DATA 1 => CELL_DATA 5 => have the file written in another format"""),
    ("I", "b.ply", PLY, r"""
element face 4 => element face 3 => close its holes
0 0 1\n => 1 1 0\n => give a closed surface
1 0 0\n => 1 0 nan\n => of the surface is not finite; correct it"""),
    ("I", "a.su2", SU2, r"""
10 0 => 10 7 => points count from 0, correct it
10 0 => 110 0 => have SU2 write .vtu
NDIME= 3 => NDIME= 2 => give one of 3 dimensions"""),
    ("I", "a.mesh", MEDIT, r"""
MeshVersionFormatted => Mesh => check what it is
Dimension 3 => Dimension 2 => give a volume
Tetrahedra => Triangles => give a mesh of tetrahedra, hexahedra, prisms or pyramids
1 2 3 4 0 => 1 2 3 5 0 => the file is damaged, export it again"""),
    ("I", "a.tec", TECPLOT, r"""
1 2 3 4\n => 1 2 3 4\nVARIABLES="X" "Y"\n => write zones with other variables to another file
1 2 3 4\n => 1 2 3.5 4\n => 3.5 is among the nodes of elements; export the file again
0 1 0 3 => 0 one 0 3 => 'one' is among the values, and is not a number; export the file again
N=4 => N 4 => is not a key of a zone with a value; export the file again
T="a", => T="a => a quotation is not closed; close it, or export the file again
ZONE => ZONES => it has no ZONE; check that it is a text of Tecplot's
=POINT => =LINES => the packing 'LINES' is not supported; write POINT or BLOCK
VARIABLES= => FILETYPE=SOLUTION\nVARIABLES= => it holds a solution without its grid; write FILETYPE=FULL
"X" "Y" "Z" "f" => X,Y,(Z),f => VARIABLES has no name here; put the names in quotation marks
"Z" "f" => => give a file with all three
E=1 => E=1, VARLOCATION=([4]=CELLCENTERED) => values at cells cannot be packed by point; write DATAPACKING=BLOCK"""),
    ("I", "b.tec", TWO_ZONES, r"""
"b", N=4 => "b", VARSHARELIST=([1]=1), N=3 => export the file again
"b", N=4, E=1 => "b", N=4, E=0, CONNECTIVITYSHAREZONE=1 => with which it shares them; export the file again"""),
    ("I", "a.bdf", NASTRAN, r"""
CTETRA,9,1,1,2,3,4 => => give a deck with a volume
1,2,3,4 => 1,2,3,5 => element 9 uses GRID 5, which the file does not have; add it, or add the file that contains it
GRID,1 => \0GRID,1 => it is not text; give a Nastran bulk data file
CORD2R => CORD3G => write the points in the basic system
CTETRA => =(99999999),*1,==\nCTETRA => it replicates more than 10000000 entries; write them out
BEGIN BULK => INCLUDE 'b.bdf' => it includes 'b.bdf', and there is no such file; put it there"""),
    ("I", "b.xyz", PLOT3D, r"""
2 2 2\n0 => 2 2 3\n0 => is truncated or of another kind (give a solution file with --q)
0 1 0 => 0 1d0 0 => write it with E
0 1 0 => 2*0 1 0 => write each
0 1 0 => 0 one 0 => a PLOT3D text file contains only numbers"""),
    ("I a.xyz --q", "a.q", SOLUTION, r"""
2 2 2 => 2 2 3 => give the solution for this grid
1 2 3 4 5 6 7 8\n => => it is truncated or of another kind (function file, OVERFLOW)"""),
    ("I", "a.p3d", '{"filenames": [{"xyz": "a.xyz"}]}', r"""
[{"xyz": "a.xyz"}] => {"xyz": "a.xyz"} => check that it is ParaView's"""),
    ("I", "a.xdmf", XDMF, r"""
<Xdmf => <!DOCTYPE Xdmf [<!ENTITY a "b">]>\n<Xdmf => it defines its own XML entities, which is not supported; write it without them
<Grid => <xi:include href="b.xdmf" xmlns:xi="http://www.w3.org/2001/XInclude"/><Grid => write both as one file
Name="f" => Name="f" Reference="XML" => write the element itself there, or save the file as .vtu
Format="XML" NumberType="Float" Precision="8" => Format="Binary" NumberType="Float" Precision="2"
    => write floats of 4 or 8 bytes
Tetrahedron => Nothing => the file or its data are damaged, write it again"""),
    ("I", "b.ex2", "", r"""
HEX8 => BLOB => write tetrahedra, wedges, pyramids or hexahedra
CDF\x01 => ???? => check that it is an Exodus file"""),
]


def make_data(tessera, folder: Path):
    """Data shared by rows, and whole files that DAMAGED changes."""
    for command in ("generate cube m.vtu n=3", "generate ripples v.vti n=8", "convert v.vti v.raw",
                    "convert m.vtu m.pvtu --pieces 2"):
        done = subprocess.run([tessera, *command.split()], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{command}: {done.stderr}")
    cubes = guide_files.Cubes(2)
    for case in ("case", "cavity"):
        guide_files.foam_case(folder / case, cubes)
    guide_files.exodus_mesh(folder / "can.ex2", cubes)
    guide_files.dicom_series(folder / "scan", 4)
    for name, content in FILES.items():
        if name.endswith("/"):
            (folder / name).mkdir()
            continue
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(content)
    shutil.copy(folder / "can.ex2", folder / "b.ex2")
    for _, name, whole, _ in DAMAGED:
        if whole:
            (folder / name).write_text(whole)


def is_lacking(said):
    """Whether this build or machine cannot do what the command asks for."""
    return re.search("which is not installed|this build (leaves|has no)|out of pty devices", said)


def rows_of(text):
    """Fields of each row; lines that are indented continue one."""
    whole = text.replace("\n    ", " ").replace("=> =>", "=>  =>")
    return [line.split(" => ") for line in whole.splitlines() if " => " in line]


class Trial:
    """Runs commands, each in a copy of the data."""

    def __init__(self, tessera, folder: Path):
        self.tessera, self.folder = tessera, folder
        (folder / "data").mkdir()
        (folder / "bin").mkdir()
        (folder / "bin/tessera").symlink_to(tessera)
        make_data(tessera, folder / "data")

    def copy(self):
        place = Path(tempfile.mkdtemp(dir=self.folder))
        return shutil.copytree(self.folder / "data", place, dirs_exist_ok=True)

    def run(self, command, place):
        """Status, lines that report a fault, and all output."""
        environment = os.environ | {
            "PATH": f"{self.folder}/bin:{os.environ['PATH']}", "program": self.tessera, "OMPI_ALLOW_RUN_AS_ROOT": "1",
            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
        }
        done = subprocess.run(["bash", "-c", FUNCTIONS + command], cwd=place, env=environment, timeout=600,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        said = done.stdout.decode(errors="replace").replace("\r", "")
        faults = [line for line in said.splitlines() if line.startswith("tessera: ") and "warning: " not in line]
        # Long lines are wrapped.
        return done.returncode, faults, "\n".join((said, re.sub(r"\n +", " ", said), re.sub(r"\n +", "; ", said)))

    def refused(self, command, advice, place, warns=False):
        """What is wrong with the output: one line reports the error with the advice, and no image is written."""
        status, faults, said = self.run(command, place)
        is_refused = status in (2, 3) and len(faults) == 1 and not (status == 2 and (place / "a.png").exists())
        if is_lacking(said) or (advice in said and (is_refused or (status == 0 and warns))):
            return []
        return [f"{command}\n  status {status}, '{advice}' awaited: {said[: len(said) // 3].strip()}"]

    def followed(self, command, advice, followed):
        place = self.copy()
        wrong = self.refused(command, advice, place, warns=True)
        status, _, said = self.run(followed, place)
        if (status != 0 or advice in said) and not is_lacking(said):
            wrong.append(f"{followed}\n  status {status}, after '{advice}': {said.strip()}")
        return wrong

    def damaged(self, command, name, _, changes):
        place = self.copy()
        whole = (place / name).read_bytes()
        status, _, said = self.run(f"{command} {name}", place)
        wrong = [f"{command} {name}\n  status {status}: {said.strip()}"] if status and not is_lacking(said) else []
        (place / "a.png").unlink(missing_ok=True)
        for old, new, advice in rows_of(changes):
            old, new = (part.encode().decode("unicode_escape").encode("latin1") for part in (old, new))
            assert old in whole, (name, old)
            (place / name).write_bytes(whole.replace(old, new, 1))
            wrong += self.refused(f"{command} {name}", advice, place)
        return wrong

    def unread(self):
        """Formats that are known by their names, and not read."""
        place = self.copy()
        listed = json.loads(subprocess.run([self.tessera, "formats", "--json"], check=True, capture_output=True).stdout)
        wrong = []
        for form in listed:
            # A Fluent file of this name is refused as HDF5, which its content has to be.
            is_unread = form["holds"] == "not read" and form["name"] != "Fluent HDF5"
            for extension in form["extensions"] if is_unread else []:
                (place / f"b{extension}").write_text("nothing")
                wrong += self.refused(f"I b{extension}", f"({form['name']}) is not supported; {form['remark']}", place)
        return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tessera", type=os.path.abspath, required=True)
    parser.add_argument("--without-mpi", action="store_true")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    has_mpi = not options.without_mpi and shutil.which("mpirun")
    rows = [row for row in rows_of(ROWS) if has_mpi or "ranks" not in "".join(row)]
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
        trial = Trial(options.tessera, Path(name))
        tasks = [(trial.followed, row) for row in rows] + [(trial.damaged, row) for row in DAMAGED]
        tasks = [task for task in [*tasks, (trial.unread, ())] if options.only in str(task[1])][:: options.every]
        wrong = [line for lines in pool.map(lambda task: task[0](*task[1]), tasks) for line in lines]
    print(*wrong, f"{len(tasks)} rows, {len(wrong)} wrong", sep="\n")
    sys.exit(1 if wrong or not tasks else 0)


if __name__ == "__main__":
    main()
