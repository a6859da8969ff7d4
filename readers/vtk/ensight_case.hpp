// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// The files named by an EnSight case file. VTK's reader does not report the names of missing ones.
namespace tessera::readers {

class EnsightCase {
 public:
  /// Parses the sections FORMAT, GEOMETRY, VARIABLE, TIME and FILE; ignores unknown ones.
  explicit EnsightCase(const std::filesystem::path& file);

  struct Missing {
    std::string variable;  ///< empty: the geometry
    std::string file;      ///< as in the case, without the `*`
    bool of_points = false;
  };
  /// The missing files of the time step at `time`; for a case without time, of the only step.
  [[nodiscard]] std::vector<Missing> missing(double time) const;

  /// Throws Error(bad_input) if a file of any step is a directory, a pipe or otherwise not regular.
  void require_regular_files(const std::string& source) const;

  struct Values {
    std::string variable;
    std::filesystem::path file;
    std::string file_name;  ///< for messages
    int components = 0;     ///< per value in the file; 0: unknown
    bool of_points = false;
  };
  /// The variables' files of that time step, except those in file sets.
  [[nodiscard]] std::vector<Values> values(double time) const;

  [[nodiscard]] bool is_gold() const { return is_gold_; }
  /// Whether it has file sets, whose files contain several time steps each.
  [[nodiscard]] bool has_file_sets() const { return !file_sets_.empty(); }
  /// The times of all time sets, ascending, each once.
  [[nodiscard]] std::vector<double> times() const;

  /// A file named by a line of the case, at a time step.
  struct Located {
    std::string kind;  ///< `model`, `scalar per node`, ...
    Values values;     ///< for the geometry, only file and file_name
    std::size_t step = 0;
    bool in_set = false;
  };
  /// The existing files. `step` is the index in the file of a file set, otherwise in the time set. A complex variable
  /// has two consecutive entries.
  [[nodiscard]] std::vector<Located> located(double time) const;

 private:
  struct TimeSet {
    std::vector<double> times;
    std::vector<long> numbers;      ///< that replace `*` in names
    long start = 0, increment = 1;  ///< of the numbers, if they are not listed
  };
  struct InFileSet {
    long number = 0;  ///< that replaces `*`
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
  std::vector<Named> beside_;  ///< measured particles and similar files, which VTK's reader opens too
  std::map<int, TimeSet> sets_;
  std::map<int, std::vector<InFileSet>> file_sets_;
};

}  // namespace tessera::readers
