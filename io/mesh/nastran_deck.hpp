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

/// An entry of the bulk data of a Nastran deck: the name in capitals without the asterisk, and the fields after it,
/// each of 8 or 16 characters or delimited by commas. Continuations are joined and replications expanded. Missing
/// fields are blank.
class NastranEntry {
 public:
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  [[nodiscard]] bool is_blank(std::size_t field) const { return field >= fields_.size() || fields_[field].empty(); }

  /// Returns no value for a blank field. Throws Error(bad_input) with file and line unless the field is blank or an
  /// integer.
  [[nodiscard]] std::optional<std::int64_t> whole_number(std::size_t field) const;
  /// A real number in Nastran's notations ("1.5", "1.5E-3", "1.5-3", "1.5D-3"); 0 for a blank field.
  [[nodiscard]] double real(std::size_t field) const;

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  friend class NastranDeck;

  [[nodiscard]] bool has_replications() const;
  /// Replaces the fields "=", "==" and "*(x)" by the values that they derive from the previous entry.
  void replicate(const NastranEntry& before);

  std::string name_, source_;
  std::size_t line_ = 0;
  std::vector<std::string> fields_;
};

/// Calls `use` with the entries of a deck's bulk data whose names `is_used` accepts, in order. Entries of included
/// files are passed, too, but a file that is included a second time is skipped. In a deck without BEGIN BULK everything
/// is bulk data. Throws Error(bad_input) for a file that is not text, and for an included file that is missing or not a
/// regular file.
void read_nastran_deck(const std::filesystem::path& file, const std::function<bool(std::string_view)>& is_used,
                       const std::function<void(const NastranEntry&)>& use);

}  // namespace tessera::io
