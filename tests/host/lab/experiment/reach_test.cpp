// The experiment refuses a wall that the arm cannot reach, and a folder with an earlier experiment.
#include <doctest/doctest.h>

#include <fstream>

#include "firmware/control/settings.hpp"
#include "host/client/device/error.hpp"
#include "host/lab/experiment/reach.hpp"
#include "host/lab/experiment/wall_experiment.hpp"

#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using inkwell::tests::contains;
using inkwell::tests::message_of;
using protocol::Parameter;

TEST_CASE("each position within the stops is reachable, and a position beyond them has its distance") {
  const auto parameters = protocol::default_parameters();
  const auto arm = control::prepare(parameters).arm;
  const auto part_of = [&](Parameter minimum, Parameter maximum, float part) {
    return parameters[minimum] + part * (parameters[maximum] - parameters[minimum]);
  };
  const auto position_m = [&](float part_1, float part_2, float part_elbow) {
    const float joint_2_rad = part_of(Parameter::joint_2_minimum_rad, Parameter::joint_2_maximum_rad, part_2);
    const float elbow_rad = part_of(Parameter::elbow_minimum_rad, Parameter::elbow_maximum_rad, part_elbow);
    const auto at =
        control::forward_kinematics(
            {part_of(Parameter::joint_1_minimum_rad, Parameter::joint_1_maximum_rad, part_1), joint_2_rad,
             arm.transmission == control::Transmission::parallelogram ? joint_2_rad + elbow_rad : elbow_rad},
            arm)
            .position_m;
    return device::Vector3{static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)};
  };
  for (const float part_1 : {0.1f, 0.5f, 0.9f})
    for (const float part_2 : {0.1f, 0.5f, 0.9f})
      for (const float part_elbow : {0.1f, 0.5f, 0.9f})
        CHECK(experiment::distance_to_reach_m(parameters, position_m(part_1, part_2, part_elbow)) < 0.001);
  const auto longest_m = static_cast<double>(arm.link_2_m + arm.link_3_m);
  const device::Vector3 far_m{static_cast<double>(arm.origin_m.x), static_cast<double>(arm.origin_m.y),
                              static_cast<double>(arm.origin_m.z) + 1.0};
  CHECK(experiment::distance_to_reach_m(parameters, far_m) > 1.0 - longest_m - 0.001);
}

TEST_CASE("an experiment in the folder is not overwritten") {
  const tests::TemporaryDirectory directory;
  CHECK_NOTHROW(experiment::check_has_no_experiment(directory.path()));
  std::ofstream(directory / "summary.json") << "{}";
  const auto said = message_of<device::Error>([&] { experiment::check_has_no_experiment(directory.path()); });
  CHECK(contains(said, "summary.json exists"));
  CHECK(contains(said, "--out"));
}
