// Draws antialiased lines as bands with soft edges. The width of the lines is in pixels. Multisampling would be too
// slow without a graphics card.
#pragma once

#include <vector>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include "host/companion/window/scene/shader.hpp"

namespace inkwell::window {

class LineBatch {
 public:
  LineBatch();
  ~LineBatch();
  LineBatch(const LineBatch&) = delete;
  LineBatch& operator=(const LineBatch&) = delete;

  /// Adds a line between two points in view space. Interpolates color and alpha along the line.
  void add(glm::vec3 from, glm::vec3 to, glm::vec4 from_colour, glm::vec4 to_colour, float width_pixels);
  /// Draws all lines in order and clears the batch.
  void draw(const glm::mat4& to_clip, glm::vec2 viewport_pixels);

 private:
  struct Segment {
    glm::vec3 from, to;
    glm::vec4 from_colour, to_colour;
    float width_pixels;
  };
  struct Corner {
    glm::vec4 position;  // in clip space
    glm::vec4 colour;
    glm::vec2 across;  // distance from the center line and half of the width, in pixels
  };

  std::vector<Segment> segments_;
  std::vector<Corner> corners_;
  GLuint vertex_array_ = 0;
  GLuint buffer_ = 0;
  ShaderProgram shader_program_;
};

}  // namespace inkwell::window
