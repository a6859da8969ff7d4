// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/context.hpp"

namespace tessera::gl {

/// A shader file: its name for messages, and its text.
struct ShaderSource {
  const char* file;
  std::string_view text;
};

/// One stage of a program: the concatenation of several files. The version line precedes them.
struct Stage {
  GLenum kind;  ///< GL_COMPUTE_SHADER, GL_VERTEX_SHADER, GL_FRAGMENT_SHADER
  std::vector<ShaderSource> files;
};

/// A linked program. The constructor throws Error(system_failure) with a message of one line that names file and line
/// of the compiler's first error.
class Program {
 public:
  Program(const Context& context, const std::vector<Stage>& stages);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { gl_->UseProgram(name_); }
  /// Sets a uniform, given its layout(location).
  void set(GLint location, GLuint value) const { gl_->ProgramUniform1ui(name_, location, value); }
  void set(GLint location, GLint value) const { gl_->ProgramUniform1i(name_, location, value); }
  void set(GLint location, GLfloat value) const { gl_->ProgramUniform1f(name_, location, value); }

 private:
  const Functions* gl_;
  GLuint name_ = 0;
};

/// Returns the first error of a compiler's log as "FILE:LINE: words". Mesa writes "0:12(5): error: ...", NVIDIA "0(12)
/// : error ...", other drivers "ERROR: 0:12: ...". The line numbers in these logs count the version line and the lines
/// of all files of the stage (Mesa does not support #line FILE).
std::string first_complaint(std::string_view log, const std::vector<ShaderSource>& files);

}  // namespace tessera::gl
