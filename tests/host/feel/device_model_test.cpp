#include <doctest/doctest.h>

#include "host/feel/device_model.hpp"
#include "host/feel/materials.hpp"
#include "protocol/parameters.hpp"

using namespace inkwell;

TEST_CASE("a local model keeps its features, its anchor and its motion") {
  contact::LocalModel model;
  model.count = 2;
  model.features[0] = {contact::Feature::Kind::cylinder, 7, {0, 1, 0}, {0.01f, 0.02f, 0.03f}, 0.001f, 5, true};
  model.features[1] = {contact::Feature::Kind::sphere, 8, {0, 0, 1}, {0.04f, 0, 0}, 0.002f, 6, false};
  model.anchor_m = {0.016f, 0, 0.032f};
  model.velocity_m_per_s = {1, 2, 3};
  model.spin_rad_per_s = {4, 5, 6};
  const device::LocalModel converted = feel::device_model(model);
  REQUIRE(converted.count == 2);
  CHECK(converted.features[0].kind == protocol::FeatureKind::cylinder);
  CHECK(converted.features[0].direction == std::array{0.0f, 1.0f, 0.0f});
  CHECK(converted.features[0].point_m == std::array{0.01f, 0.02f, 0.03f});
  CHECK(converted.features[0].radius_m == 0.001f);
  CHECK(converted.features[0].material == 5);
  CHECK(converted.features[0].moves);
  CHECK(converted.features[1].kind == protocol::FeatureKind::sphere);
  CHECK_FALSE(converted.features[1].moves);
  CHECK(converted.anchor_m == std::array{0.016f, 0.0f, 0.032f});
  CHECK(converted.velocity_m_per_s == std::array{1.0f, 2.0f, 3.0f});
  CHECK(converted.spin_rad_per_s == std::array{4.0f, 5.0f, 6.0f});
  CHECK(converted.life_ms == protocol::local_model_life_maximum_ms);
}

TEST_CASE("the board accepts every named material") {
  for (const feel::NamedMaterial& material : feel::materials()) {
    CAPTURE(std::string(material.name));
    contact::Scene scene;
    scene.materials[3] = material.properties;
    const device::Shapes shapes{.materials = feel::device_materials(scene)};
    REQUIRE(shapes.materials.size() == protocol::materials_maximum);
    const protocol::ShapesReport report = device::shapes_report(shapes);
    CHECK(report.materials[3].stiffness_N_per_m == material.properties.stiffness_N_per_m);
    CHECK(report.materials[3].dynamic_friction == material.properties.dynamic_friction);
    CHECK(feel::find_material(material.name) == &material);
  }
  CHECK(feel::find_material("cheese") == nullptr);
  CHECK(feel::material_names().find("wood, rubber") == 0);
}
