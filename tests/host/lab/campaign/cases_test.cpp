// Tests the list of campaign cases and the files with their results.
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/result.hpp"
#include "host/lab/campaign/run.hpp"
#include "host/lab/campaign/wires.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <doctest/doctest.h>
#include "tests/temporary_directory.hpp"

#include "boards/known/boards.hpp"
#include "host/client/device/error.hpp"
#include "protocol/supervision.hpp"

#include "tests/host/lab/campaign/seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("the campaign lists every fault in every situation, as often as required, with consecutive numbers") {
  const auto cases = all_cases();
  std::set<std::string> names;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CHECK(cases[i].number == i + 1);
    CHECK(names.insert(cases[i].name()).second);
  }
  const auto of_three = std::ranges::count_if(case_faults(), is_of_three);
  CHECK(of_three > 40);
  CHECK(cases.size() == (case_faults().size() * 3 + static_cast<std::size_t>(of_three) * 2) * 12);
  CHECK(cases[0].fault.is_fault_free());
  CHECK(case_faults().back().deed == Deed::models_contradictory);
  for (const auto& row : protocol::injection_table) {
    CAPTURE(row.name);
    for (const CaseSituation situation : situations)
      CHECK(std::ranges::count_if(cases, [&](const Case& c) {
              return c.fault.fault && protocol::info(*c.fault.fault).name == row.name && c.situation == situation;
            }) >= phases);
  }
  // Case names contain the wire names of the board facts. Wires to the host or to the debug probe have no cases.
  CHECK(names.contains("wire_open:encoders[1].a wall 2"));
  CHECK(names.contains("wire_high:bridge_enable rest 1"));
  // The second of three equal components is tested at each instant. The first and the third component are tested at one
  // random instant per situation.
  for (const char* others : {"wire_open:encoders[0].a wall 3", "wire_open:encoders[2].a starting 2",
                             "motor_hot:1 rest 3", "leg_high:3B limited 2", "encoder_slip:3=400 motion 2"})
    CHECK(names.contains(others));
  CHECK_FALSE(names.contains("wire_open:encoders[0].a wall 1"));
  CHECK_FALSE(names.contains("wire_open:encoders[2].a wall 1"));
  CHECK_FALSE(names.contains("wire_open:usb_plus wall 1"));
  CHECK(names.contains("supply_spike+0.005 motion 3"));
  CHECK(names.contains("none wall 3"));
  CHECK(names.contains("none starting 3"));
  CHECK_FALSE(names.contains("none starting 4"));
  CHECK(names.contains("bus_suspended limited 2"));
  CHECK(names.contains("fast_hand rest 3"));
  CHECK(names.contains("models_stale wall 2"));
  // Some faults have cases with the default amount and with a second amount.
  for (const char* amount : {"shunt_gain:2", "shunt_gain:2=2", "logic_sag", "logic_sag=2.86", "analog_sag",
                             "analog_sag=3.5", "main_loop_stalled", "main_loop_stalled=0.012"})
    CHECK(names.contains(std::string(amount) + " rest 1"));
  // 14 is PendSV, and 17 and 34 are positions 1 and 18 of RM0090's vector table.
  for (const char* exception : {"14", "17", "34"})
    CHECK(names.contains("exception_lost:" + std::string(exception) + " rest 1"));
}

TEST_CASE("every state of the board is tried") {
  for (const protocol::StateInfo& state : protocol::state_table) {
    CAPTURE(state.name);
    // The active state consists of the situations `rest`, `wall` and `motion`.
    CHECK((state.name == "active" ||
           std::ranges::any_of(situations, [&](CaseSituation situation) { return name_of(situation) == state.name; })));
  }
}

TEST_CASE("a case runs on a board with the brown-out level of one that was flashed") {
  const TemporaryDirectory directory;
  const auto program = directory / "board";
  std::ofstream(program) << "#!/bin/sh\necho \"$@\" > '" << directory.path() << "/arguments'\nexit 1\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  CHECK_FALSE(run_case(all_cases()[0], {.program = program, .elf = program}).error.empty());
  CHECK(content_of(directory / "arguments").find(" --brown-out 3 ") != std::string::npos);
}

TEST_CASE("a result comes back from its file as it was, and a damaged file is named") {
  const TemporaryDirectory directory;
  Result result = seen("bridge_fault", "wall", 2);
  result.off_after_s = 43e-6;
  result.detected_as = protocol::Fault::bridge_fault;
  result.peak_force_N = 2.5;
  result.position_error_m = 1e-5;
  result.peak_force_in_use_N = 2.75;
  result.energy_in_use_J = 0.125;
  result.told_before = protocol::Fault::host_silent;
  result.first_fault = FirstFault::black_box;
  result.told_once_cleared = protocol::Fault::bridge_fault;
  result.missed_boot_loader = true;
  save(result, directory.path());
  Result other = seen("none", "rest", 1);
  other.error = "The board did not \"start\".";
  save(other, directory.path());
  const auto loaded = load_all(directory.path());
  REQUIRE(loaded.size() == 2);
  CHECK(loaded[0] == other);
  CHECK(loaded[1] == result);
  CHECK(std::distance(std::filesystem::directory_iterator(directory.path()), {}) == 2);  // no temporary file remains

  std::ofstream(directory / "case-00001.4711.part.json") << "{";  // of a process that still writes
  std::ofstream(directory / "copy.JSON") << "\xEF\xBB\xBF" << text_of(result) << "\r\n\r\n";
  CHECK(load_all(directory.path()).size() == 3);

  std::ofstream(file_of(directory.path(), 9)) << "{\"number\": 9}";
  CHECK_THROWS_WITH_AS(load_all(directory.path()), doctest::Contains("case-00009.json: This file is not a result"),
                       device::Error);
  CHECK_THROWS_WITH_AS(parse_result("{\"number\": "),
                       doctest::Contains("of this version: parse error at line 1, column 12"), device::Error);
  CHECK_THROWS_WITH_AS(parse_result("{}"), doctest::Contains("of this version: key 'number' not found. Remove it"),
                       device::Error);
  Result of_another_list = result;
  of_another_list.fault = *find_fault("exception_lost:14");
  std::ofstream(file_of(directory.path(), 9)) << text_of(of_another_list);
  CHECK_THROWS_WITH_AS(
      load_all(directory.path()),
      doctest::Contains(
          "case-00009.json: This file is the result of `exception_lost:14 wall 2`, which is not the case"),
      device::Error);
  of_another_list = result;
  of_another_list.number = static_cast<unsigned>(all_cases().size()) + 1;
  std::ofstream(file_of(directory.path(), 9)) << text_of(of_another_list);
  CHECK_THROWS_WITH_AS(load_all(directory.path()), doctest::Contains("not the case with this number"), device::Error);
  CHECK_THROWS_AS(load_all(directory / "nowhere"), device::Error);
  CHECK_THROWS_AS(save(result, directory / "nowhere"), device::Error);
}

TEST_CASE("at_another moves a fault of one of three parts to another part, and leaves other faults unchanged") {
  const auto listed = case_faults();
  const auto moved = [&](const std::string& name, unsigned motor) {
    const auto found = std::ranges::find_if(listed, [&](const CaseFault& fault) { return fault.name() == name; });
    REQUIRE(found != listed.end());
    return at_another(*found, motor).name();
  };
  CHECK(moved("motor_open:2", 1) == "motor_open:1");
  CHECK(moved("leg_high:2A", 3) == "leg_high:3A");
  CHECK(moved("encoder_slip:2=400", 1) == "encoder_slip:1=400");
  CHECK(moved("wire_open:encoders[1].a", 1) == "wire_open:encoders[0].a");
  CHECK(moved("wires_shorted:bridges[1].leg_a+bridges[1].leg_b", 3) ==
        "wires_shorted:bridges[2].leg_a+bridges[2].leg_b");
  CHECK(moved("wire_low:gimbal[1]", 1) == "wire_low:gimbal[0]");
  CHECK(moved("wires_shorted:motor_current[1]+motor_current[2]", 3) ==
        "wires_shorted:motor_current[2]+motor_current[0]");
  for (const char* of_none :
       {"none", "bus_suspended", "fast_hand", "models_lost", "supply_cut", "wire_high:bridge_enable", "ram_bit"})
    CHECK(moved(of_none, 3) == of_none);
  for (const CaseFault& fault : listed)
    for (const unsigned motor : {1, 2, 3}) CHECK(listed_fault(at_another(fault, motor)) == fault);
  std::set<std::string> wires;
  for (const auto& use : board::default_board.pin_uses()) wires.emplace(use.name);
  for (const CaseFault& fault : listed) {
    CHECK(at_another(fault, 2).name() == fault.name());
    if (!fault.fault || protocol::info(*fault.fault).location != protocol::InjectionLocation::wire) continue;
    for (const unsigned motor : {1, 3}) CHECK_MESSAGE(wires.contains(at_another(fault, motor).of), fault.name());
  }
}

TEST_CASE("a result whose counts are no counts is refused with their name") {
  const std::string text = text_of({.number = 7, .phase = 2, .restarts = 1});
  CHECK(parse_result(text).number == 7);
  for (const auto& [fault_free, damaged] : {std::pair{"\"number\": 7", "\"number\": 5e29"},
                                            {"\"number\": 7", "\"number\": 4294967296"},
                                            {"\"phase\": 2", "\"phase\": -2"},
                                            {"\"restarts\": 1", "\"restarts\": 1.5"},
                                            {"\"restarts\": 1", "\"restarts\": \"\\u00ff\""}}) {
    CAPTURE(damaged);
    const std::string name = std::string(fault_free).substr(1, std::string(fault_free).find('"', 1) - 1);
    std::string wrong = text;
    wrong.replace(wrong.find(fault_free), std::string(fault_free).size(), damaged);
    CHECK_THROWS_WITH_AS(parse_result(wrong), doctest::Contains((name + " is ").c_str()), device::Error);
  }
}

TEST_CASE("a result of an earlier version, whose location has the key `place`, is read") {
  const std::string text = text_of({.number = 7, .location = "0x20000010"});
  std::string earlier = text;
  const std::string key = "\"location\"";
  earlier.replace(earlier.find(key), key.size(), "\"place\"");
  CHECK(parse_result(earlier) == parse_result(text));
}

TEST_CASE("a file contains names, and names that this version does not know are refused") {
  Result result = seen("motor_open:1", "wall", 3);
  result.detected_as = protocol::Fault::current_jump;
  result.noticed_in_use_as = {NoticedInUse::By::restart};
  result.recovery = Recovery::force_on_again;
  const std::string text = text_of(result);
  for (const char* member :
       {"\"fault\": \"motor_open:1\"", "\"situation\": \"wall\"", "\"detected_as\": \"current_jump\"",
        "\"fault_on_healing\": \"\"", "\"noticed_in_use_as\": \"restart\"", "\"recovery\": \"force on again\""}) {
    CAPTURE(member);
    CHECK(text.find(member) != std::string::npos);
  }
  CHECK(parse_result(text) == result);
  for (const auto& [known, unknown, complaint] :
       {std::tuple{"motor_open:1", "motor_open\\u001B[2J:1",
                   "the fault `motor_open?[2J:1`, which this version does not"},
        {"\"wall\"", "\"floor\"", "the situation `floor`, which this version does not"},
        {"\"current_jump\"", "\"current_leap\"", "the firmware has no fault `current_leap`"},
        {"\"restart\"", "\"nap\"", "the firmware has no fault `nap`"},
        {"\"force on again\"", "\"coffee\"", "there is no recovery `coffee`"}}) {
    std::string wrong = text;
    wrong.replace(wrong.find(known), std::string(known).size(), unknown);
    CHECK_THROWS_WITH_AS(parse_result(wrong), doctest::Contains(complaint), device::Error);
  }
  for (const auto recovery : {Recovery::unknown, Recovery::none_needed, Recovery::clear_fault, Recovery::board_reset,
                              Recovery::not_recovered}) {
    result.recovery = recovery;
    CHECK(parse_result(text_of(result)) == result);
  }
  for (const auto& noticed : {NoticedInUse{}, NoticedInUse{NoticedInUse::By::force_off},
                              NoticedInUse{NoticedInUse::By::fault, protocol::Fault::encoder_wire}}) {
    result.noticed_in_use_as = noticed;
    CHECK(parse_result(text_of(result)) == result);
  }
}

TEST_CASE("each wire of a case has a function, and wires of host, console and debug probe have none") {
  for (const auto& use : board::default_board.pin_uses()) {
    const std::string name(use.name);
    CAPTURE(name);
    const bool is_other = name.starts_with("usb_minus") || name.starts_with("usb_plus") ||
                          name.starts_with("console_") || name.starts_with("debug_") || name == "status_led";
    CHECK((wire_of(name) == Wire::other) == is_other);
  }
  CHECK(wire_of("bridges[1].leg_a+bridges[1].leg_b") == Wire::bridge_leg);
  CHECK(wire_of("bridge_fault_tim8") == Wire::bridge_fault_tim8);
  CHECK(wire_of("2") == Wire::other);
}
