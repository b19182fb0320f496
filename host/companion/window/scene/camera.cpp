#include "host/companion/window/scene/camera.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace inkwell::window {

namespace {
constexpr float elevation_limit_rad = 1.5f;  // below 90 degrees, where the up direction is undefined
constexpr float nearest_m = 0.08f;
constexpr float farthest_m = 3.0f;
constexpr float zoom_per_step = 0.12f;
}  // namespace

void Camera::orbit(float azimuth_change_rad, float elevation_change_rad) {
  azimuth_rad = std::remainder(azimuth_rad + azimuth_change_rad, 2.0f * 3.14159265f);
  elevation_rad = std::clamp(elevation_rad + elevation_change_rad, -elevation_limit_rad, elevation_limit_rad);
}

void Camera::pan(glm::vec2 pixels, float view_height_pixels) {
  const glm::mat4 to_view = view();
  const glm::vec3 right{to_view[0][0], to_view[1][0], to_view[2][0]};
  const glm::vec3 up{to_view[0][1], to_view[1][1], to_view[2][1]};
  const float scale = metres_per_pixel(centre_m, view_height_pixels);
  centre_m += scale * (-pixels.x * right + pixels.y * up);
}

void Camera::zoom(float steps) {
  distance_m = std::clamp(distance_m * std::exp(-zoom_per_step * steps), nearest_m, farthest_m);
}

glm::vec3 Camera::direction() const {
  return {-std::sin(azimuth_rad) * std::cos(elevation_rad), -std::sin(elevation_rad),
          -std::cos(azimuth_rad) * std::cos(elevation_rad)};
}

glm::vec3 Camera::eye_m() const { return centre_m - distance_m * direction(); }

glm::mat4 Camera::view() const { return glm::lookAt(eye_m(), centre_m, glm::vec3{0.0f, 1.0f, 0.0f}); }

glm::mat4 Camera::projection(float aspect_ratio) const {
  return glm::perspective(field_of_view_rad, aspect_ratio, 0.02f, 8.0f);
}

float Camera::metres_per_pixel(glm::vec3 at_m, float view_height_pixels) const {
  const float depth_m = std::max(glm::dot(at_m - eye_m(), direction()), nearest_m);
  return 2.0f * depth_m * std::tan(0.5f * field_of_view_rad) / std::max(view_height_pixels, 1.0f);
}

Ray Camera::ray(glm::vec2 pixel, glm::vec2 size) const {
  const glm::mat4 to_scene = glm::inverse(projection(size.x / size.y) * view());
  const glm::vec2 clip{2.0f * pixel.x / size.x - 1.0f, 1.0f - 2.0f * pixel.y / size.y};
  const glm::vec4 far_point = to_scene * glm::vec4{clip, 1.0f, 1.0f};
  const glm::vec3 eye = eye_m();
  return {eye, glm::normalize(glm::vec3{far_point} / far_point.w - eye)};
}

glm::vec3 Camera::project(glm::vec3 point_m, glm::vec2 size) const {
  const glm::vec4 clip = projection(size.x / size.y) * view() * glm::vec4{point_m, 1.0f};
  if (clip.w <= 0.0f) return {0.0f, 0.0f, -1.0f};
  const glm::vec3 normalised = glm::vec3{clip} / clip.w;
  return {0.5f * (normalised.x + 1.0f) * size.x, 0.5f * (1.0f - normalised.y) * size.y, 0.5f * (normalised.z + 1.0f)};
}

glm::vec3 on_view_plane(const Camera& camera, const Ray& ray, glm::vec3 point_m) {
  const glm::vec3 normal = camera.direction();
  const float along = glm::dot(ray.direction, normal);
  return ray.origin + ray.direction * (glm::dot(point_m - ray.origin, normal) / along);
}

float nearest_on_line(const Ray& ray, glm::vec3 point, glm::vec3 direction) {
  const glm::vec3 offset = ray.origin - point;
  const float cosine = glm::dot(ray.direction, direction);
  const float determinant = 1.0f - cosine * cosine;
  const float along_line = glm::dot(offset, direction);
  if (determinant < 1e-4f) return along_line;  // for parallel lines, all points have the same distance
  return (along_line - cosine * glm::dot(offset, ray.direction)) / determinant;
}

Camera look_at_box(glm::vec3 minimum_m, glm::vec3 maximum_m) {
  Camera camera;
  const float radius_m = 0.5f * glm::length(maximum_m - minimum_m);
  camera.centre_m = 0.5f * (minimum_m + maximum_m);
  camera.centre_m.z -= 0.25f * radius_m;  // slightly towards the arm, which is behind the box
  camera.azimuth_rad = 0.56f;
  camera.elevation_rad = 0.36f;
  camera.distance_m = std::clamp(1.32f * radius_m / std::tan(0.5f * Camera::field_of_view_rad), nearest_m, farthest_m);
  return camera;
}

}  // namespace inkwell::window
