// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::io {

/// An entry of a Nastran deck's bulk data: its name in capitals without the asterisk, and its fields after that, 8 or
/// 16 letters each or between commas, continuations included, replications carried out. Fields that are not there are
/// blank.
class NastranEntry {
 public:
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  [[nodiscard]] bool is_blank(std::size_t field) const { return field >= fields_.size() || fields_[field].empty(); }

  /// Nothing for a blank field. Throws Error(bad_input) with file and line for what is no whole number.
  [[nodiscard]] std::optional<std::int64_t> whole_number(std::size_t field) const;
  /// A real number as Nastran has them ("1.5", "1.5E-3", "1.5-3", "1.5D-3"); 0 for a blank field.
  [[nodiscard]] double real(std::size_t field) const;

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  friend class NastranDeck;

  [[nodiscard]] bool has_replications() const;
  /// Replaces "=", "==" and "*(x)" by what they make of the entry before.
  void replicate(const NastranEntry& before);

  std::string name_, source_;
  std::size_t line_ = 0;
  std::vector<std::string> fields_;
};

/// Calls `use` with the entries of a deck's bulk data whose names `is_used` knows, in their order, those of files that
/// it includes in their places; a file that is included again is passed over. Without BEGIN BULK all of it is bulk
/// data. Throws Error(bad_input) of what is not text, and of an included file that is not there or no regular file.
void read_nastran_deck(const std::filesystem::path& file, const std::function<bool(std::string_view)>& is_used,
                       const std::function<void(const NastranEntry&)>& use);

}  // namespace tessera::io
