#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/client/device/parameter_file.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;

TEST_CASE("parameters come back from a file exactly as they were") {
  auto parameters = protocol::default_parameters();
  parameters[Parameter::wall_stiffness_N_per_m] = 0.1f * 7777.0f;
  parameters[Parameter::box_minimum_x_m] = -0.0712345678f;
  const TemporaryDirectory directory;
  device::save_parameters(directory / "soft.toml", parameters);
  const auto loaded = device::load_parameters(directory / "soft.toml");
  CHECK(loaded.unknown.empty());
  REQUIRE(loaded.changes.size() == protocol::parameter_count);
  for (const auto& [parameter, value] : loaded.changes) CHECK(value == parameters[parameter]);
  CHECK(compare(loaded, parameters).empty());
}

TEST_CASE("differences between a file and a device are named") {
  const auto file =
      device::parse_parameters("[parameters]\nforce_limit_N = 1.5\nsphere_radius_m = 0.005\n", "soft.toml");
  const auto differences = compare(file, protocol::default_parameters());
  REQUIRE(differences.size() == 1);
  CHECK(differences[0].parameter == Parameter::force_limit_N);
  CHECK(differences[0].in_file == 1.5f);
  CHECK(differences[0].in_device == protocol::info(Parameter::force_limit_N).default_value);
}

TEST_CASE("a parameter file records its arm and its board") {
  const device::ParameterOrigin origin{"3932", "omni_driver"}, other{"0011", "bench_modules"};
  const TemporaryDirectory directory;
  device::save_parameters(directory / "soft.toml", protocol::default_parameters(), origin);
  const auto loaded = device::load_parameters(directory / "soft.toml");
  CHECK(loaded.origin == origin);
  CHECK(loaded.changes.size() == protocol::parameter_count);
  CHECK(device::origin_text(loaded.origin, origin) == "The file was saved from this arm.");
  CHECK(device::origin_text(loaded.origin, other) ==
        "The file was saved from the arm 3932 on the board omni_driver. This arm is 0011 on the board bench_modules.");
  CHECK(device::origin_text({}, origin) == "The file does not state the arm of its values.");
}

TEST_CASE("values that belong to one arm are compared separately") {
  const auto file = device::parse_parameters(
      "[parameters]\nforce_limit_N = 1.5\nbox_minimum_x_m = -0.01\nmotor_1_reversed = 1\nlink_2_m = 0.2\n"
      "gimbal_1_offset_rad = 0.5\n",
      "other.toml");
  std::vector<Parameter> differing;
  for (const auto& difference : compare_arm(file, protocol::default_parameters()))
    differing.push_back(difference.parameter);
  CHECK(differing == std::vector{Parameter::link_2_m, Parameter::motor_1_reversed, Parameter::gimbal_1_offset_rad});
}

TEST_CASE("unknown parameter names are returned and not refused") {
  const auto file =
      device::parse_parameters("[parameters]\nforce_limit_N = 2\nmagic_N = 1\n[motor]\nx = 1\n", "new.toml");
  CHECK(file.changes.size() == 1);
  REQUIRE(file.unknown.size() == 1);
  CHECK(file.unknown[0] == "magic_N");
}

TEST_CASE("terminal control characters in unknown names and error messages become question marks") {
  const auto file = device::parse_parameters("[parameters]\n\"wobble\\u001B[2J\" = 3\n", "a.toml");
  CHECK(file.unknown == std::vector<std::string>{"wobble?[2J"});
  CHECK(std::string(device::Error("one\n\ttwo\x1B[2J\x07").what()) == "one\n\ttwo?[2J?");
}

TEST_CASE("a bad file is refused with its line and the remedy") {
  const auto refusal = [](const char* text) {
    return message_of<device::Error>([&] { device::parse_parameters(text, "bad.toml"); });
  };
  const auto not_toml = refusal("[parameters]\nforce_limit_N = = 2\n");
  CHECK(contains(not_toml, "bad.toml, line 2"));
  const auto too_large = refusal("[parameters]\n\nforce_limit_N = 80.0\n");
  CHECK(contains(too_large, "line 3"));
  CHECK(contains(too_large, "0.0 to 8.0 N"));
  CHECK(contains(refusal("[parameters]\nforce_limit_N = \"soft\"\n"), "not a number"));
  CHECK(contains(refusal("[parameters]\nforce_limit_N = nan\n"), "force_limit_N"));
  CHECK(contains(refusal("[parameters]\ntransmission = 0.5\n"), "whole number"));
  CHECK(contains(refusal("force_limit_N = 2\n"), "[parameters]"));
  CHECK(contains(message_of<device::Error>([] { device::load_parameters("/nowhere/at/all.toml"); }),
                 "/nowhere/at/all.toml"));
}

TEST_CASE("a file that cannot be written leaves the old one alone") {
  CHECK(contains(message_of<device::Error>(
                     [] { device::save_parameters("/nowhere/at/all.toml", protocol::default_parameters()); }),
                 "cannot be written"));
}

TEST_CASE("a folder or a full disk in place of a parameter file is an error") {
  const TemporaryDirectory directory;
  const auto save = [&](const char* name) {
    return message_of<device::Error>(
        [&] { device::save_parameters(directory / name, protocol::default_parameters()); });
  };
  std::filesystem::create_symlink("/dev/full", directory / "soft.toml");
  CHECK(contains(save("soft.toml"), "cannot be written"));
  std::filesystem::create_directory(directory / "folder");
  CHECK(contains(save("folder"), "cannot be written"));
}

TEST_CASE("a parameter file of a Windows editor is read") {
  const auto file = device::parse_parameters("\xEF\xBB\xBF[parameters]\r\nforce_limit_N = 2\r\n\r\n\r\n", "soft.TOML");
  REQUIRE(file.changes.size() == 1);
  CHECK(file.changes[0].second == 2.0f);
}

TEST_CASE("a named pipe is refused as a parameter file without waiting") {
  const TemporaryDirectory directory;
  REQUIRE(mkfifo(directory.file("pipe").c_str(), 0600) == 0);
  const int held_open = open(directory.file("pipe").c_str(), O_RDWR | O_CLOEXEC);
  CHECK(contains(message_of<device::Error>([&] { device::load_parameters(directory / "pipe"); }), "cannot be read"));
  close(held_open);
}

TEST_CASE("changes come in the table's order, in whichever order a file has them") {
  const auto file = device::parse_parameters(
      "[parameters]\nwall_stiffness_N_per_m = 500\nbox_minimum_x_m = 0.0\n"
      "force_limit_N = 2\nencoder_1_counts_per_turn = 1440\n",
      "mixed.toml");
  REQUIRE(file.changes.size() == 4);
  CHECK(std::is_sorted(file.changes.begin(), file.changes.end()));
}

TEST_CASE("a mistyped parameter name produces the nearest name as a suggestion, unless no name is similar") {
  const std::string stiffness = " Did you mean wall_stiffness_N_per_m?";
  CHECK(device::parameter_suggestion("wall_stifness_N_per_m") == stiffness);
  CHECK(device::parameter_suggestion("stiffness") == stiffness);  // not "frame"
  CHECK(device::parameter_suggestion("wall_stifness") == stiffness);
  CHECK(device::parameter_suggestion("box_minimum_x") == " Did you mean box_minimum_x_m?");
  for (const char* const like_none : {"nope", "x", "", "an altogether different thing"})
    CHECK(device::parameter_suggestion(like_none) == "");
  CHECK(contains(message_of<device::Error>([] { device::parameter_named("force_limit"); }), "force_limit_N"));
  CHECK(message_of<device::Error>([] { device::parameter_named("nope"); }) ==
        "There is no parameter nope. `inkwell parameters` lists them all.");
}

TEST_CASE("parse_change reads NAME=VALUE, and its errors contain the correct form") {
  const auto [parameter, value] = device::parse_change("wall_damping_Ns_per_m=2.5");
  CHECK(parameter == Parameter::wall_damping_Ns_per_m);
  CHECK(value == 2.5f);
  const auto refusal = [](const char* text) { return message_of<device::Error>([&] { device::parse_change(text); }); };
  CHECK(contains(refusal("wall_damping_Ns_per_m"), "NAME=VALUE"));
  CHECK(contains(refusal("wall_damping_Ns_per_m="), "not a number"));
  CHECK(contains(refusal("wall_damping_Ns_per_m=2,5"), "without commas"));
  CHECK_FALSE(contains(refusal("wall_damping_Ns_per_m=2.5x"), "commas"));
  CHECK(contains(refusal("wall_damping_Ns_per_m=20.5"), "0.0 to 20.0 Ns/m"));
  CHECK(contains(refusal("wall_damping_Ns_per_m=-0.5"), "0.0 to 20.0 Ns/m"));
  CHECK(contains(refusal("wall_damping_Ns_per_m=inf"), "range"));
  CHECK(contains(refusal("encoder_1_counts_per_turn=1440.5"), "whole number"));
}

TEST_CASE("values are written in their shortest exact form") {
  CHECK(device::format_value(Parameter::force_limit_N, 3.3f) == "3.3");
  CHECK(device::format_value(Parameter::force_limit_N, 3.0f) == "3.0");
  CHECK(device::format_value(Parameter::encoder_1_counts_per_turn, 1440.0f) == "1440");
  CHECK(device::format_value(Parameter::encoder_1_counts_per_turn, 1000000.0f) == "1000000");
}
