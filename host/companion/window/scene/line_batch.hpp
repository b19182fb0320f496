// Antialiased lines with a fixed width in pixels, drawn as bands with soft edges. Multisampling would be too slow
// without a graphics card.
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

  /// Adds a line between two points in view space. The color and its alpha are interpolated.
  void add(glm::vec3 from, glm::vec3 to, glm::vec4 from_colour, glm::vec4 to_colour, float width_pixels);
  /// Draws the lines in the order of addition, and clears the batch.
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
