// SPDX-License-Identifier: BSD-3-Clause
// Long: the one table from which help, command line, states and messages are generated.
#include <array>

#include "tessera/program/options.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using enum Trait;

constexpr Trait pictures = render | serve;
constexpr Trait reading = pictures | info | convert | chart;

constexpr OptionRow input_rows[] = {
    {"input", "", reading | positional | required,
     "mesh: .vtu .pvtu .vtk .vtm .foam .case .cgns .ex2 .ele .tets .stl ...; volume: .vti .pvti .vtr .pvtr .vtk .mhd "
     ".nrrd .nii .nii.gz .raw"},
    {"more", "", render | positional | list,
     "more meshes, which form a time series with INPUT; a .pvd, a .series or mesh_%04d.vtu is a time series by itself"},
    {"kind", "", generate | positional | required, "what to make, see below"},
    {"out", "", convert | positional | required,
     "mesh: .vtu, .tets, or .pvtu with --pieces; volume: .vti .vtr .nrrd .raw .bricks"},
    {"out", "", generate | positional | required, "mesh: .vtu or .tets; volume: .vti .nrrd .raw .bricks"},
    {"parameters", "", generate | positional | list, "NAME=VALUE ..."},
    {"trace", "", timing | positional | list | required, "files that render --timing wrote; several are compared"},
    {"command", "", help | positional, "one of the commands; without it, the list of commands"},
    {"shell", "", completion | positional | required, "bash, zsh or fish"},
};

constexpr OptionRow server_rows[] = {
    {"bind", "ADDRESS", serve, "address to listen at (default: 127.0.0.1, which only this machine can reach)"},
    {"port", "PORT", serve, "port to listen at (default: a free one)"},
    {"latency", "MS", serve,
     "while the view moves, the image size is chosen so that an image appears this long after an event (default 100)"},
    {"tls-certificate", "FILE", serve, "PEM file of the certificate: serve over https"},
    {"tls-key", "FILE", serve, "PEM file of the certificate's key"},
    {"allow-host", "NAME", serve | list,
     "a host name that the browser's address may have, in addition to loopback and --bind; may be repeated"},
};

constexpr OptionRow data_rows[] = {
    {"field", "NAME", reading | basic | state,
     "field to show: NAME, NAME:mag or NAME:x; prefix point: or cell: if both exist"},
    {"smooth", "", reading | flag | meshes | state | data, "average cell data to the points"},
    {"warp", "NAME[:FACTOR]|off", reading | meshes | state | data,
     "meshes: move points by FACTOR (default: 1) times this vector field; off: do not apply Exodus displacements "
     "either"},
    {"q", "FILE", reading | meshes | data, "PLOT3D solution file, if it is not next to the grid"},
    {"max-volume", "VOLUME", reading | meshes | data, "surfaces: largest volume of the tetrahedra that fill them"},
    {"time-step", "STEP|all|FIRST:LAST[:STRIDE]", reading | basic | state | data,
     "Exodus, OpenFOAM, 4-D NIfTI, NRRD, .pvd ...: time step, counted from 0 (default: the last of the file); render "
     "also makes a film of several steps"},
    {"block", "NAME", pictures | info | chart | basic | list | meshes | state | data,
     "files in blocks: draw only this block, one of those that info lists; may be repeated"},
    {"block", "NAME", convert | list,
     "mesh in blocks: write only this block; may be repeated; output to .bricks: samples per side of a brick (default "
     "64)"},
    {"drop-duplicates", "", reading | flag | meshes | state | data,
     "draw cells with the same corners only once, where parts of the mesh are given twice"},
    {"scale", "X,Y,Z", reading | data,
     "factors for the axes (default: 1,1,1; if x and y are in degrees but z is not, z is scaled so that the box is not "
     "thinner than 1:20)"},
    {"clip", "PX,PY,PZ,NX,NY,NZ|box:X0,Y0,Z0,X1,Y1,Z1", reading | basic | list | state | data,
     "cut away everything behind a plane (a point on it and its normal, which points to what is kept) or outside of a "
     "box; may be repeated"},
    {"threshold", "MIN,MAX", reading | basic | state | data, "keep whole cells whose values are all in this range"},
    {"higher-order-tolerance", "REL", reading | meshes | data,
     "largest error of the tets that replace higher-order cells, relative to the mesh's diagonal and the field's range "
     "(default: by --accuracy)"},
    {"higher-order-tets", "N", reading | meshes | data,
     "about how many tets may replace higher-order cells (default: 262144, more for many cells; 0: linear cells "
     "with the same corners)"},
    {"labels", "on|off", pictures | volumes | data,
     "volumes: whether values are labels, each of which fills its sample's voxel (default: by the header or the "
     "values)"},
};

constexpr OptionRow raw_rows[] = {
    {"dims", "WxHxD", reading | data, ".raw: samples along x, y, z (or NAME_WxHxD_uint8.raw)"},
    {"type", "TYPE", reading | data, ".raw: uint8, int16, uint16, float32, ..."},
    {"spacing", "X,Y,Z", reading | data, ".raw: world units between samples (default 1,1,1)"},
    {"origin", "X,Y,Z", reading | data, ".raw: world position of the first sample (default 0,0,0)"},
    {"endian", "little|big", reading | data, ".raw: byte order (default little)"},
    {"skip", "BYTES", reading | data, ".raw: bytes before the first sample"},
};

constexpr OptionRow color_rows[] = {
    {"transfer-function", "FILE|PRESET|JSON", pictures | chart | basic | state | function | look | knots,
     "file or preset (see the guide), or JSON itself"},
    {"rescale", "", pictures | chart | flag | state | look | knots,
     "stretch a transfer function file's values over the field's range"},
    {"unit-distance", "LENGTH", pictures | chart | state | look | knots,
     "world length to which a file's opacity applies (default: the file's, else mean thickness / 10)"},
    {"opacity,opacity-scale", "FACTOR", pictures | chart | basic | state | look | knots, "multiplies the extinction"},
    {"range", "MIN,MAX", pictures | basic | state | look | knots,
     "range of values that colours and opacities span; a file is stretched over it (default: the field's range for a "
     "preset, 0.5 to 99.5 % of the volume without one)"},
    {"log", "", pictures | basic | flag | state | look | knots, "colours and opacities by the logarithm of the value"},
    {"opacity-points", "T:A,...", pictures | basic | state | look | knots,
     "opacity per unit distance at fractions of the range, like 0:0,0.3:0.02,1:0.8"},
    {"blend", "linear|display", pictures | state | look, "linear light (default), or sRGB values as VTK does"},
    {"emission", "absorption|independent", pictures | chart | state | look | settings,
     "source term (default: absorption)"},
    {"background", "R,G,B|#RRGGBB|NAME", pictures | basic | state,
     "linear R,G,B, sRGB #rrggbb or a CSS colour name; without it, the image has an alpha channel"},
};

constexpr OptionRow view_rows[] = {
    {"camera", "FILE|JSON", pictures | chart | basic | state | camera | view,
     "view or list of views: .json .pvcc text, or JSON itself (default: frames the mesh)"},
    {"view", "front|back|left|right|top|bottom|iso|+x|-x|+y|-y|+z|-z", pictures | basic | state | view,
     "direction: front looks along +y, at a patient's face; +x looks along +x (default: upright, a little from the "
     "right and above)"},
    {"up", "X,Y,Z", pictures | state | view, "world direction that points up (default: z; y in views along z)"},
    {"azimuth", "DEGREES", pictures | basic | state | view, "turns the eye around the up axis, to the right"},
    {"elevation", "DEGREES", pictures | basic | state | view, "turns the eye upwards, after --azimuth"},
    {"zoom", "FACTOR", pictures | basic | state | view, "enlarges the middle of the image by this factor"},
    {"fit", "", pictures | flag | state | view, "with --camera: keep the file's direction, but frame the data"},
    {"orbit", "N", render | basic | view, "N frames of one turn around the view's up axis"},
    {"size", "WxH", pictures | chart | basic | state, "pixels (default: the camera file's, else 1024x1024)"},
    {"projection", "orthographic|perspective", pictures | chart | state | view,
     "projection of the default view (default: orthographic)"},
};

constexpr OptionRow surface_rows[] = {
    {"iso", "VALUE[:COLOUR[:OPACITY]]", pictures | basic | list | state | look | settings,
     "the surface where the field has this value, lit, within the volume (default: the transfer function's colour at "
     "this value, opacity 1); may be repeated"},
    {"surface", "boundary|BLOCK|FILE[:COLOUR[:OPACITY]]", pictures | basic | list | state | surfaces | look | settings,
     "meshes: the boundary, or a block, patch or side set of the mesh (colour: the field's; opacity 1), or the "
     "triangles of a file (light grey), lit, within the volume; may be repeated"},
    {"shade", "", pictures | basic | flag | state | settings,
     "Blinn-Phong by the field's gradient, with a light at the camera, or --light"},
    {"no-shade", "", pictures | flag | volumes | state | look | settings,
     "volumes: no shading, which is otherwise on for scans of patients"},
    {"light", "[world:]X,Y,Z", pictures | state | settings,
     "--shade: direction towards the light, as right, up and towards the eye, or along the world's axes (default "
     "0,0,1)"},
};

constexpr OptionRow annotation_rows[] = {
    {"color-bar", "", pictures | basic | place | state | annotation,
     "draw the transfer function's colours and opacity; =left, =top or =bottom sets the place"},
    {"color-bar-title", "TEXT", pictures | state | annotation, "title above the colour bar (default: {field})"},
    {"color-bar-range", "LOW,HIGH", pictures | state | annotation,
     "values at the ends of the colour bar (default: the transfer function's)"},
    {"color-bar-scale", "linear|log", pictures | state | annotation,
     "scale of the values along the colour bar (default: log with --log)"},
    {"field-unit", "TEXT", pictures | state | annotation, "unit of the field's values, for the colour bar's title"},
    {"axes", "triad|box|both", pictures | basic | place | state | annotation,
     "draw the directions of the axes; =box: a box around the data with round values along it; =both"},
    {"outline", "", pictures | basic | flag | state | annotation, "draw the box of the data"},
    {"scale-bar", "", pictures | basic | place | state | annotation,
     "draw a bar of a round length; =bottom, =bottom-left ... sets the place"},
    {"length-unit", "TEXT", pictures | state | annotation, "unit of length of the world, for axes and scale bar"},
    {"annotate", "[PLACE:]TEXT", pictures | basic | list | state | annotation,
     "write this at top-left (default), top, ... bottom-right; {field} {time} {file} {frame} {min} {max} are filled "
     "in; "
     "may be repeated"},
    {"annotation-color", "R,G,B|NAME", pictures | state | annotation,
     "colour of text and lines (default: readable on the background)"},
    {"annotation-size", "PIXELS", pictures | state | annotation,
     "height of the text (default: 2 % of the image's height)"},
    {"annotation-layer", "FILE", render | annotation,
     ".png or .exr: the annotation alone, with alpha; the images have no annotation"},
};

constexpr OptionRow output_rows[] = {
    {"o,output", "FILE", render | basic | list | required,
     "image: .exr .png .jpg .tif .pfm .deep.exr, frame_%04d.png for several; film: .mp4 .mov .mkv .webm .gif; - for "
     "a "
     "PNG on standard output; may be repeated"},
    {"o,output", "FILE", presets, "draw the presets into this image: .png .exr .jpg .tif"},
    {"frame-rate", "FPS", render | basic, "films: frames per second (default 25)"},
    {"peel", "THRESHOLD[:LAYERS]", render,
     "also write the image in layers, cut wherever a ray's opacity since the last cut reaches THRESHOLD: a.exr has "
     "a.layer1.exr ..., a .deep.exr has one sample per layer (default: 4 layers)"},
    {"half", "", pictures | flag | state, ".exr with 16-bit floats"},
    {"png-bits", "8|16", pictures | state, "bits per channel of .png and .tif (default: 8)"},
    {"resume", "", render | flag, "skip frames whose images exist"},
    {"report", "FILE", render | basic, "JSON file with all choices and counters; - for standard output"},
    {"timing", "FILE", render, "Chrome trace-event JSON file of stages and threads"},
    {"progress", "", render | flag, "show a progress line (default: if stderr is a terminal)"},
    {"quiet", "", render | convert | generate | chart | flag, "write only errors and warnings to stderr"},
    {"json", "", info | formats | flag, "for machines"},
    {"check", "", info | flag, "meshes: report overlapping cells, folds, unmatched faces, slivers and duplicates"},
    {"pieces", "N", convert, "write OUT.pvtu and N pieces, for mpirun"},
    {"partition", "curve|file|random", convert,
     "how cells are divided into pieces: curve (compact, the default), file (order kept), random"},
    {"subdivide", "TIMES", convert, "meshes: number of times that every tetrahedron is cut into eight"},
    {"csv", "FILE", timing, "the printed numbers as a table"},
    {"figure", "FILE", timing, "stacked bars, .svg or .png"},
    {"all", "", help | flag, "every option"},
    {"man", "", help | flag, "as a manual page (roff)"},
};

constexpr OptionRow accuracy_rows[] = {
    {"integrator", "auto|exact|sampled:N|preintegrated[:N]|partial", pictures | state | settings,
     "how the colour of a ray segment is computed (default: auto); volumes: auto, exact, sampled or preintegrated"},
    {"accuracy", "EPS", pictures | basic | state | settings, "auto: largest error in linear RGBA (default 1e-4)"},
    {"deep-accuracy", "EPS", render,
     ".deep.exr: largest error in linear RGBA when a sample is cut at any depth (default 1e-3)"},
    {"rasterizer", "planes|scanline|device", render | meshes,
     "how cells become ray segments (default: planes; the paper's: scanline; device: as planes, by gl-compute)"},
    {"step", "VOXELS", pictures | volumes | state | settings,
     "volumes: length of a step of sampled and preintegrated (default 0.5)"},
    {"brick-size", "VOXELS", render | volumes, "volumes: voxels per side of a brick (default 32)"},
    {"edge-bricks", "variable|fixed", render | volumes,
     "volumes: memory of bricks at the end of an axis: only what they need (default), or as much as the other bricks"},
    {"cache", "lru|proximity", render | volumes,
     "volumes: which brick is evicted first when memory is full (default lru)"},
    {"preload", "BRICKS", render | volumes,
     "volumes, --cache proximity: bricks per frame that are loaded ahead for the next view (default 0)"},
    {"threads", "T", pictures | chart | basic | data | machine, "threads (default: all cores)"},
    {"tile-size", "PIXELS", render | meshes, "pixels per side of a thread's tile (default 32)"},
    {"memory", "SIZE", pictures | chart | basic | data | machine,
     "budget of the frame buffers, or of a volume's bricks, like 512M (default 4G)"},
    {"without", "WORD,...", render,
     "switch off optimizations, to measure what they save: culling, skipping, termination, lattice, sharing, merging"},
    {"repeat", "K", render, "render each frame K times and print frame_ms median and min"},
    {"verify", "K", render | basic, "check K random pixels per frame against the exact reference"},
    {"preset", "juliachs-2007", render,
     "a published method as a whole: scanline, raw segments, sampled:4, gl-fragment, 16x16 tiles, processes in two "
     "roles; other options override it"},
    {"budget-seconds", "S", chart, "time for all measurements, without reading (default 60)"},
    {"repeat", "K", chart, "frames per method, if the budget allows (default 5)"},
    {"pixels", "N", chart,
     "number of random pixels from which errors are computed (default: as many as the time allows)"},
    {"peer", "FILE", chart | list, "measured images of other programs (JSON)"},
    {"json", "FILE", chart, "JSON file with all measurements"},
    {"csv", "FILE", chart, "the same as a table"},
    {"figure", "FILE", chart | list, "the chart, .svg or .png; may be repeated"},
};

constexpr OptionRow device_rows[] = {
    {"compositor", "cpu|gl-compute|gl-fragment", render,
     "which device sorts and composites ray segments: the CPU (default), compute shaders, or fragment shaders as in "
     "the paper"},
    {"backend", "auto|cpu|osmesa|egl", render,
     "where OpenGL comes from: auto is a GPU if one answers, else the CPU; under mpirun one word, or one for each "
     "compositor: cpu,osmesa"},
    {"framebuffer", "half|float", render, "gl-fragment: 16-bit floats (default, as in the paper) or 32"},
    {"egl-device", "N|local-rank", render,
     "egl: number of the device, or local-rank: that of the rank within its machine"},
};

constexpr OptionRow rank_rows[] = {
    {"distribution", "sort-first|sort-last", render | volumes,
     "volumes, under mpirun: each process renders a part of the image, or of the volume (default sort-first)"},
    {"direct-send", "asynchronous|synchronous", render | volumes,
     "--distribution sort-last: how processes exchange pixels (default asynchronous)"},
    {"balance", "learned|accurate|backface|splatting|previous|even", render | volumes,
     "volumes, under mpirun: how the image is split between processes (default learned)"},
    {"balance-resolution", "FACTOR", render | volumes,
     "volumes: resolution of the cost map, in its pixels per image pixel along each axis (default 0.5; learned uses at "
     "most 0.25)"},
    {"balance-weights", "W,W,...|measured", render | volumes,
     "volumes, under mpirun: how much of the work each process gets (default: all the same)"},
    {"show", "balance", render | volumes,
     "volumes: draw bricks in the colours of their processes, and the cost map as a second image"},
    {"projectors", "N", render | meshes, "under mpirun: number of ranks that project (default: all)"},
    {"compositors", "P", render | meshes, "under mpirun: number of ranks that composite (default: all)"},
    {"exchange", "runs|segments", render | meshes,
     "under mpirun: what projectors send (default: runs; segments for deep images, scanline and devices)"},
    {"partition", "curve|file|random", render | meshes, "under mpirun: which rank gets which cells (default: curve)"},
    {"frames-in-flight", "F", render, "under mpirun: number of frames in progress at once (default: 2)"},
    {"seed", "NUMBER", render | meshes,
     "under mpirun: random seed of the tile map and of --partition random (default: 1)"},
    {"stall-timeout", "SECONDS", pictures | machine,
     "under mpirun: a rank that has been silent for this long is reported as stopped; 0: never (default: 120)"},
    {"on-stall", "wait|abort", pictures | machine,
     "under mpirun, if a rank is reported as stopped: wait for it (default), or end the run"},
};

constexpr OptionRow file_rows[] = {
    {"like", "REPORT", render | basic,
     "report of another run: its views, size, field and transfer function; other options override it"},
    {"config", "FILE", render | basic, "TOML file of options; those of the command line win"},
    {"save-config", "FILE", render | basic, "write the options of this run as a TOML file"},
};

constexpr OptionTopic topics[] = {{"", input_rows},
                                  {"Server", server_rows},
                                  {"Data", data_rows},
                                  {"Raw volumes", raw_rows},
                                  {"Colour and opacity", color_rows},
                                  {"View", view_rows},
                                  {"Surfaces and light", surface_rows},
                                  {"In the image", annotation_rows},
                                  {"Output", output_rows},
                                  {"Accuracy and speed", accuracy_rows},
                                  {"Devices", device_rows},
                                  {"Under mpirun", rank_rows},
                                  {"Settings in files", file_rows}};

}  // namespace

std::span<const OptionTopic> option_topics() { return topics; }

}  // namespace v0_1
}  // namespace tessera
