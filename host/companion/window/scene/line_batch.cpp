#include "host/companion/window/scene/line_batch.hpp"

#include <utility>

#include "host/companion/window/scene/shader_sources.hpp"

namespace inkwell::window {

namespace {

constexpr float nearest_w = 0.02f;  // lines closer to the eye are clipped
constexpr float soft_edge_pixels = 0.5f;

}  // namespace

LineBatch::LineBatch() : shader_program_(shaders::line_vertex, shaders::line_fragment) {
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(1, &buffer_);
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  const auto attribute = [](GLuint location, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, sizeof(Corner), reinterpret_cast<void*>(offset));
  };
  attribute(0, 4, offsetof(Corner, position));
  attribute(1, 4, offsetof(Corner, colour));
  attribute(2, 2, offsetof(Corner, across));
  glBindVertexArray(0);
}

LineBatch::~LineBatch() {
  glDeleteVertexArrays(1, &vertex_array_);
  glDeleteBuffers(1, &buffer_);
}

void LineBatch::add(glm::vec3 from, glm::vec3 to, glm::vec4 from_colour, glm::vec4 to_colour, float width_pixels) {
  segments_.push_back({from, to, from_colour, to_colour, width_pixels});
}

void LineBatch::draw(const glm::mat4& to_clip, glm::vec2 viewport_pixels) {
  corners_.clear();
  for (const Segment& segment : segments_) {
    glm::vec4 a = to_clip * glm::vec4{segment.from, 1.0f};
    glm::vec4 b = to_clip * glm::vec4{segment.to, 1.0f};
    glm::vec4 a_colour = segment.from_colour;
    glm::vec4 b_colour = segment.to_colour;
    if (a.w < nearest_w && b.w < nearest_w) continue;
    const float cut = (nearest_w - a.w) / (b.w - a.w);
    if (a.w < nearest_w) {
      a_colour = glm::mix(a_colour, b_colour, cut);
      a = glm::mix(a, b, cut);
    } else if (b.w < nearest_w) {
      b_colour = glm::mix(a_colour, b_colour, cut);
      b = glm::mix(a, b, cut);
    }
    const glm::vec2 along = (glm::vec2{b} / b.w - glm::vec2{a} / a.w) * viewport_pixels;
    const float length = glm::length(along);
    if (length < 1e-3f) continue;
    const float half_width = 0.5f * segment.width_pixels;
    const float reach = half_width + soft_edge_pixels;
    const glm::vec2 across = glm::vec2{-along.y, along.x} * (2.0f * reach / length) / viewport_pixels;
    const auto corner = [&](const glm::vec4& end, const glm::vec4& colour, float side) {
      corners_.push_back({end + glm::vec4{side * across * end.w, 0.0f, 0.0f}, colour, {side * reach, half_width}});
    };
    corner(a, a_colour, -1.0f);
    corner(a, a_colour, 1.0f);
    corner(b, b_colour, 1.0f);
    corner(a, a_colour, -1.0f);
    corner(b, b_colour, 1.0f);
    corner(b, b_colour, -1.0f);
  }
  segments_.clear();
  if (corners_.empty()) return;
  shader_program_.use();
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.size() * sizeof(Corner)), corners_.data(),
               GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners_.size()));
}

}  // namespace inkwell::window
