// Shaders of the scene. The shaders must be fast on computers without a graphics card.
#pragma once

namespace inkwell::window::shaders {

/// Draws the background gradient.
inline constexpr char sky_vertex[] = R"(#version 330 core
uniform vec4 top;
uniform vec4 bottom;
out vec3 shade;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  shade = mix(bottom.rgb, top.rgb, corner.y);
  gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
})";

inline constexpr char sky_fragment[] = R"(#version 330 core
in vec3 shade;
out vec4 colour;
void main() { colour = vec4(shade, 1.0); })";

/// Draws all bodies. Positions and normals of the bodies are in view space.
inline constexpr char solid_vertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 body_colour;   // as bytes
layout(location = 3) in float body_shininess;
uniform mat4 to_clip;
out vec3 world;
out vec3 world_normal;
out vec4 base_colour;
out float shininess;
void main() {
  world = position;
  world_normal = normal;
  base_colour = body_colour;
  shininess = body_shininess;
  gl_Position = to_clip * vec4(position, 1.0);
})";

/// Draws an object. Position and normal are in mesh axes.
inline constexpr char object_vertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 to_view;
uniform mat4 to_clip;
uniform vec4 object_colour;
out vec3 world;
out vec3 world_normal;
out vec4 base_colour;
out float shininess;
void main() {
  world = (to_view * vec4(position, 1.0)).xyz;
  world_normal = mat3(to_view) * normal;
  base_colour = object_colour;
  shininess = 0.3;
  gl_Position = to_clip * vec4(world, 1.0);
})";

/// With two_sided = 1, the rear side of a triangle is lit like its front side.
inline constexpr char solid_fragment[] = R"(#version 330 core
in vec3 world;
in vec3 world_normal;
in vec4 base_colour;
in float shininess;
uniform vec3 eye;
uniform float lit;
uniform float two_sided;
out vec4 colour;
const vec3 key = vec3(0.420, 0.747, 0.514);   // of length 1
void main() {
  vec3 n = normalize(world_normal);
  if (two_sided > 0.5 && !gl_FrontFacing) n = -n;
  vec3 to_eye = normalize(eye - world);
  float diffuse = max(dot(n, key), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float facing = 1.0 - max(dot(n, to_eye), 0.0);
  float rim = facing * facing * facing;
  // The 32nd power is computed by squaring, because pow() is slow without a graphics card.
  float gloss = max(dot(n, normalize(key + to_eye)), 0.0);
  gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
  vec3 shaded = base_colour.rgb * (0.34 + 0.26 * sky + 0.52 * diffuse) + shininess * (0.55 * gloss + 0.18 * rim);
  colour = vec4(mix(base_colour.rgb, shaded, lit), base_colour.a);
})";

inline constexpr char shadow_vertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 to_clip;
void main() { gl_Position = to_clip * vec4(position, 1.0); })";

inline constexpr char shadow_fragment[] = R"(#version 330 core
uniform vec4 base_colour;
out vec4 colour;
void main() { colour = base_colour; })";

/// Draws a rectangle with the given corner and edges. `position_m` is the position along the edges, in meters.
inline constexpr char wall_vertex[] = R"(#version 330 core
uniform vec3 corner;
uniform vec3 edge_u;
uniform vec3 edge_v;
uniform mat4 to_clip;
out vec2 position_m;
void main() {
  vec2 part = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  position_m = part * vec2(length(edge_u), length(edge_v));
  gl_Position = to_clip * vec4(corner + part.x * edge_u + part.y * edge_v, 1.0);
})";

/// Draws the surface of a wall, including a glow around the contact point.
inline constexpr char wall_fragment[] = R"(#version 330 core
in vec2 position_m;
uniform vec4 base_colour;
uniform vec2 contact;
uniform float glow;
out vec4 colour;
void main() {
  vec2 offset = position_m - contact;
  float near = 1.0 / (1.0 + dot(offset, offset) * 2600.0);
  colour = vec4(base_colour.rgb, base_colour.a + glow * near * near);
})";

/// Draws lines as bands. The vertices are in clip space. The distance across a band is in pixels, which requires
/// interpolation without perspective correction.
inline constexpr char line_vertex[] = R"(#version 330 core
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 end_colour;
layout(location = 2) in vec2 across;
noperspective out vec2 from_middle;
out vec4 line_colour;
void main() {
  from_middle = across;
  line_colour = end_colour;
  gl_Position = position;
})";

inline constexpr char line_fragment[] = R"(#version 330 core
noperspective in vec2 from_middle;
in vec4 line_colour;
out vec4 colour;
void main() {
  float cover = clamp(from_middle.y + 0.5 - abs(from_middle.x), 0.0, 1.0);
  colour = vec4(line_colour.rgb, line_colour.a * cover);
})";

}  // namespace inkwell::window::shaders
