// SPDX-License-Identifier: BSD-3-Clause
#include "gl/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "scene/error.hpp"

namespace tessera::gl {
namespace {

scene::Error refused(const Context& context, const std::string& complaint) {
  return {scene::ErrorCode::system_failure,
          fmt::format("{}: {}; please report, and use `backend` cpu", context.name(), complaint)};
}

GLuint compile(const Context& context, const Stage& stage) {
  const Functions& gl = context.gl();
  std::string text = "#version 450 core\n";
  for (const ShaderSource& file : stage.files) text.append(file.text).append("\n");
  const GLuint shader = gl.CreateShader(stage.kind);
  const char* const begin = text.c_str();
  gl.ShaderSource(shader, 1, &begin, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0, length = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != 0) return shader;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl.GetShaderInfoLog(shader, length, &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  gl.DeleteShader(shader);
  throw refused(context, first_complaint(log, stage.files));
}

}  // namespace

std::string first_complaint(std::string_view log, const std::vector<ShaderSource>& files) {
  static const std::regex place(R"((?:^|\s)\d+(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:\s*(.*))");
  std::string first;
  for (std::string_view rest = log; !rest.empty();) {
    const std::string words(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(std::min(rest.size(), words.size() + 1));
    if (first.empty()) first = words;
    std::smatch found;
    if (words.find("rror") == std::string::npos && words.find("ERROR") == std::string::npos) continue;
    if (!std::regex_search(words, found, place)) continue;
    std::ptrdiff_t line = std::stol(found[1].matched ? found[1] : found[2]) - 1;  // without the version line
    for (const ShaderSource& file : files) {
      const std::ptrdiff_t lines = 1 + std::count(file.text.begin(), file.text.end(), '\n');
      if (line <= lines) return fmt::format("{}:{}: {}", file.file, line, found[3].str());
      line -= lines;
    }
  }
  return fmt::format("{}: {}", files.empty() ? "shader" : files.back().file, first.empty() ? "refused" : first);
}

Program::Program(const Context& context, const std::vector<Stage>& stages) : gl_(&context.gl()) {
  std::vector<GLuint> shaders;
  try {
    for (const Stage& stage : stages) shaders.push_back(compile(context, stage));
  } catch (...) {
    for (const GLuint shader : shaders) gl_->DeleteShader(shader);
    throw;
  }
  name_ = gl_->CreateProgram();
  for (const GLuint shader : shaders) gl_->AttachShader(name_, shader);
  gl_->LinkProgram(name_);
  for (const GLuint shader : shaders) gl_->DeleteShader(shader);
  GLint linked = 0, length = 0;
  gl_->GetProgramiv(name_, GL_LINK_STATUS, &linked);
  if (linked != 0) return;
  gl_->GetProgramiv(name_, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl_->GetProgramInfoLog(name_, length, &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  gl_->DeleteProgram(name_);
  throw refused(context, first_complaint(log, stages.back().files));
}

Program::~Program() { gl_->DeleteProgram(name_); }

}  // namespace tessera::gl
