// A linked OpenGL program and its uniforms.
#pragma once

#include <stdexcept>
#include <string>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include "host/companion/window/frame/palette.hpp"

namespace inkwell::window {

class ShaderProgram {
 public:
  /// Throws std::runtime_error with the driver's log if compilation fails.
  ShaderProgram(const char* vertex_source, const char* fragment_source);
  ~ShaderProgram();
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;

  void use() const { glUseProgram(shader_program_); }
  void set(const char* name, const glm::mat4& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec4& value) const;
  void set(const char* name, float value) const;
  void set(const char* name, Colour value) const;

 private:
  GLint location(const char* name) const { return glGetUniformLocation(shader_program_, name); }
  GLuint shader_program_;
};

glm::vec4 to_vector(Colour colour);

}  // namespace inkwell::window
