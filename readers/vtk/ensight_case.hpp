// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// What an EnSight case file names: its files may be gone, of which VTK's reader does not say the name.
namespace tessera::readers {

class EnsightCase {
 public:
  /// Parses the sections FORMAT, GEOMETRY, VARIABLE, TIME and FILE; what it does not know it passes over.
  explicit EnsightCase(const std::filesystem::path& file);

  struct Missing {
    std::string variable;  ///< empty: the geometry
    std::string file;      ///< as the case names it, without the `*`
    bool of_points = false;
  };
  /// The files that are not there, of the time step at `time`; of a case without time of the only one.
  [[nodiscard]] std::vector<Missing> missing(double time) const;

  /// Throws Error(bad_input) if a file of any step is a folder, a pipe or another that is not regular.
  void require_regular_files(const std::string& source) const;

  struct Values {
    std::string variable;
    std::filesystem::path file;
    std::string file_name;  ///< to print
    int components = 0;     ///< of one number in the file; 0: not known
    bool of_points = false;
  };
  /// The variables' files of that time step; without those of file sets.
  [[nodiscard]] std::vector<Values> values(double time) const;

  [[nodiscard]] bool is_gold() const { return is_gold_; }
  /// Whether it has file sets, whose files hold several time steps each.
  [[nodiscard]] bool has_file_sets() const { return !file_sets_.empty(); }
  /// Those of all time sets, ascending, each once.
  [[nodiscard]] std::vector<double> times() const;

  /// A file that a line of the case names, at a time step.
  struct Located {
    std::string kind;  ///< `model`, `scalar per node`, ...
    Values values;     ///< of the geometry, file and file_name alone
    std::size_t step = 0;
    bool in_set = false;
  };
  /// Those that are there. `step` is that of the file in a file set, else that of the time set. Of complex variables
  /// two after each other.
  [[nodiscard]] std::vector<Located> located(double time) const;

 private:
  struct TimeSet {
    std::vector<double> times;
    std::vector<long> numbers;      ///< that stand for `*` in names
    long start = 0, increment = 1;  ///< of them, where they are not listed
  };
  struct InFileSet {
    long number = 0;  ///< that stands for `*`
    std::size_t steps = 0;
  };
  struct Named {
    std::string kind, variable, pattern;
    int time_set = 1, file_set = 0;  ///< 0: none
    bool of_points = false;
    int components = 0;
  };
  struct Place {
    std::string file;
    std::size_t step = 0;
  };

  void read_geometry(const std::string& line);
  void read_variable(const std::string& line);
  void read_time(const std::string& line, TimeSet*& set, std::string& list);
  void read_file_set(const std::string& line, std::vector<InFileSet>*& set);
  [[nodiscard]] Place place_of(const Named& named, double time) const;

  std::filesystem::path folder_;
  bool is_gold_ = false;
  std::vector<Named> named_;
  std::vector<Named> beside_;  ///< measured particles and the like, which VTK's reader opens too
  std::map<int, TimeSet> sets_;
  std::map<int, std::vector<InFileSet>> file_sets_;
};

}  // namespace tessera::readers
