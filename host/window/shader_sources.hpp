// The shaders of the scene. Cheap on purpose: they also run on a processor without a graphics card.
#pragma once

namespace inkwell::window::shaders {

/// A triangle that covers the viewport, without vertices of its own.
inline constexpr char sky_vertex[] = R"(#version 330 core
out float height;
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  height = corner.y;
  gl_Position = vec4(2.0 * corner - 1.0, 0.9999, 1.0);
})";

inline constexpr char sky_fragment[] = R"(#version 330 core
in float height;
uniform vec4 top;
uniform vec4 bottom;
out vec4 colour;
void main() { colour = vec4(mix(bottom.rgb, top.rgb, height), 1.0); })";

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
inline constexpr char panel_vertex[] = R"(#version 330 core
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

/// A wall: a faint pane with a grid of 20 mm, a frame, and a glow around the place where it pushes back.
inline constexpr char wall_fragment[] = R"(#version 330 core
in vec2 place;
uniform vec2 size;
uniform vec4 frame_colour;   // alpha: of the frame
uniform float fill;          // alpha of the pane
uniform float grid;          // alpha of the grid
uniform vec2 contact;
uniform float glow;          // 0 none, 1 full
out vec4 colour;
void main() {
  vec2 pixel = fwidth(place);
  vec2 to_edge = min(place, size - place) / pixel;
  float frame = 1.0 - smoothstep(0.9, 1.9, min(to_edge.x, to_edge.y));
  vec2 to_line = abs(fract(place / 0.02 - 0.5) - 0.5) * 0.02 / pixel;
  float line = 1.0 - min(min(to_line.x, to_line.y), 1.0);
  vec2 offset = place - contact;
  float near = 1.0 / (1.0 + dot(offset, offset) * 2600.0);
  float pane = fill + grid * line + glow * near * near * 0.6;
  colour = vec4(frame_colour.rgb, max(frame * frame_colour.a, min(pane, 0.85)));
})";

/// The table: a grid of 50 mm that fades with the distance from the middle.
inline constexpr char floor_fragment[] = R"(#version 330 core
in vec2 place;
uniform vec2 size;
uniform vec4 line_colour;
out vec4 colour;
void main() {
  vec2 from_middle = place - 0.5 * size;
  vec2 pixel = max(fwidth(place), vec2(1e-6));
  vec2 to_line = abs(fract(from_middle / 0.05 - 0.5) - 0.5) * 0.05 / pixel;
  float line = 1.0 - min(min(to_line.x, to_line.y), 1.0);
  float fade = 1.0 - smoothstep(0.25, 0.5, length(from_middle) / size.x);
  colour = vec4(line_colour.rgb, line * fade * 0.75 + 0.05 * fade);
})";

}  // namespace inkwell::window::shaders
