#include "boards/arms/description.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include "tests/failure.hpp"

namespace {

using namespace inkwell;
using protocol::Parameter;

/// Arm descriptions of this repository.
const std::filesystem::path arms_directory = std::filesystem::path(INKWELL_SOURCE_DIRECTORY) / "boards" / "arms";

std::string omni() {
  std::ifstream stream(arms_directory / "omni.toml");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Returns the Omni's description with a replaced part.
std::string omni_with(const std::string& piece, const std::string& instead) {
  std::string text = omni();
  const auto at = text.find(piece);
  REQUIRE_MESSAGE(at != std::string::npos, piece);
  return text.replace(at, piece.size(), instead);
}

/// Returns the error message of parse(), or "" if the text is accepted.
std::string complaint(const std::string& text) {
  return tests::message_of<arms::DescriptionError>([&] { arms::parse(text, "some.toml"); });
}

#define CHECK_SAYS(text, piece) CHECK_MESSAGE(tests::contains(text, piece), text)

}  // namespace

TEST_CASE("both arms of the repository are read") {
  const auto omni_arm = arms::read(arms_directory / "omni.toml");
  CHECK(omni_arm.name == "PHANTOM Omni");
  CHECK(omni_arm.parameters[Parameter::link_2_m] == 0.13335f);
  CHECK(omni_arm.parameters[Parameter::transmission] == 1.0f);
  CHECK(omni_arm.motor.inductance_H == 0.000238);
  CHECK(omni_arm.simulation.coulomb_friction_Nm[2] == 0.010);
  CHECK(omni_arm.simulation.rotor_inertia_kg_m2 == 1.03e-6);

  const auto paper_arm = arms::read(arms_directory / "paper.toml");
  CHECK(paper_arm.parameters[Parameter::transmission] == 0.0f);
  CHECK(paper_arm.parameters[Parameter::inkwell_joint_3_rad] == -2.0f);
}

TEST_CASE("every arm of the repository is read, and its current loops have one bandwidth") {
  for (const auto& file : std::filesystem::directory_iterator(arms_directory)) {
    if (file.path().extension() != ".toml") continue;
    CAPTURE(file.path());
    const auto arm = arms::read(file.path());
    const double pi = 3.14159265358979;
    const double by_inductance_Hz =
        arm.parameters[Parameter::current_proportional_gain_V_per_A] / (2 * pi * arm.motor.inductance_H);
    for (const float resistance_ohm : arm.parameters.of_each(Parameter::motor_resistance_1_ohm)) {
      const double by_resistance_Hz =
          arm.parameters[Parameter::current_integral_gain_V_per_As] / (2 * pi * resistance_ohm);
      CHECK(by_inductance_Hz == doctest::Approx(by_resistance_Hz).epsilon(0.02));
    }
    CHECK(by_inductance_Hz > 400);
    CHECK(by_inductance_Hz < 1600);
  }
}

TEST_CASE("rows that no arm sets keep their defaults") {
  const auto arm = arms::read(arms_directory / "paper.toml");
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    const auto& row = protocol::parameter_table[i];
    if (!row.belongs_to_arm) CHECK(arm.parameters.values[i] == row.default_value);
  }
  CHECK(info(Parameter::current_limit_2_A).belongs_to_arm);
  CHECK_FALSE(info(Parameter::speed_limit_m_per_s).belongs_to_arm);
}

TEST_CASE("an arm description that a Windows editor has saved is read") {
  std::ifstream file(arms_directory / "omni.toml");
  std::string text = "\xEF\xBB\xBF";
  for (std::string line; std::getline(file, line);) text += line + "\r\n";
  CHECK(arms::parse(text + "\r\n", "OMNI.TOML").name == "PHANTOM Omni");
}

TEST_CASE("a missing file is named") {
  CHECK_THROWS_AS(arms::read("/nowhere/arm.toml"), arms::DescriptionError);
  try {
    arms::read("/nowhere/arm.toml");
  } catch (const arms::DescriptionError& error) {
    CHECK_SAYS(error.what(), "/nowhere/arm.toml");
    CHECK_SAYS(error.what(), "Check the path");
  }
  CHECK_THROWS_AS(arms::read(arms_directory), arms::DescriptionError);
}

TEST_CASE("a text that is not TOML is refused with its line") {
  CHECK_SAYS(complaint("[arm]\nname = = 3\n"), "some.toml, line 2: this is not TOML");
  CHECK_SAYS(complaint(std::string("\x7f"
                                   "ELF\x01\x01",
                                   6)),
             "line 1: this is not TOML");
}

TEST_CASE("a missing section or key is named with its section") {
  CHECK_SAYS(complaint(""), "section [arm] is missing");
  CHECK_SAYS(complaint(omni_with("\n[motor]\n", "\n[engine]\n")), "no section or key engine");
  CHECK_SAYS(complaint(omni_with("link_3_m = 0.13335", "")), "link_3_m is missing in section [parameters]");
  CHECK_SAYS(complaint(omni_with("current_limit_2_A = 2.5", "")), "current_limit_2_A is missing");
  CHECK_SAYS(complaint(omni_with("name = \"PHANTOM Omni\"", "")), "name is missing in section [arm]");
  CHECK_SAYS(complaint(omni_with("inductance_H = 0.000238", "")), "inductance_H is missing in section [motor]");
  CHECK_SAYS(complaint(omni_with("probe_mass_kg = 0.015", "")), "probe_mass_kg is missing in section [simulation]");
}

TEST_CASE("the error for an unknown key contains the nearest known key, the line and the section") {
  const auto text = complaint(omni_with("link_2_m = ", "lnk_2_m = "));
  CHECK_SAYS(text, "[parameters] has no key lnk_2_m: did you mean link_2_m?");
  CHECK_SAYS(text, "line 21");
  CHECK_SAYS(complaint(omni_with("inductance_H", "inductanse_H")), "did you mean inductance_H?");
  CHECK_SAYS(complaint(omni_with("gear_ratio_1 = ", "zzz = ")), "omni.toml");
  CHECK_SAYS(complaint(omni_with("\n[motor]\n", "\n[motor]\nzzz = 1\n")), "known here: inductance_H");
  // An arm description cannot set wall parameters.
  CHECK_SAYS(complaint(omni_with("\n[parameters]\n", "\n[parameters]\nwall_stiffness_N_per_m = 3\n")), "has no key");
}

TEST_CASE("the error for a wrong unit names the key with the correct unit") {
  CHECK_SAYS(complaint(omni_with("link_2_m = 0.13335", "link_2_mm = 133.35")), "lengths are in metres: link_2_m.");
  CHECK_SAYS(complaint(omni_with("elbow_minimum_rad = ", "elbow_minimum_deg = ")),
             "angles are in radians: elbow_minimum_rad.");
  CHECK_SAYS(complaint(omni_with("current_limit_1_A", "current_limit_1_mA")),
             "currents are in amperes: current_limit_1_A.");
  CHECK_SAYS(complaint(omni_with("link_2_mass_kg", "link_2_mass_g")), "masses are in kilograms: link_2_mass_kg.");
  CHECK_SAYS(complaint(omni_with("inductance_H", "inductance_mH")), "inductances are in henries: inductance_H.");
  CHECK_SAYS(complaint(omni_with("rotor_inertia_kg_m2", "rotor_inertia_gcm2")),
             "kilogram square metres: rotor_inertia_kg_m2.");
  CHECK_SAYS(complaint(omni_with("link_2_m = ", "link_2 = ")), "lengths are in metres: link_2_m.");
}

TEST_CASE("a value out of range is refused with the range") {
  const auto text = complaint(omni_with("link_2_m = 0.13335", "link_2_m = 133.35"));
  CHECK_SAYS(text, "line 21: link_2_m = 133.35 is out of range; give a number from 0.02 to 1.");
  CHECK_SAYS(complaint(omni_with("inductance_H = 0.000238", "inductance_H = 0")), "inductance_H = 0 is out of range");
  CHECK_SAYS(complaint(omni_with("link_2_mass_kg = 0.055", "link_2_mass_kg = -1")),
             "link_2_mass_kg = -1 is out of range");
}

TEST_CASE("a value that is no finite or whole number is refused") {
  CHECK_SAYS(complaint(omni_with("link_2_m = 0.13335", "link_2_m = \"long\"")), "link_2_m must be a number");
  CHECK_SAYS(complaint(omni_with("link_2_m = 0.13335", "link_2_m = true")), "link_2_m must be a number");
  CHECK_SAYS(complaint(omni_with("link_2_m = 0.13335", "link_2_m = nan")), "link_2_m must be a finite number");
  CHECK_SAYS(complaint(omni_with("link_2_m = 0.13335", "link_2_m = inf")), "link_2_m must be a finite number");
  CHECK_SAYS(complaint(omni_with("counts_per_turn = 1440", "counts_per_turn = 1440.5")), "must be a whole number");
  CHECK_SAYS(complaint(omni_with("transmission = 1", "transmission = 0.5")),
             "transmission = 0.5 must be a whole number");
  CHECK_SAYS(complaint(omni_with("name = \"PHANTOM Omni\"", "name = 3")), "name must be a text in quotes");
  CHECK_SAYS(complaint("arm = 3\n"), "arm must be a section");
}

TEST_CASE("bounds in the wrong order are refused") {
  CHECK_SAYS(complaint(omni_with("joint_2_minimum_rad = 0.0", "joint_2_minimum_rad = 1.9")),
             "joint_2_minimum_rad must be below joint_2_maximum_rad");
}

TEST_CASE("texts of a description are safe to print") {
  CHECK(arms::parse(omni_with("name = \"PHANTOM Omni\"", "name = \"Omni\\u001B[2J\\n\""), "some.toml").name ==
        "Omni?[2J ");
  CHECK_SAYS(complaint(omni_with("inductance_H", "\"inductance\\u001B[2J\"")), "[motor] has no key inductance?[2J: ");
}
