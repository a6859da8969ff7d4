// SPDX-License-Identifier: BSD-3-Clause
#include "scene/error.hpp"

#include <algorithm>

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr std::string_view subject_mark = ": ", remedy_mark = "; ";

std::string joined(std::string_view subject, std::string_view problem, std::string_view remedy) {
  std::string line(subject);
  if (!subject.empty()) line += subject_mark;
  line += problem;
  if (!remedy.empty()) line += remedy_mark;
  return line += remedy;
}

std::string_view between(std::string_view line, std::size_t begin, std::size_t end) noexcept {
  begin = std::min(begin, line.size());  // the text of what() ends at the first null character
  return {line.data() + begin, std::min(end, line.size()) - begin};
}

}  // namespace

Error::Error(ErrorCode code, const std::string& line) : std::runtime_error(line), code_(code) {
  const std::size_t mark = line.rfind(remedy_mark);
  problem_end_ = std::min(mark, line.size());
  remedy_begin_ = mark == std::string::npos ? line.size() : mark + remedy_mark.size();
  const std::size_t colon = line.find(subject_mark);
  if (colon == std::string::npos || colon == 0 || colon >= problem_end_) return;
  subject_end_ = colon;
  problem_begin_ = colon + subject_mark.size();
}

Error::Error(ErrorCode code, std::string_view subject, std::string_view problem, std::string_view remedy)
    : std::runtime_error(joined(subject, problem, remedy)),
      code_(code),
      subject_end_(subject.size()),
      problem_begin_(subject.empty() ? 0 : subject.size() + subject_mark.size()),
      problem_end_(problem_begin_ + problem.size()),
      remedy_begin_(remedy.empty() ? problem_end_ : problem_end_ + remedy_mark.size()) {}

Error::~Error() = default;

std::string_view Error::subject() const noexcept { return between(what(), 0, subject_end_); }
std::string_view Error::problem() const noexcept { return between(what(), problem_begin_, problem_end_); }
std::string_view Error::remedy() const noexcept { return between(what(), remedy_begin_, std::string_view::npos); }

std::string_view Error::setting() const noexcept {
  const std::string_view line = what();
  const std::size_t end = line.starts_with('`') ? line.find('`', 1) : std::string_view::npos;
  return end == std::string_view::npos ? std::string_view() : line.substr(1, end - 1);
}

}  // namespace v0_1
}  // namespace tessera

namespace tessera::scene {

Error with_subject(const Error& error, std::string_view subject) {
  const std::string_view line = error.what();
  if (subject.empty() || !line.starts_with(subject) || !line.substr(subject.size()).starts_with(subject_mark))
    return error;
  const std::string_view rest = line.substr(subject.size() + subject_mark.size());
  const std::size_t mark = rest.rfind(remedy_mark);
  if (mark == std::string_view::npos) return {error.code(), subject, rest, ""};
  return {error.code(), subject, rest.substr(0, mark), rest.substr(mark + remedy_mark.size())};
}

}  // namespace tessera::scene
