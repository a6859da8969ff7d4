#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::apps {

/// What a run of the program left behind.
struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if it was killed
  std::string out, err;
  [[nodiscard]] std::size_t error_lines() const;
};

/// Runs the built `tessera` with these arguments, no shell in between, standard input empty.
Outcome tessera(const std::vector<std::string>& arguments);
/// The same with standard output going to a file.
Outcome tessera_to(const std::filesystem::path& standard_output, const std::vector<std::string>& arguments);

/// The same on several ranks. For tests that have asked has_mpirun().
bool has_mpirun();
Outcome mpirun(int ranks, const std::vector<std::string>& arguments);

/// A folder of one test's own, removed at its end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of all that lies in it, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Writes a small file and gives its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const;
  /// A small generated mesh in it: 4^3 voxels of six tets.
  [[nodiscard]] std::string cube() const;
  /// A small rectilinear grid in it, a.vtr: 12^3 points, spacings that grow along each axis.
  [[nodiscard]] std::string rectilinear() const;

 private:
  std::filesystem::path path_;
};

std::string contents(const std::string& file);

}  // namespace tessera::apps
