#include <doctest/doctest.h>

#include <cmath>

#include "firmware/control/signal_path/local_model.hpp"

namespace {

using namespace inkwell;
using control::Feature;
using control::Vector3;
using protocol::FeatureKind;

Feature feature_of(FeatureKind kind, const Vector3& centre_m, const Vector3& axis, float radius_m = 0.0f) {
  Feature feature{};
  feature.kind = kind;
  feature.centre_m = centre_m;
  feature.axis = axis;
  feature.radius_m = radius_m;
  return feature;
}

constexpr Vector3 point_m{0.004f, 0.003f, 0.012f};

float height_m(const Feature& feature, float age_s) {
  const float offset_m = feature.tangent.offset_m + age_s * feature.tangent_speed_m_per_s;
  return dot(feature.tangent.normal, point_m) - offset_m;
}

TEST_CASE("heights above a plane, a sphere and a cylinder") {
  const auto check = [](Feature feature, float expected_m, const Vector3& normal) {
    renew_tangent(feature, point_m, 0.0f);
    CHECK(height_m(feature, 0.0f) == doctest::Approx(expected_m).epsilon(1e-4));
    CHECK(dot(feature.tangent.normal, normal) == doctest::Approx(1.0f));
  };
  check(feature_of(FeatureKind::plane, {0, 0, 0.002f}, {0, 0, 1}), 0.01f, {0, 0, 1});
  check(feature_of(FeatureKind::sphere, {}, {}, 0.005f), 0.008f, {4 / 13.0f, 3 / 13.0f, 12 / 13.0f});
  check(feature_of(FeatureKind::cylinder, {0.3f, 0, 0.008f}, {1, 0, 0}, 0.001f), 0.004f, {0, 0.6f, 0.8f});
}

TEST_CASE("between two renewals the tangent plane follows the motion and the rotation of its feature") {
  for (const auto kind : {FeatureKind::plane, FeatureKind::sphere, FeatureKind::cylinder}) {
    CAPTURE(static_cast<int>(kind));
    Feature feature = feature_of(kind, {0.001f, 0.002f, 0.003f}, {0.6f, 0.0f, 0.8f}, 0.002f);
    feature.motion.velocity_m_per_s = {0.3f, -0.2f, 0.4f};
    feature.axis_rate_per_s = {0.8f * 3, 2, -0.6f * 3};
    if (kind == FeatureKind::sphere) feature.axis = feature.axis_rate_per_s = {};
    constexpr float between_s = 3 * protocol::servo_period_s;
    for (const float age_s : {0.0f, 0.005f}) {
      renew_tangent(feature, point_m, age_s);
      const float before_m = height_m(feature, age_s), predicted_m = height_m(feature, age_s + between_s);
      renew_tangent(feature, point_m, age_s + between_s);
      const float renewed_m = height_m(feature, age_s + between_s);
      CHECK(std::fabs(renewed_m - before_m) > 1e-5f);  // the surface has moved
      CHECK(std::fabs(renewed_m - predicted_m) < 3e-7f);
    }
  }
}

TEST_CASE("the tangent plane of a cylinder that has rotated for 20 ms touches the cylinder") {
  Feature feature = feature_of(FeatureKind::cylinder, {-0.004f, 0, 0}, {1, 0, 0}, 0.01f);
  for (const float spin_rad_per_s : {3.0f, 10.0f}) {
    CAPTURE(spin_rad_per_s);
    constexpr float age_s = 0.02f;
    feature.axis_rate_per_s = {0, spin_rad_per_s, 0};
    const Vector3 line{1, age_s * spin_rad_per_s, 0};
    const Vector3 away_m = cross(line, point_m - feature.centre_m);
    const float distance_m = std::sqrt(dot(away_m, away_m) / dot(line, line));
    renew_tangent(feature, point_m, age_s);
    const float error_m = height_m(feature, age_s) - (distance_m - feature.radius_m);
    CHECK(error_m > -2e-6f);  // not outside the cylinder
    CHECK(error_m < 1e-5f);
  }
}

TEST_CASE("a new feature excludes no point, and in its core its tangent plane does not change") {
  Feature feature = feature_of(FeatureKind::sphere, point_m, {}, 0.005f);
  renew_tangent(feature, point_m, 0.0f);
  CHECK(height_m(feature, 0.0f) > 0.0f);
  control::LocalModel model;
  model.features[0] = feature;
  model.features[1] = feature_of(FeatureKind::plane, {}, {0, 0, 1});
  model.count = 2;
  find_tangents(model, {0, 0, 0.006f});
  CHECK(model.features[0].tangent.normal.z < -0.5f);
  CHECK(model.features[1].tangent.normal.z == 1.0f);
}

}  // namespace
