// Upright camera that orbits the scene. In view space, x points to the right, y up, and z towards the user.
#pragma once

#include <glm/glm.hpp>

namespace inkwell::window {

struct Ray {
  glm::vec3 origin;
  glm::vec3 direction;  ///< unit vector
};

struct Camera {
  glm::vec3 centre_m{0.0f};
  float azimuth_rad = 0.0f;    ///< 0: view along -z; a positive angle moves the eye to the right
  float elevation_rad = 0.0f;  ///< positive: view from above
  float distance_m = 0.6f;

  void orbit(float azimuth_change_rad, float elevation_change_rad);
  /// Moves the center. Points at the depth of the center move by `pixels`.
  void pan(glm::vec2 pixels, float view_height_pixels);
  void zoom(float steps);  ///< steps of the mouse wheel; positive moves closer

  glm::vec3 eye_m() const;
  glm::vec3 direction() const;  ///< viewing direction
  glm::mat4 view() const;
  glm::mat4 projection(float aspect_ratio) const;
  /// Returns the size of a pixel at the depth of `at_m`, in meters.
  float metres_per_pixel(glm::vec3 at_m, float view_height_pixels) const;
  /// Returns the ray through a pixel; (0,0) is the top left corner.
  Ray ray(glm::vec2 pixel, glm::vec2 view_size_pixels) const;
  /// Projects a point to pixels. The depth z of visible points is between 0 and 1.
  glm::vec3 project(glm::vec3 point_m, glm::vec2 view_size_pixels) const;

  static constexpr float field_of_view_rad = 0.62f;

  bool operator==(const Camera&) const = default;
};

/// Returns the intersection of the ray with a plane. The plane contains `point_m` and is perpendicular to the viewing
/// direction.
glm::vec3 on_view_plane(const Camera& camera, const Ray& ray, glm::vec3 point_m);

/// Returns the t for which `point + t * direction` is nearest to the ray; `direction` is a unit vector.
float nearest_on_line(const Ray& ray, glm::vec3 point, glm::vec3 direction);

/// Returns a camera that shows the whole box from slightly above.
Camera look_at_box(glm::vec3 minimum_m, glm::vec3 maximum_m);

}  // namespace inkwell::window
