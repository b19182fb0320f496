// The eye of the scene: it orbits around a point, upright, in "view space": x right, y up, z to the user.
#pragma once

#include <glm/glm.hpp>

namespace inkwell::window {

struct Ray {
  glm::vec3 origin;
  glm::vec3 direction;  ///< of length 1
};

struct Camera {
  glm::vec3 centre_m{0.0f};
  float azimuth_rad = 0.0f;    ///< 0 looks along -z, positive moves the eye to the right
  float elevation_rad = 0.0f;  ///< positive looks down
  float distance_m = 0.6f;

  void orbit(float azimuth_change_rad, float elevation_change_rad);
  /// Moves the centre so that what lies in its depth follows the mouse by `pixels`.
  void pan(glm::vec2 pixels, float view_height_pixels);
  void zoom(float steps);  ///< of the wheel; positive comes closer

  glm::vec3 eye_m() const;
  glm::vec3 direction() const;  ///< into the picture
  glm::mat4 view() const;
  glm::mat4 projection(float aspect_ratio) const;
  /// Metres that one pixel covers at a point.
  float metres_per_pixel(glm::vec3 at_m, float view_height_pixels) const;
  /// The ray under a place of the picture, (0,0) top left.
  Ray ray(glm::vec2 pixel, glm::vec2 view_size_pixels) const;
  /// Where a point is in the picture; z is its depth 0..1, outside of that it is not visible.
  glm::vec3 project(glm::vec3 point_m, glm::vec2 view_size_pixels) const;

  static constexpr float field_of_view_rad = 0.62f;
};

/// Where the ray meets the plane through `point` that faces the eye of `camera`.
glm::vec3 on_view_plane(const Camera& camera, const Ray& ray, glm::vec3 point_m);

/// Coordinate along the line `point + t * direction` (direction of length 1) that is nearest to the ray.
float nearest_on_line(const Ray& ray, glm::vec3 point, glm::vec3 direction);

/// A camera from which a box can be seen whole, from the user's place, a little from above.
Camera look_at_box(glm::vec3 minimum_m, glm::vec3 maximum_m);

}  // namespace inkwell::window
