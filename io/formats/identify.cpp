// SPDX-License-Identifier: BSD-3-Clause
#include "io/formats/identify.hpp"

#include <algorithm>
#include <system_error>

#include "io/files/file_beginnings.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

bool has_extension(const Format& format, const std::string& extension) {
  std::string_view rest = format.extensions;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == extension) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

/// Returns the extension that determines the format: for x.nii.gz that of x.nii. Files of LS-DYNA's database, d3plot,
/// d3plot01, ..., do not have an extension.
std::string extension_of(const std::filesystem::path& file) {
  if (file.filename().string().starts_with("d3plot")) return ".d3plot";
  const std::string extension = system::lower_extension(file);
  return extension == ".gz" ? system::lower_extension(file.stem()) : extension;
}

const Format* format_where(const auto& holds) {
  const std::span<const Format> all = formats();
  const auto found = std::find_if(all.begin(), all.end(), holds);
  return found == all.end() ? nullptr : &*found;
}

const Format* recognized(const FileBeginning& start, const std::string& extension) {
  const auto begins = [&](const Format& f) { return f.recognizes != nullptr && f.recognizes(start); };
  if (const Format* const named =
          format_where([&](const Format& f) { return f.by_name_too && has_extension(f, extension) && begins(f); }))
    return named;
  return format_where([&](const Format& f) { return !f.by_name_too && begins(f); });
}

/// Whether HDF5 begins after a user block, whose size is 512 times a power of two bytes.
bool has_hdf5_behind_block(const system::PositionalFile& file) {
  std::string bytes(hdf5_signature.size(), '\0');
  for (std::uint64_t at = 512; at + bytes.size() <= file.size(); at *= 2) {
    file.read(at, reinterpret_cast<std::byte*>(bytes.data()), bytes.size());
    if (bytes == hdf5_signature) return true;
  }
  return false;
}

void set_format(InputFile& file, const Format* begun) {
  const std::string extension = extension_of(file.path);
  const Format* const named =
      extension.empty() ? nullptr : format_where([&](const Format& f) { return has_extension(f, extension); });
  const bool is_container = begun != nullptr && !begun->is_listed;
  file.is_recognized = begun != nullptr;
  file.format = begun;
  if (begun == nullptr || (is_container && named != nullptr && named->container == begun->container))
    file.format = named;
}

}  // namespace

InputFile identify(const std::filesystem::path& path) {
  InputFile file{.path = path, .name = path.string()};
  std::error_code unknown;
  file.is_folder = std::filesystem::is_directory(path, unknown);
  if (file.is_folder) {
    require_file(path);
    const auto begins = is_case_folder(path)    ? begins_as_openfoam
                        : is_amrex_folder(path) ? begins_as_amrex
                                                : begins_as_dicom;
    set_format(file, format_where([&](const Format& f) { return f.recognizes == begins; }));
    return file;
  }
  const system::PositionalFile opened = open_input(path);
  file.size = opened.size();
  file.beginning = opened.beginning(InputFile::longest_beginning);
  file.is_gzip = system::looks_like_gzip(file.beginning);
  if (file.is_gzip) {
    const auto inner =
        system::inflate_beginning(std::as_bytes(std::span(file.beginning)), InputFile::longest_beginning);
    file.beginning.assign(reinterpret_cast<const char*>(inner.data()), inner.size());
  }
  const Format* begun = recognized(file.start(), extension_of(path));
  if (begun == nullptr && has_hdf5_behind_block(opened)) begun = recognized({hdf5_signature, file.size}, "");
  set_format(file, begun);
  return file;
}

InputFile identify_by_name(const std::filesystem::path& path) {
  InputFile file{.path = path, .name = path.string()};
  set_format(file, nullptr);
  return file;
}

}  // namespace tessera::io
