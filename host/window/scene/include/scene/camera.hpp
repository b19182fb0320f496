// Orbiting camera of the scene, always upright. View space: x right, y up, z towards the user.
#pragma once

#include <glm/glm.hpp>

namespace inkwell::window {

struct Ray {
  glm::vec3 origin;
  glm::vec3 direction;  ///< unit vector
};

struct Camera {
  glm::vec3 centre_m{0.0f};
  float azimuth_rad = 0.0f;    ///< 0 looks along -z; a positive angle moves the eye to the right
  float elevation_rad = 0.0f;  ///< a positive angle looks down
  float distance_m = 0.6f;

  void orbit(float azimuth_change_rad, float elevation_change_rad);
  /// Moves the center so that points at its depth follow the mouse by `pixels`.
  void pan(glm::vec2 pixels, float view_height_pixels);
  void zoom(float steps);  ///< steps of the mouse wheel; positive moves closer

  glm::vec3 eye_m() const;
  glm::vec3 direction() const;  ///< viewing direction
  glm::mat4 view() const;
  glm::mat4 projection(float aspect_ratio) const;
  /// Meters per pixel at a point.
  float metres_per_pixel(glm::vec3 at_m, float view_height_pixels) const;
  /// Returns the ray through a pixel; (0,0) is the top left corner.
  Ray ray(glm::vec2 pixel, glm::vec2 view_size_pixels) const;
  /// Projects a point to pixels. z is the depth; a point is visible only if z is between 0 and 1.
  glm::vec3 project(glm::vec3 point_m, glm::vec2 view_size_pixels) const;

  static constexpr float field_of_view_rad = 0.62f;
};

/// Returns the intersection of the ray with the plane through `point` that faces the eye of `camera`.
glm::vec3 on_view_plane(const Camera& camera, const Ray& ray, glm::vec3 point_m);

/// Returns the t for which `point + t * direction` is nearest to the ray; `direction` is a unit vector.
float nearest_on_line(const Ray& ray, glm::vec3 point, glm::vec3 direction);

/// Returns a camera that shows the whole box from the user's side, slightly from above.
Camera look_at_box(glm::vec3 minimum_m, glm::vec3 maximum_m);

}  // namespace inkwell::window
