// Smooth lines of a fixed width in pixels, as flat bands with soft edges: all of them in one draw call, and
// without multisampling, which a processor without a graphics card could not afford.
#pragma once

#include <vector>

#include <epoxy/gl.h>
#include <glm/glm.hpp>

#include "shader.hpp"

namespace inkwell::window {

class LineBatch {
 public:
  LineBatch();
  ~LineBatch();
  LineBatch(const LineBatch&) = delete;
  LineBatch& operator=(const LineBatch&) = delete;

  /// From one point to the other in view space; colours with alpha at both ends.
  void add(glm::vec3 from, glm::vec3 to, glm::vec4 from_colour, glm::vec4 to_colour, float width_pixels);
  /// Draws what was added, in that order, and forgets it.
  void draw(const glm::mat4& to_clip, glm::vec2 viewport_pixels);

 private:
  struct Segment {
    glm::vec3 from, to;
    glm::vec4 from_colour, to_colour;
    float width_pixels;
  };
  struct Corner {
    glm::vec4 place;  // in clip space
    glm::vec4 colour;
    glm::vec2 across;  // distance from the middle and half the width, pixels
  };

  std::vector<Segment> segments_;
  std::vector<Corner> corners_;
  GLuint vertex_array_ = 0;
  GLuint buffer_ = 0;
  ShaderProgram program_;
};

}  // namespace inkwell::window
