#include "apps/output_check.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "io/atomic_file.hpp"
#include "io/image_file.hpp"
#include "scene/error.hpp"

namespace tessera::apps {
namespace {

void check_not_input(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code absent;  // either of them missing: not the same file
  if (!input.empty() && std::filesystem::equivalent(output, input, absent))
    throw scene::bad_input(
        fmt::format("{}: is an input of this run and would be overwritten; choose another name", output.string()));
}

/// An image of memory's size would be killed half-way by the kernel, with no line that says why.
void check_fits_memory(scene::ImageSize size) {
  const double needed = 20.0 * size.width * size.height;
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (needed > memory)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("--size: a {}x{} picture takes {:.0f} GiB, this machine has {:.0f}; make it smaller",
                                   size.width, size.height, needed / (1 << 30), memory / (1 << 30)));
}

}  // namespace

void check_output_file(const std::filesystem::path& output, const std::filesystem::path& input) {
  check_not_input(output, input);
  io::check_writable(output);
}

void check_outputs(const RenderOptions& options, const std::vector<Frame>& frames) {
  std::set<std::filesystem::path> names;
  const auto check_new = [&](const std::filesystem::path& output) {
    if (!names.insert(output.lexically_normal()).second)
      throw scene::bad_input(fmt::format("{}: is named twice as an output; choose two names", output.string()));
    for (const auto& input :
         {options.input, options.camera_file, options.mesh.plot3d_q, std::filesystem::path(options.transfer_function)})
      check_not_input(output, input);
  };

  std::set<std::filesystem::path> folders;
  for (const auto& frame : frames) {
    scene::validate(frame.size);
    check_fits_memory(frame.size);
    for (const auto& output : frame.outputs) {
      check_new(output);
      for (const auto& file : frame.mesh.files) check_not_input(output, file);
      if (frame.finished) continue;
      // Asking the file system once a folder and length of name is enough, but for names that exist.
      std::error_code unknown;
      const std::string kind = fmt::format("{}{}", output.filename().native().size(), output.extension().string());
      if (folders.insert(output.parent_path() / kind).second || std::filesystem::exists(output, unknown) || unknown)
        io::check_image_path(output);
    }
  }
  for (const auto& output : {options.report, options.timing})
    if (!output.empty()) {
      check_new(output);
      io::check_writable(output);
    }
}

}  // namespace tessera::apps
