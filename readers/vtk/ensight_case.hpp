// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// The files named by an EnSight case file. Needed because VTK's reader does not report the names of missing files.
namespace tessera::readers {

class EnsightCase {
 public:
  /// Parses the sections FORMAT, GEOMETRY, VARIABLE, TIME and FILE; ignores unknown sections.
  explicit EnsightCase(const std::filesystem::path& file);

  struct Missing {
    std::string variable;  ///< name of the variable; empty for the geometry
    std::string file;      ///< name of the file as written in the case, without the `*`
    bool of_points = false;
  };
  /// Returns the missing files of the time step at `time`; of the only step if the case has no times.
  [[nodiscard]] std::vector<Missing> missing(double time) const;

  /// Throws Error(bad_input) if a file of any step is a directory, a pipe or otherwise not regular.
  void require_regular_files(const std::string& source) const;

  struct Values {
    std::string variable;
    std::filesystem::path file;
    std::string file_name;  ///< for messages
    int components = 0;     ///< number of components per value in the file; 0: unknown
    bool of_points = false;
  };
  /// Returns the files of the variables at this time, except those in file sets.
  [[nodiscard]] std::vector<Values> values(double time) const;

  [[nodiscard]] bool is_gold() const { return is_gold_; }
  /// Whether the case has file sets, whose files contain several time steps each.
  [[nodiscard]] bool has_file_sets() const { return !file_sets_.empty(); }
  /// Returns the times of all time sets, ascending, each once.
  [[nodiscard]] std::vector<double> times() const;

  /// An existing file that a line of the case names, at a time step.
  struct Located {
    std::string kind;  ///< first words of the line: `model`, `scalar per node`, ...
    Values values;     ///< for the geometry, only file and file_name are set
    std::size_t step = 0;
    bool in_set = false;
  };
  /// Returns the existing files. `step` is the index of the step in a file of a file set, otherwise the index in the
  /// time set. A complex variable has two consecutive entries.
  [[nodiscard]] std::vector<Located> located(double time) const;

 private:
  struct TimeSet {
    std::vector<double> times;
    std::vector<long> numbers;      ///< numbers that replace `*` in names
    long start = 0, increment = 1;  ///< first number and increment, if the numbers are not listed
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
  std::vector<Named> beside_;  ///< measured particles and similar files, which VTK's reader also opens
  std::map<int, TimeSet> sets_;
  std::map<int, std::vector<InFileSet>> file_sets_;
};

}  // namespace tessera::readers
