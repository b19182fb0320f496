// The shaders of the scene. Cheap on purpose: they also run on a processor without a graphics card.
#pragma once

namespace inkwell::window::shaders {

inline constexpr char solid_vertex[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 placement;
uniform mat4 to_clip;
out vec3 world;
out vec3 world_normal;
void main() {
  vec4 place = placement * vec4(position, 1.0);
  world = place.xyz;
  // Stretched bodies are round across their axis, so the cofactor matrix is left out but for its scale.
  world_normal = normal.x * placement[0].xyz / dot(placement[0].xyz, placement[0].xyz)
               + normal.y * placement[1].xyz / dot(placement[1].xyz, placement[1].xyz)
               + normal.z * placement[2].xyz / dot(placement[2].xyz, placement[2].xyz);
  gl_Position = to_clip * place;
})";

inline constexpr char solid_fragment[] = R"(#version 330 core
in vec3 world;
in vec3 world_normal;
uniform vec4 base_colour;
uniform vec3 eye;
uniform float shininess;
uniform float lit;
out vec4 colour;
void main() {
  vec3 n = normalize(world_normal);
  vec3 to_eye = normalize(eye - world);
  vec3 key = normalize(vec3(0.45, 0.80, 0.55));
  float diffuse = max(dot(n, key), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 3.0);
  float gloss = pow(max(dot(n, normalize(key + to_eye)), 0.0), 40.0);
  vec3 shaded = base_colour.rgb * (0.34 + 0.26 * sky + 0.52 * diffuse) + shininess * (0.55 * gloss + 0.18 * rim);
  colour = vec4(mix(base_colour.rgb, shaded, lit), base_colour.a);
})";

inline constexpr char shadow_fragment[] = R"(#version 330 core
in vec3 world;
in vec3 world_normal;
uniform vec4 base_colour;
out vec4 colour;
void main() { colour = base_colour; })";

/// A rectangle given by a corner and two edges; `place` is in metres along the edges.
inline constexpr char pane_vertex[] = R"(#version 330 core
uniform vec3 corner;
uniform vec3 edge_u;
uniform vec3 edge_v;
uniform mat4 to_clip;
out vec2 place;
void main() {
  vec2 part = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = part * vec2(length(edge_u), length(edge_v));
  gl_Position = to_clip * vec4(corner + part.x * edge_u + part.y * edge_v, 1.0);
})";

/// The pane of a wall, with a glow around the place where it pushes back.
inline constexpr char pane_fragment[] = R"(#version 330 core
in vec2 place;
uniform vec4 base_colour;
uniform vec2 contact;
uniform float glow;
out vec4 colour;
void main() {
  vec2 offset = place - contact;
  float near = 1.0 / (1.0 + dot(offset, offset) * 2600.0);
  colour = vec4(base_colour.rgb, base_colour.a + glow * near * near);
})";

/// Lines come as bands that are already in clip space. Across a band the distance is in pixels, so it must not
/// be bent by the perspective.
inline constexpr char line_vertex[] = R"(#version 330 core
layout(location = 0) in vec4 place;
layout(location = 1) in vec4 end_colour;
layout(location = 2) in vec2 across;
noperspective out vec2 from_middle;
out vec4 line_colour;
void main() {
  from_middle = across;
  line_colour = end_colour;
  gl_Position = place;
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
