#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// What an EnSight case file names: its files may be gone, of which VTK's reader does not say the name.
namespace tessera::io::helper {

class EnsightCase {
 public:
  /// Parses the sections GEOMETRY, VARIABLE and TIME; what it does not know it passes over.
  explicit EnsightCase(const std::filesystem::path& file);

  struct Missing {
    std::string variable;  ///< empty: the geometry
    std::string file;      ///< as the case names it, without the `*`
    bool of_points = false;
  };
  /// The files that are not there, of the time step at `time`; of a case without time of the only one. Of those that
  /// hold several steps, whichever that is.
  [[nodiscard]] std::vector<Missing> missing(double time) const;

  struct Values {
    std::string variable;
    std::filesystem::path file;
    int components = 0;
    bool of_points = false;
  };
  /// The variables' files of that time step; without those that hold several steps.
  [[nodiscard]] std::vector<Values> values(double time) const;

 private:
  struct TimeSet {
    std::vector<double> times;
    std::vector<long> numbers;      ///< that stand for `*` in names
    long start = 0, increment = 1;  ///< of them, where they are not listed
  };
  struct Named {
    std::string variable, pattern;
    int time_set = 1;
    bool of_points = false, in_sets = false;
    int components = 0;  ///< of one number in the file; 0: not known
  };

  void read_geometry(const std::string& line);
  void read_variable(const std::string& line);
  void read_time(const std::string& line, TimeSet*& set, std::string& list);
  [[nodiscard]] std::string file_of(const Named& named, double time) const;

  std::filesystem::path folder_;
  std::vector<Named> named_;
  std::map<int, TimeSet> sets_;
};

}  // namespace tessera::io::helper
