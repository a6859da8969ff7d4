// SPDX-License-Identifier: BSD-3-Clause
#include "readers/common/hdf5_references.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "readers/common/hdf5_handle.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

using Path = std::filesystem::path;

/// The links of a file.
struct Links {
  std::vector<std::string> objects, files;
};

extern "C" herr_t tessera_note_reference(hid_t group, const char* name, const H5L_info_t* link, void* links) {
  auto& found = *static_cast<Links*>(links);
  if (link->type == H5L_TYPE_HARD) found.objects.emplace_back(name);
  if (link->type != H5L_TYPE_EXTERNAL) return 0;
  std::vector<char> value(link->u.val_size + 1);
  const char *file = nullptr, *object = nullptr;
  if (H5Lget_val(group, name, value.data(), link->u.val_size, H5P_DEFAULT) >= 0 &&
      H5Lunpack_elink_val(value.data(), link->u.val_size, nullptr, &file, &object) >= 0 && file != nullptr)
    found.files.emplace_back(file);
  return 0;
}

bool is_virtual(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_layout(creation.get()) == H5D_VIRTUAL;
}

class References {
 public:
  References(const Path& file, ReferencesMay may) : source_(file.string()), may_(may) {
    std::error_code unknown;
    first_ = std::filesystem::canonical(file, unknown);
    folder_ = first_.parent_path();
  }

  void check() {
    waiting_.push_back(first_);
    while (!waiting_.empty()) {
      const Path file = waiting_.back();
      waiting_.pop_back();
      if (seen_.insert(file).second) visit(file);
    }
    // This loop comes last, because is_virtual_in() opens the files on the path to a source, which must be checked
    // first.
    for (const auto& [file, sources] : sources_)
      for (const auto& [in_file, dataset] : sources)
        if (is_virtual_in(in_file, dataset)) leads_[file].insert(in_file);
    for (const auto& [file, next] : leads_)
      if (leads_back(file))
        throw refuse(file, "its virtual datasets refer back to themselves; the file is damaged, write it again");
  }

 private:
  [[nodiscard]] scene::Error refuse(const Path& file, const std::string& what) const {
    const std::string where = file == first_ ? "" : fmt::format("in {}: ", quote(file.filename().string()));
    return scene::bad_input(fmt::format("{}: {}{}", source_, where, what));
  }

  void visit(const Path& file) {
    const Hdf5Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!opened.is_open()) return;
    Links links;
    H5Lvisit(opened.get(), H5_INDEX_NAME, H5_ITER_NATIVE, tessera_note_reference, &links);
    for (const std::string& name : links.files) lead_to(file, name);
    for (const std::string& name : links.objects) {
      const Hdf5Handle object(H5Oopen(opened.get(), name.c_str(), H5P_DEFAULT), H5Oclose);
      if (object.is_open() && H5Iget_type(object.get()) == H5I_DATASET) visit_dataset(file, object.get());
    }
  }

  void visit_dataset(const Path& file, hid_t dataset) {
    const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
    const int parts = H5Pget_external_count(creation.get());
    for (int k = 0; k < parts; ++k) {
      std::array<char, 4096> name{};
      off_t offset = 0;
      hsize_t size = 0;
      // The library resolves these names only relative to the current directory.
      if (H5Pget_external(creation.get(), static_cast<unsigned>(k), name.size() - 1, name.data(), &offset, &size) >= 0)
        static_cast<void>(sound(file, Path(name.data())));
    }
    if (H5Pget_layout(creation.get()) != H5D_VIRTUAL) return;
    std::size_t count = 0;
    H5Pget_virtual_count(creation.get(), &count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto text = [&](auto get) {
        const ssize_t length = get(creation.get(), k, nullptr, std::size_t{0});
        std::string value(static_cast<std::size_t>(std::max<ssize_t>(length, 0)) + 1, '\0');
        get(creation.get(), k, value.data(), value.size());
        value.resize(value.size() - 1);
        return value;
      };
      const std::string name = text(H5Pget_virtual_filename), source = text(H5Pget_virtual_dsetname);
      if ((name + source).find("%b") != std::string::npos)
        throw refuse(file,
                     "the sources of a virtual dataset are given by a pattern, which is not supported; write its "
                     "numbers out with h5repack -l CONTI");
      if (const auto in_file = lead_to(file, name)) sources_[file].emplace(*in_file, source);
    }
  }

  /// Returns the file that the library opens for this name, which must be checked, too.
  std::optional<Path> lead_to(const Path& from, const std::string& name) {
    std::error_code unknown;
    if (name == ".") return from;
    const Path named(name);
    for (const Path& candidate : {from.parent_path() / named, named, from.parent_path() / named.filename()})
      if (std::filesystem::exists(candidate, unknown)) {
        const Path file = sound(from, candidate);
        waiting_.push_back(file);
        return file;
      }
    return std::nullopt;
  }

  [[nodiscard]] Path sound(const Path& from, const Path& named) const {
    std::error_code unknown;
    const Path file = std::filesystem::canonical(named, unknown);
    if (unknown) return named;
    const std::string name = quote(named.filename().string());
    if (!std::filesystem::is_regular_file(file, unknown))
      throw refuse(from, fmt::format("it refers to {}, which is not a regular file; put one there", name));
    if (may_ == ReferencesMay::point_below &&
        std::mismatch(folder_.begin(), folder_.end(), file.begin(), file.end()).first != folder_.end())
      throw refuse(from, fmt::format("it refers to {}, which is neither in its directory nor below; move that file "
                                     "there and correct the reference",
                                     name));
    return file;
  }

  [[nodiscard]] static bool is_virtual_in(const Path& file, const std::string& dataset) {
    const Hdf5Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!opened.is_open()) return false;
    const Hdf5Handle object(H5Dopen2(opened.get(), dataset.c_str(), H5P_DEFAULT), H5Dclose);
    return object.is_open() && is_virtual(object.get());
  }

  [[nodiscard]] bool leads_back(const Path& file) const {
    std::set<Path> reached;
    std::vector<Path> waiting{file};
    while (!waiting.empty()) {
      const auto next = leads_.find(waiting.back());
      waiting.pop_back();
      if (next == leads_.end()) continue;
      for (const Path& each : next->second) {
        if (each == file) return true;
        if (reached.insert(each).second) waiting.push_back(each);
      }
    }
    return false;
  }

  std::string source_;
  ReferencesMay may_;
  Path first_, folder_;
  std::vector<Path> waiting_;
  std::set<Path> seen_;
  std::map<Path, std::set<std::pair<Path, std::string>>> sources_;  ///< sources of the virtual datasets, per file
  std::map<Path, std::set<Path>> leads_;                            ///< for each file, the files of other virtual
                                                                    ///< datasets to which it leads
};

}  // namespace

void require_sound_references(const std::filesystem::path& file, ReferencesMay may) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library would print an error for a file that is not HDF5
  References(file, may).check();
}

}  // namespace tessera::readers
