#pragma once

#include <filesystem>
#include <string>

#include "io/helper_messages.hpp"
#include "scene/error.hpp"

namespace tessera::io {

/// What a gzip file holds, inflated once into a file without a name, in memory, which goes with this object. Throws
/// Error(bad_input, "FILE: ...") for a damaged stream and one that holds nothing, Error(system_failure) for more than
/// the machine has free.
class InflatedFile {
 public:
  explicit InflatedFile(const std::filesystem::path& file);

  /// Calls `work` with a name that this process and its helper can open while this lives, and returns what it returns.
  /// In the lines of its errors that name is replaced by the gzip file's. The name has no extension: what the content
  /// is has to be told from it, or from inner_name().
  template <class Work>
  auto read(const Work& work) const {
    try {
      return work(path_);
    } catch (const scene::Error& error) {
      throw renamed(error);
    }
  }

  /// The gzip file's name without its .gz, if it has that.
  [[nodiscard]] std::filesystem::path inner_name() const;

  /// The line with the gzip file's name in place of path(), for notes.
  [[nodiscard]] std::string renamed(std::string line) const;

 private:
  [[nodiscard]] scene::Error renamed(const scene::Error& error) const;

  std::filesystem::path file_, path_;
  Descriptor descriptor_;
};

/// Whether a name is one that InflatedFile gave, beside which nothing lies.
bool is_inflated(const std::filesystem::path& file);

/// For HDF5, whose library opens files by real names only: throws Error(bad_input) for one that was in a gzip file.
void require_real_name(const std::filesystem::path& file);

/// For files that others lie beside: throws Error(bad_input) for one that was in a gzip file.
void require_beside_others(const std::filesystem::path& file);

}  // namespace tessera::io
