// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/film_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/image/display_rows.hpp"
#include "scene/error.hpp"
#include "scene/image.hpp"
#include "system/atomic_file.hpp"
#include "system/descriptor.hpp"
#include "system/regular_file.hpp"
#include "system/spawn_plan.hpp"
#include "system/unfinished.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

/// Options of ffmpeg for one kind of file: the format and the encoder.
struct FilmKind {
  std::string_view extension, format;
  bool is_video = true;           ///< false: the frames use a colour palette
  std::string_view quality = "";  ///< quality options of the encoder; its defaults optimize for small files
};

// Without a bit rate of 0, VP9 limits itself to a low rate whatever the frame size.
constexpr std::string_view h264 = "-crf 18", vp9 = "-crf 24 -b:v 0";
constexpr std::array kinds = {
    FilmKind{".mp4", "mp4", true, h264},  FilmKind{".mov", "mov", true, h264}, FilmKind{".mkv", "matroska", true, h264},
    FilmKind{".webm", "webm", true, vp9}, FilmKind{".gif", "gif", false},
};

const FilmKind* kind_of(const std::filesystem::path& file) {
  const std::string extension = system::lower_extension(file);
  const auto* const kind = std::ranges::find_if(kinds, [&](const FilmKind& k) { return k.extension == extension; });
  return kind == kinds.end() ? nullptr : kind;
}

/// Returns the path of ffmpeg according to PATH; empty if it was not found.
std::filesystem::path find_ffmpeg() {
  const char* const value = ::getenv("PATH");
  std::string_view path = value == nullptr ? "" : value;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find(':'), path.size());
    std::filesystem::path program = std::filesystem::path(path.substr(0, end)) / "ffmpeg";
    std::error_code unknown;
    if (end > 0 && std::filesystem::is_regular_file(program, unknown) && ::access(program.c_str(), X_OK) == 0)
      return program;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return {};
}

/// Suggests a name for an image sequence instead of a film. A name that is already numbered keeps its number.
std::string pictures_instead(const std::filesystem::path& file) {
  const std::string stem = (file.parent_path() / file.stem()).string();
  return stem + (stem.find('%') == std::string::npos ? "_%04d.png" : ".png");
}

std::filesystem::path require_ffmpeg(const std::filesystem::path& file) {
  std::filesystem::path program = find_ffmpeg();
  if (program.empty())
    throw bad_input(
        fmt::format("{}: films are made by the program ffmpeg, which is not on PATH; install it (Debian: apt install "
                    "ffmpeg), or write {}",
                    file.string(), pictures_instead(file)));
  return program;
}

const FilmKind& require_kind(const std::filesystem::path& file) {
  const FilmKind* const kind = kind_of(file);
  if (kind == nullptr)
    throw bad_input(file.string() + ": does not have the name of a film; end it in .mp4, .mov, .mkv, .webm or .gif");
  return *kind;
}

/// The display values of the background, in ffmpeg's notation for a colour.
std::string ground_color(const ImageFileOptions& options) {
  std::string color = "0x";
  for (int k = 0; k < 3; ++k) {
    const double value = std::clamp(options.background ? (*options.background)[k] : 0.0, 0.0, 1.0);
    color += fmt::format("{:02x}", options.encode_srgb ? io::srgb_code(value) : std::lround(value * 255));
  }
  return color;
}

std::vector<std::string> ffmpeg_words(const FilmKind& kind, ImageSize size, const FilmFileOptions& options,
                                      int output) {
  std::vector<std::string> words = {"ffmpeg",     "-hide_banner",
                                    "-loglevel",  "error",
                                    "-nostdin",   "-y",
                                    "-f",         "rawvideo",
                                    "-pix_fmt",   "rgb24",
                                    "-s",         fmt::format("{}x{}", size.width, size.height),
                                    "-framerate", fmt::format("{:g}", options.frames_per_second),
                                    "-i",         "pipe:0"};
  if (kind.is_video) {
    // Players expect one chroma value for 2 x 2 pixels. Without a tag, they interpret large frames as BT.709 and small
    // frames as BT.601, while ffmpeg converts all frames to BT.601 without adding a tag.
    words.insert(words.end(), {"-vf", fmt::format("pad=ceil(iw/2)*2:ceil(ih/2)*2:color={},scale=out_color_matrix=bt709:"
                                                  "out_range=tv,format=yuv420p",
                                                  ground_color(options.image))});
    for (const std::string_view word :
         {"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"})
      words.emplace_back(word);
  } else {
    words.insert(words.end(), {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse"});
  }
  for (std::string_view left = kind.quality; !left.empty();) {
    const std::size_t end = std::min(left.find(' '), left.size());
    words.emplace_back(left.substr(0, end));
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  // The output is given by descriptor: an unnamed file does not remain if this process is killed.
  words.insert(words.end(), {"-f", std::string(kind.format), fmt::format("/proc/self/fd/{}", output)});
  return words;
}

}  // namespace

struct FilmFile::State {
  State(std::filesystem::path file_named, ImageSize picture_size, const FilmFileOptions& film_options)
      : file(std::move(file_named)), size(picture_size), options(film_options), target(file) {
    options.image.png_bits = 8;
  }
  ~State() {
    if (process > 0) {
      forget_process();
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
    }
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void start(const std::filesystem::path& program);
  /// Must be called before waiting for ffmpeg to end; afterwards its process id may belong to another process.
  void forget_process() const {
    const auto lock = system::naming_outputs();
    system::remove_unfinished(process);
  }
  /// Closes the stream of frames and waits for ffmpeg to end. Throws if it fails.
  void end();
  [[noreturn]] void fail(const std::string& what) const;
  /// Returns the last line that ffmpeg printed.
  [[nodiscard]] std::string last_words() const;

  std::filesystem::path file;
  ImageSize size;
  FilmFileOptions options;
  system::AtomicFile target;
  system::Descriptor pictures, complaints;
  pid_t process = -1;
  std::vector<std::uint8_t> bytes;
};

void FilmFile::State::start(const std::filesystem::path& program) {
  std::array<int, 2> ends{};
  // A socket, because writing to a closed socket returns an error, while a closed pipe would kill this process.
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail(std::strerror(errno));
  pictures = system::Descriptor(ends[0]);
  const system::Descriptor theirs(ends[1]);
  complaints = system::Descriptor(::memfd_create("ffmpeg", MFD_CLOEXEC));
  if (!complaints.is_open()) fail(std::strerror(errno));

  constexpr int output = 3;
  // The descriptors are first duplicated to numbers above all those assigned below, because the originals may have one
  // of these numbers.
  const system::Descriptor in(::fcntl(theirs.get(), F_DUPFD_CLOEXEC, 10)),
      err(::fcntl(complaints.get(), F_DUPFD_CLOEXEC, 10)), out(::fcntl(target.descriptor(), F_DUPFD_CLOEXEC, 10));
  if (!in.is_open() || !err.is_open() || !out.is_open()) fail(std::strerror(errno));
  system::SpawnPlan plan;
  ::posix_spawn_file_actions_adddup2(&plan.files, in.get(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&plan.files, err.get(), STDERR_FILENO);
  ::posix_spawn_file_actions_addopen(&plan.files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&plan.files, out.get(), output);
  ::posix_spawn_file_actions_addclosefrom_np(&plan.files, output + 1);  // for example sockets of a server
  plan.set_own_group();  // this program handles Ctrl-C; when it ends, ffmpeg's input is closed
  const int failed = plan.start(program, ffmpeg_words(*kind_of(file), size, options, output), environ, process);
  if (failed != 0) {
    process = -1;
    fail(fmt::format("{} does not start: {}", program.string(), std::strerror(failed)));
  }
}

std::string FilmFile::State::last_words() const {
  std::string text(4096, '\0');
  const off_t end = ::lseek(complaints.get(), 0, SEEK_END);
  const off_t begin = std::max<off_t>(0, end - static_cast<off_t>(text.size()));
  const ssize_t got = ::pread(complaints.get(), text.data(), text.size(), begin);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
}

void FilmFile::State::fail(const std::string& what) const {
  throw Error(ErrorCode::system_failure, file.string(), "ffmpeg cannot make it: " + what,
              "correct that, or write " + pictures_instead(file));
}

void FilmFile::State::end() {
  pictures = system::Descriptor();
  int status = 0;
  // Waits for the end first, and reaps the process only after abandon_outputs() can no longer kill it.
  siginfo_t ended{};
  while (::waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  forget_process();
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  process = -1;
  const std::string words = last_words();
  if (WIFSIGNALED(status)) fail(fmt::format("it was ended by signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    fail(words.empty() ? fmt::format("it ended with status {}", WEXITSTATUS(status)) : words);
}

bool is_film_name(const std::filesystem::path& file) { return kind_of(file) != nullptr; }

void check_film_file(const std::filesystem::path& file) {
  require_kind(file);
  require_ffmpeg(file);
  system::check_writable(file);
}

FilmFile::FilmFile(std::filesystem::path file, ImageSize size, const FilmFileOptions& options) {
  require_kind(file);
  const std::filesystem::path program = require_ffmpeg(file);
  if (!(options.frames_per_second >= least_film_rate && options.frames_per_second <= most_film_rate))
    throw bad_input(fmt::format("`frame_rate` {:g}: it must be {} to {}", options.frames_per_second, least_film_rate,
                                most_film_rate));
  scene::validate(size);
  state_ = std::make_unique<State>(std::move(file), size, options);
  state_->start(program);
}

FilmFile::~FilmFile() = default;

void FilmFile::add(const Image& image) {
  State& s = *state_;
  if (image.size != s.size)
    throw bad_input(fmt::format("{}: an image of {}x{} pixels follows images of {}x{}; give all images the same size",
                                s.file.string(), image.size.width, image.size.height, s.size.width, s.size.height));
  const io::DisplayRows display(image, s.file, s.options.image, 3);
  std::vector<float> rgba;
  s.bytes.resize(display.row_bytes());
  for (int y = 0; y < image.size.height; ++y) {
    display.row(y, rgba, s.bytes.data());
    const std::uint8_t* next = s.bytes.data();
    for (std::size_t left = s.bytes.size(); left > 0;) {
      const ssize_t sent = ::send(s.pictures.get(), next, left, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) {
        s.end();
        s.fail("it exited before the last image");
      }
      next += sent;
      left -= static_cast<std::size_t>(sent);
    }
  }
}

std::string FilmFile::take() {
  state_->end();
  std::ifstream film(fmt::format("/proc/self/fd/{}", state_->target.descriptor()), std::ios::binary);
  std::ostringstream bytes;
  bytes << film.rdbuf();
  if (!film || !bytes) state_->fail("it cannot be read back");
  return std::move(bytes).str();
}

void FilmFile::commit() {
  state_->end();
  state_->target.commit();
}

}  // namespace v0_1
}  // namespace tessera
