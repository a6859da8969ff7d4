// The one file that sees TetGen, which is under the AGPL-3.0; compiled only with TESSERA_TETGEN.
#include <fmt/format.h>

#define TETLIBRARY
// The header's terminatetetgen frees the mesh, then throws; the mesh's destructor frees it again, which crashes. The
// library calls that function through the dynamic linker, so the one defined below takes its place, which it has to be
// visible for.
#define terminatetetgen tetgen_header_terminatetetgen
#include <tetgen.h>
#undef terminatetetgen

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <exception>
#include <glm/common.hpp>
#include <span>

#include "io/surface.hpp"
#include "scene/error.hpp"

__attribute__((visibility("default"))) void terminatetetgen(tetgenmesh*, int reason) { throw reason; }

namespace tessera::io {
namespace {

/// TetGen's words for the numbers it throws (terminatetetgen in tetgen.h).
const char* reason(int thrown) {
  switch (thrown) {
    case 1:
      return "memory ran out";
    case 3:
      return "the surface cuts itself";
    case 4:
      return "a feature is too small for its tolerance";
    case 5:
      return "two faces nearly coincide";
    case 10:
      return "the input is not valid";
    default:
      return "it failed inside";
  }
}

/// Takes a surface to the unit box round the origin and back, by a power of two: TetGen's tolerances are not made for
/// metre-size cells at coordinates of 7e6.
struct Frame {
  glm::dvec3 centre{0};
  double scale = 1;

  explicit Frame(const Surface& surface) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& p : surface.points) low = glm::min(low, p), high = glm::max(high, p);
    centre = 0.5 * low + 0.5 * high;
    const glm::dvec3 side = high - low;
    int exponent = 0;
    std::frexp(std::max({side.x, side.y, side.z}), &exponent);
    scale = std::ldexp(1.0, -exponent);
  }
  [[nodiscard]] glm::dvec3 in(const glm::dvec3& p) const { return (p - centre) * scale; }
  [[nodiscard]] glm::dvec3 out(const glm::dvec3& p) const { return p / scale + centre; }
};

/// tetgenio frees its arrays by delete[], so they are made by new[].
void copy_in(const Surface& surface, const Frame& frame, tetgenio& in) {
  const auto put = [&](REAL* list, std::size_t at, const glm::dvec3& p_world) {
    const glm::dvec3 p = frame.in(p_world);
    for (int k = 0; k < 3; ++k) list[3 * at + static_cast<std::size_t>(k)] = p[k];
  };
  in.numberofpoints = static_cast<int>(surface.points.size());
  in.pointlist = new REAL[3 * surface.points.size()];
  for (std::size_t v = 0; v < surface.points.size(); ++v) put(in.pointlist, v, surface.points[v]);
  in.facetlist = new tetgenio::facet[surface.facets.size()];
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const Facet& from = surface.facets[f];
    tetgenio::facet& to = in.facetlist[f];
    tetgenio::init(&to);
    in.numberoffacets = static_cast<int>(f) + 1;
    to.polygonlist = new tetgenio::polygon[from.polygons.size()];
    for (const Polygon& polygon : from.polygons) {
      tetgenio::polygon& corners = to.polygonlist[to.numberofpolygons++];
      tetgenio::init(&corners);
      corners.vertexlist = new int[polygon.size()];
      corners.numberofvertices = static_cast<int>(polygon.size());
      std::copy(polygon.begin(), polygon.end(), corners.vertexlist);
    }
    if (!from.holes.empty()) {
      to.holelist = new REAL[3 * from.holes.size()];
      for (const glm::dvec3& hole : from.holes) put(to.holelist, static_cast<std::size_t>(to.numberofholes++), hole);
    }
  }
  if (!surface.cavities.empty()) {
    in.holelist = new REAL[3 * surface.cavities.size()];
    for (const glm::dvec3& cavity : surface.cavities)
      put(in.holelist, static_cast<std::size_t>(in.numberofholes++), cavity);
  }
}

/// What the child tells its parent, before the arrays.
struct Outcome {
  std::int32_t failure = 0;  ///< the number TetGen threw, 0 for success
  std::int32_t points = 0, tets = 0, triangles = 0;
};

bool write_all(int pipe, const void* bytes, std::size_t count) {
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(pipe, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int pipe, void* bytes, std::size_t count) {
  char* at = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = ::read(pipe, at, count);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

/// The child's work: mesh, write the result into the pipe, end.
[[noreturn]] void fill_in_child(const Surface& surface, const Frame& frame, std::optional<double> max_volume,
                                int pipe) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  Outcome outcome;
  tetgenbehavior wishes;
  // p: fill a closed complex, q: quality, z: count from 0, Q: quiet
  std::string switches = max_volume ? "pq2.0zQ" : "pzQ";
  wishes.parse_commandline(switches.data());
  if (max_volume) {
    wishes.fixedvolume = 1;  // -a
    wishes.maxvolume = *max_volume * frame.scale * frame.scale * frame.scale;
  }
  auto* in = new tetgenio;  // never freed: the process ends first
  auto* out = new tetgenio;
  copy_in(surface, frame, *in);
  try {
    tetrahedralize(&wishes, in, out);
    outcome = {0, out->numberofpoints, out->numberoftetrahedra, out->numberoftrifaces};
  } catch (int thrown) {
    outcome.failure = thrown;
  } catch (const std::exception&) {
    outcome.failure = 1;
  }
  const auto points = static_cast<std::size_t>(outcome.points);
  bool written = write_all(pipe, &outcome, sizeof outcome);
  if (written && outcome.failure == 0) {
    written = write_all(pipe, out->pointlist, 3 * points * sizeof(REAL)) &&
              write_all(pipe, out->tetrahedronlist, 4 * static_cast<std::size_t>(outcome.tets) * sizeof(int)) &&
              write_all(pipe, out->trifacelist, 3 * static_cast<std::size_t>(outcome.triangles) * sizeof(int));
  }
  ::_exit(written ? 0 : 1);
}

/// The parent's side of the pipe. False if the child died before it was done.
bool receive(int pipe, const Surface& surface, const Frame& frame, Outcome& outcome, FilledSurface& filled) {
  if (!read_all(pipe, &outcome, sizeof outcome)) return false;
  if (outcome.failure != 0) return true;
  const auto points = static_cast<std::size_t>(outcome.points);
  filled.points.resize(points);
  filled.tets.resize(4 * static_cast<std::size_t>(outcome.tets));
  filled.triangles.resize(3 * static_cast<std::size_t>(outcome.triangles));
  static_assert(sizeof(glm::dvec3) == 3 * sizeof(REAL) && sizeof(int) == sizeof(std::uint32_t));
  if (!read_all(pipe, filled.points.data(), points * sizeof(glm::dvec3)) ||
      !read_all(pipe, filled.tets.data(), filled.tets.size() * sizeof(int)) ||
      !read_all(pipe, filled.triangles.data(), filled.triangles.size() * sizeof(int)))
    return false;
  for (std::size_t v = 0; v < points; ++v)  // TetGen keeps the surface's points first
    filled.points[v] = v < surface.points.size() ? surface.points[v] : frame.out(filled.points[v]);
  return true;
}

/// The parent's hold on the child: closing the pipe ends a child that still writes.
struct Child {
  pid_t process;
  int pipe;
  ~Child() {
    ::close(pipe);
    while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
};

}  // namespace

bool can_fill_surfaces() { return true; }

FilledSurface fill_surface(const Surface& surface, std::optional<double> max_volume, const std::string& source) {
  if (surface.points.size() > static_cast<std::size_t>(INT32_MAX) / 8)
    throw scene::bad_input(
        fmt::format("{}: {} points are too many for TetGen; coarsen the surface", source, surface.points.size()));
  const Frame frame(surface);
  // TetGen prints, and on surfaces it is not made for it may crash: a process of its own keeps that away from ours. The
  // child starts no thread and allocates only, which a fork of a threaded process may do under glibc.
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw scene::Error(scene::ErrorCode::system_failure, fmt::format("{}: no pipe for TetGen's process", source));
  const pid_t process = ::fork();
  if (process < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw scene::Error(scene::ErrorCode::system_failure, fmt::format("{}: no process for TetGen", source));
  }
  if (process == 0) fill_in_child(surface, frame, max_volume, ends[1]);
  ::close(ends[1]);
  const Child child{process, ends[0]};
  Outcome outcome;
  FilledSurface filled;
  const bool received = receive(child.pipe, surface, frame, outcome, filled);
  if (!received || outcome.failure != 0)
    throw scene::bad_input(
        fmt::format("{}: TetGen cannot fill the surface: {}; mend the surface", source, reason(outcome.failure)));
  if (filled.tets.empty())
    throw scene::bad_input(
        fmt::format("{}: TetGen finds nothing inside the surface: it is not closed; close its holes", source));
  return filled;
}

}  // namespace tessera::io
