// Undetected faults are listed on the page, each with its reason.
#include <campaign/cases.hpp>
#include <campaign/handling.hpp>
#include <campaign/page.hpp>
#include <campaign/result.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <temporary_directory.hpp>

#include <device/error.hpp>
#include <experiment/wall.hpp>
#include <protocol/supervision.hpp>

#include "seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("a restart is noticed, a lock-up or bridges that went off are not by themselves") {
  const TemporaryDirectory directory;
  Result restarted = seen("logic_sag", "rest", 1), stuck = seen("logic_sag", "rest", 2),
         quiet = seen("logic_sag", "rest", 3);
  restarted.restarts = 2;
  stuck.locked_up = true;
  quiet.off_after_s = 1e-3;
  const std::array all{restarted, stuck, quiet};
  CHECK(summarise(all).detected == 1);
  write_page(all, directory / "campaign.md");
  const std::string text = content_of(directory / "campaign.md");
  CHECK(text.find("| `logic_sag` | locked up; restart (1 of 3) |") != std::string::npos);
  CHECK(text.find("| `logic_sag` | rest (1 of 3) | not used |") != std::string::npos);  // locked up with the bridges on
  CHECK(text.find("| `logic_sag` | rest (1 of 3) | - | The chip stands") != std::string::npos);  // bridges off
}

TEST_CASE("a bridge that went on though it was off stands on the page before all else, and only then") {
  const TemporaryDirectory directory;
  Result off = seen("bridge_fault", "ready", 1), on = seen("wire_high:bridge_enable", "ready", 2);
  const auto page = directory / "campaign.md";
  write_page(std::array{off, on}, page);
  CHECK(content_of(page).find("## Went on by itself") == std::string::npos);
  on.bridges_went_on = true;
  on.peak_force_N = 1.25;
  write_page(std::array{off, on}, page);
  const std::string text = content_of(page);
  const auto section = text.find("## Went on by itself");
  REQUIRE(section != std::string::npos);
  CHECK(section < text.find("## Above the force limit"));
  CHECK(text.find("| " + std::to_string(on.number) + " | `wire_high:bridge_enable` ready 2 | 1.25 | 0.0 | 0.0 | - |") !=
        std::string::npos);
  CHECK(text.find("`bridge_fault` ready 1") == std::string::npos);
}

TEST_CASE(
    "in use the hand presses in turn into the wall in front and to the side, swings to either side and ends in the "
    "middle, without a jump") {
  const auto parameters = protocol::default_parameters();
  const auto middle_m = middle_of_box_m(parameters), pressed_m = beyond_forward_wall_m(parameters, 1.0);
  const auto wall = experiment::side_wall(parameters);
  CHECK(wall.axis != experiment::forward_wall(parameters).axis);
  const auto aside_m =
      into_wall_m(parameters, wall, static_cast<double>(parameters[protocol::Parameter::force_limit_N]));
  std::string presses;
  int swings_there = 0;
  double last_s = 0;
  device::Vector3 last_m = middle_m;
  const auto path = pressing_and_swinging(parameters);
  for (const auto& [after_s, target_m] : path) {
    CHECK(after_s > last_s);
    if (target_m != last_m && target_m == pressed_m) presses += 'f';
    if (target_m != last_m && target_m == aside_m) presses += 's';
    swings_there += std::abs(target_m[1] - middle_m[1]) > 0.01 && std::abs(target_m[0] - middle_m[0]) > 0.01;
    last_s = after_s;
    last_m = target_m;
  }
  CHECK(presses == "fsfs");
  CHECK(swings_there == 4);
  CHECK(last_m == middle_m);
}

TEST_CASE("what was not noticed is told with what became of it in use, and with what a sound arm showed there") {
  const TemporaryDirectory directory;
  Result stuck = seen("encoder_stuck:2", "rest", 1), stuck_later = seen("encoder_stuck:2", "wall", 2),
         hot = seen("motor_hot:2", "rest", 1), fault_free = seen("none", "rest", 1);
  for (Result* result : {&stuck, &stuck_later, &hot, &fault_free}) result->peak_force_in_use_N = 3.25;
  stuck.noticed_in_use_as = "encoder_implausible";
  stuck.noticed_in_use_s = 0.9;
  stuck_later.peak_force_in_use_N = 3.4;
  stuck_later.noticed_in_use_as = "motor_implausible";
  stuck_later.noticed_in_use_s = 1.75;
  // Only one of the two situations has a fault-free case at the same instant for comparison.
  fault_free.energy_in_use_J = 0.04;
  hot.energy_in_use_J = 0.039;
  stuck.energy_in_use_J = 0.0425;
  stuck_later.energy_in_use_J = 0.09;
  const auto text_with = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    return content_of(directory / "campaign.md");
  };
  const std::string text = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(text.find(
            "for 0.6 s as before, then it pressed with the force limit 2 times in turn into the wall in front and the "
            "one to the side, and swung 4 times.") != std::string::npos);
  CHECK(text.find("Without a fault it felt 3.25 N at most, and a fault was told in 0 of 1 cases.") !=
        std::string::npos);
  CHECK(text.find("none needed of the encoder_implausible in use") != std::string::npos);
  CHECK(text.find("| `encoder_stuck:2` | rest, wall | encoder_implausible; motor_implausible, 1.75 s | 3.40 | - | ") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | rest | - | 3.25 | no more | ") != std::string::npos);
  stuck.noticed_in_use_s = std::nullopt;
  fault_free.noticed_in_use_s = 0.1;
  const std::string other = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(other.find("| rest, wall | motor_implausible (1 of 2), 1.75 s | 3.40 | - | ") != std::string::npos);
  CHECK(other.find("a fault was told in 1 of 1 cases.") != std::string::npos);
  fault_free.noticed_in_use_s = std::nullopt;
  CHECK(text_with({stuck, stuck_later, hot, fault_free}).find("(1 of 2), 1.75 s | 3.40 | 2.5 | ") != std::string::npos);
  stuck.peak_force_in_use_N = std::nullopt;
  hot.peak_force_in_use_N = 3.6;
  const std::string third = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(third.find("| rest, wall | motor_implausible, 1.75 s; 1 not used | ") != std::string::npos);
  CHECK(third.find("| `motor_hot:2` | rest, used on | 3.6 | - | - | - | - |") != std::string::npos);
}

TEST_CASE("bridges that went off while nothing was told are listed with what was told later, and only they") {
  const TemporaryDirectory directory;
  const auto section_of = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    const std::string text = content_of(directory / "campaign.md");
    const auto begin = text.find("## Off, but not told");
    return text.substr(begin, text.find("\n## ", begin) - begin);
  };
  Result halted = seen("core_halted", "wall", 1), halted_at_rest = seen("core_halted", "rest", 2),
         without_report = seen("core_halted", "rest", 3), off_before = seen("core_halted", "ready", 1),
         stayed = seen("core_halted", "motion", 1), failed = seen("core_halted", "motion", 2);
  for (Result* result : {&halted, &halted_at_rest, &without_report, &failed}) result->off_after_s = 1e-6;
  halted.fault_on_healing = "heartbeat_missed";
  without_report.detected_as = "watchdog";
  without_report.fault_on_healing = "over_speed";
  failed.error = "The board did not start.";
  const std::string row =
      "| `core_halted` | rest (1 of 2), wall | heartbeat_missed | A core that stands tells nothing;";
  const std::string section = section_of({halted, halted_at_rest, without_report, off_before, stayed, failed});
  CHECK(section.find(row) != std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  CHECK(section_of({halted_at_rest}).find("| `core_halted` | rest | - | ") != std::string::npos);
  CHECK(section_of({without_report, off_before, stayed, failed}).ends_with("but no fault was told: none.\n"));
}

TEST_CASE("situations with one instant stand beside those with three, and the self-test's pulses are no force") {
  const TemporaryDirectory directory;
  std::vector<Result> results;
  for (const char* situation : {"wall", "ramping", "limited", "landing", "testing"}) {
    results.push_back(seen("none", situation, 1));
    results.push_back(seen("motor_hot:2", situation, 1));
  }
  for (Result& result : results) {
    const bool is_test = result.situation == "testing";
    result.bridges_were_on = true;
    result.peak_force_N = is_test ? 9.0 : 2.0;
    result.energy_J = is_test ? 0.5 : 0.001;
    if (is_test) result.off_after_s = 0.01;
  }
  write_page(results, directory / "campaign.md");
  const std::string text = content_of(directory / "campaign.md");
  for (const char* heading : {"wall", "ramping", "limited", "landing", "testing"})
    CHECK(text.find("\n## " + std::string(heading) + "\n\n") != std::string::npos);
  CHECK(text.find("felt at most 2.00 N in that time") != std::string::npos);
  CHECK(text.find("a twentieth of it: none.") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | wall, ramping, limited, landing | not used |") != std::string::npos);
  CHECK(text.find("bridges went off, but no fault was told: none.") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | testing | A motor that is 100 K") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | 200 | 9.00 | 500.0 |") != std::string::npos);
  const std::string force = content_of(directory / "campaign-force.svg");
  CHECK(force.find("wall 2.0 N, ramping 2.0 N, limited 2.0 N, landing 2.0 N<") != std::string::npos);
  CHECK(content_of(directory / "campaign-off.svg").find("not noticed: 0 of 4 are wires") != std::string::npos);
}

TEST_CASE("what was not noticed without force is listed as well, in a table of its own") {
  const TemporaryDirectory directory;
  const auto section_of = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    const std::string text = content_of(directory / "campaign.md");
    const auto begin = text.find("## Not noticed without force");
    return text.substr(begin, text.find("\n## ", begin) - begin);
  };
  Result lost = seen("encoder_slip:2=400", "unreferenced", 1), jumped = seen("encoder_slip:2=400", "ready", 1),
         pressed = seen("encoder_slip:2=400", "wall", 1), fault_free = seen("none", "ready", 1);
  jumped.detected_as = "encoder_implausible";
  const std::string section = section_of({lost, jumped, pressed, fault_free});
  CHECK(section.find("| `encoder_slip:2=400` | unreferenced | Before there is a reference it does") !=
        std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  // Faults with the same reason and the same situations share a row.
  const std::string shared = section_of({seen("wire_open:button_1", "ready", 1), seen("wire_open:supply", "ready", 1),
                                         seen("wire_open:button_2", "ready", 1), seen("wire_low:button_2", "rest", 1),
                                         seen("wire_high:button_2", "testing", 1)});
  CHECK(shared.find("| `wire_open:button_1`, `wire_open:button_2` | ready | An open or closed wire") !=
        std::string::npos);
  CHECK(shared.find("| `wire_open:supply` | ready | ") != std::string::npos);
  CHECK(shared.find("| `wire_high:button_2` | testing | An open or closed wire") != std::string::npos);
  CHECK(section_of({jumped, pressed, fault_free}).ends_with("in which no fault was told: none.\n"));
}

TEST_CASE("where of three not each passes unnoticed, the page tells which") {
  const TemporaryDirectory directory;
  std::vector<Result> results{seen("motor_open:2", "wall", 1),    seen("motor_open:1", "wall", 3),
                              seen("motor_open:3", "wall", 2),    seen("encoder_stuck:2", "wall", 1),
                              seen("encoder_stuck:1", "wall", 3), seen("encoder_stuck:3", "wall", 2)};
  for (const auto& [fault, phase] :
       {std::pair{"leg_slow:2A", 1u}, {"leg_slow:2A", 2u}, {"leg_slow:1A", 3u}, {"leg_slow:3A", 2u}})
    results.push_back(seen(fault, "wall", phase));
  results[6].detected_as = "motor_implausible";
  results[0].detected_as = results[3].detected_as = results[4].detected_as = "motor_implausible";
  write_page(results, directory / "campaign.md");
  const std::string text = content_of(directory / "campaign.md");
  CHECK(text.find("| `motor_open:2` | wall (2 of 3, at 1 and 3) | not used |") != std::string::npos);
  CHECK(text.find("| `encoder_stuck:2` | wall (1 of 3, at 3) | not used |") != std::string::npos);
  CHECK(text.find("| `leg_slow:2A` | wall (3 of 4) | not used |") != std::string::npos);
}

TEST_CASE(
    "an interrupt that is lost or late has the reason of what it is for, a motor in the self-test that of its pulses") {
  const TemporaryDirectory directory;
  const auto row_of = [&](const std::string& fault, const std::string& situation) {
    write_page(std::array{seen(fault, situation, 1)}, directory / "campaign.md");
    std::istringstream lines(content_of(directory / "campaign.md"));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("| `" + fault + "` | " + situation + " | ")) return line;
    return std::string();
  };
  for (const char* exception : {"exception_lost:14", "exception_late:14"})
    CHECK(row_of(exception, "rest").find("only if the main loop hangs") != std::string::npos);
  for (const char* exception : {"exception_lost:17", "exception_late:17"})
    CHECK(row_of(exception, "rest").find("the brown-out reset follows") != std::string::npos);
  CHECK(row_of("exception_lost:34", "rest").find("None is known") != std::string::npos);
  CHECK(row_of("exception_late:34", "rest").find("late by less") != std::string::npos);
  for (const char* fault : {"leg_slow:2A", "motor_open:2", "shunt_frozen:2", "wire_open:motor_current[1]",
                            "wires_shorted:bridges[1].leg_a+bridges[1].leg_b"}) {
    CAPTURE(fault);
    for (const char* situation : {"testing", "starting"})
      CHECK(row_of(fault, situation).find("this motor's pulses were over") != std::string::npos);
    CHECK(row_of(fault, "ready").size() > 40);
    CHECK(row_of(fault, "ready").find("pulses were over") == std::string::npos);
  }
  CHECK(row_of("motor_hot:2", "testing").find("passes the self-test") != std::string::npos);
  CHECK(row_of("encoder_stuck:2", "testing").find("The hand holds the joint still") != std::string::npos);
}

TEST_CASE("each fault that passes without a word has a reason on the page, in each of its three tables") {
  const TemporaryDirectory directory;
  struct Table {
    const char* situation;
    std::optional<double> off_after_s;
    std::string before_reason;
  };
  std::string text;
  for (const Table& table :
       {Table{"ready", {}, "ready | "}, {"rest", 1e-6, "rest | - | "}, {"rest", {}, "rest | not used | - | "}}) {
    std::vector<Result> results;
    for (const CaseFault& fault : case_faults())
      if (fault.fault) {
        results.push_back(seen(fault.name(), table.situation, 1));
        results.back().off_after_s = table.off_after_s;
      }
    write_page(results, directory / "campaign.md");
    text = content_of(directory / "campaign.md");
    for (const Result& result : results) {
      CAPTURE(result.fault);
      CAPTURE(table.before_reason);
      // The fault has a separate row or shares a row with faults of the same reason.
      std::string reason;
      std::istringstream lines(text);
      for (std::string line; reason.empty() && std::getline(lines, line);) {
        const auto at = line.find("` | " + table.before_reason);
        if (line.starts_with("| `") && line.find("`" + result.fault + "`") <= at && at != std::string::npos)
          reason = line.substr(at + 4 + table.before_reason.size());
      }
      REQUIRE(reason.ends_with(" |"));
      reason.resize(reason.size() - 2);
      CHECK(reason.size() > 20);
      CHECK(reason.ends_with("."));
      // A reason that is valid only with the bridges off is not valid while the force is on.
      if (result.situation == "rest")
        CHECK(reason.find("as it has to be while the bridges are off") == std::string::npos);
    }
  }
  CHECK(text.find("`shunt_frozen:2` | rest | not used | - | - | Voltage, reading and speed fit") != std::string::npos);
  CHECK(text.find("`program_astray` | rest | not used | - | - | The code that it came to returned") !=
        std::string::npos);
}

TEST_CASE("what a fault does without force, or silently, has reasons of its own") {
  const TemporaryDirectory directory;
  struct Row {
    const char *fault, *situation, *reason;
  };
  for (const Row& row :
       {Row{"wire_low:inkwell_switch", "unreferenced", "Before there is a reference it looks like"},
        {"wire_open:inkwell_switch", "unreferenced", "An open or closed wire"},
        {"wire_low:bridge_fault_tim8", "ready", "Only the break input of TIM8 reads this pin"},
        {"wire_open:bridge_fault_tim8", "ready", "The level is that of healthy bridges."},
        {"wire_spikes:bridge_fault_tim8", "ready", "Only the break input"},
        {"wire_spikes:inkwell_switch", "ready", "The input filters"},
        {"wire_open:bridges[1].leg_a", "ready", "The leg is low, as it has to be"},
        {"wire_frozen:bridge_enable", "ready", "The level of the chip's pin is correct."},
        {"wire_open:bridge_heartbeat", "ready", "The level is low, as it has to be"},
        {"wire_frozen:motor_current[1]", "ready", "No current flows"},
        {"wire_open:encoders[1].a", "ready", "The hand holds the joint still"},
        {"wire_open:usb_supply", "ready", "A lost USB connection is reported only while"},
        {"wire_low:usb_supply", "landing", "The force was switched off already"},
        {"wire_high:usb_supply", "ready", "The level is that of a plugged-in cable."},
        {"wire_low:bridge_hold", "ready", "The level is low, as it has to be"},
        {"wire_high:bridge_hold", "wall", "The level is that of the bridges switched on."},
        {"wire_low:bridge_heartbeat", "rest", "None is known"},
        {"wire_open:supply", "rest", "None is known"},
        {"crystal_drift", "ready", "A lost USB connection is reported only while"},
        {"crystal_drift", "landing", "The force was switched off already"},
        {"usb_cut", "ready", "A lost USB connection is reported only while"},
        {"usb_cut", "landing", "The force was switched off already"},
        {"usb_cut", "rest", "None is known: every cause that switches the bridges off is reported."},
        {"bus_suspended", "ready", "A lost USB connection is reported only while"},
        {"bus_suspended", "landing", "The force was switched off already"},
        {"bus_suspended", "rest", "None is known: every cause that switches the bridges off is reported."},
        {"host_silent", "ready", "A silent host is detected only while the force is on."},
        {"host_silent", "rest", "No host requests a report"},
        {"core_halted", "ready", "A core that stands tells nothing; it goes on"},
        {"wires_shorted:encoders[1].a+encoders[1].b", "ready", "The two levels are equal while"},
        {"host_silent", "landing", "A force that falls by itself"},
        {"encoder_lost_counts:2=0.1", "ready", "The hand holds the joint still, so that no count"},
        {"encoder_stuck:2", "ready", "The hand holds the joint still, and no motor"},
        {"shunt_gain:2", "ready", "No current flows, and the reading is zero"},
        {"motor_hot:2", "ready", "A motor that is 100 K hotter passes the self-test, and"},
        {"leg_open:2A", "ready", "The bridges are off and no current flows"},
        {"leg_high:2A", "ready", "The bridge trips when"},
        {"supply_spike+0.005", "fault", "While another fault is told, and in the boot loader"},
        {"logic_sag", "starting", "The chip is in reset"},
        {"core_stalled", "starting", "A core that does not take its first instruction"},
        {"core_stalled", "ready", "None is known: the heartbeat stops with the core"},
        {"main_loop_stalled", "fault", "None is known: the control interrupt misses it."},
        {"logic_sag", "ready", "The voltage is above 2.9 V"},
        {"supply_spike+0.005", "ready", "The capacitors maintain the supply"},
        {"program_astray", "ready",
         "The code that it came to returned to the main loop, and had changed nothing that is "
         "checked. |"},
        {"main_loop_stalled=0.012", "fault", "The main loop is not monitored before it runs"},
        {"main_loop_stalled", "starting", "A core that does not take its first instruction"},
        {"program_astray", "starting",
         "The code that it came to returned to the main loop, and had "
         "changed nothing that is checked; or it came before"},
        {"wire_low:inkwell_switch", "fault", "Before there is a reference it looks like"},
        {"fast_hand", "ready", "The speed of the hand is not limited"},
        {"bridge_fault", "rest", "None is known: every cause that switches the bridges off is reported."}}) {
    CAPTURE(row.fault);
    CAPTURE(row.situation);
    Result result = seen(row.fault, row.situation, 1);
    if (row.situation == std::string("rest") || std::string_view(row.reason).starts_with("The force was switched off"))
      result.off_after_s = 1e-6;
    write_page(std::array{result}, directory / "campaign.md");
    CHECK(content_of(directory / "campaign.md").find(std::string(" | ") + row.reason) != std::string::npos);
  }
}
