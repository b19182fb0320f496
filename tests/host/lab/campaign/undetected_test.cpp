// Undetected faults are listed on the page, each with its reason.
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/handling.hpp"
#include "host/lab/campaign/page.hpp"
#include "host/lab/campaign/result.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include "tests/temporary_directory.hpp"

#include "host/client/device/error.hpp"
#include "host/lab/experiment/wall.hpp"
#include "protocol/supervision.hpp"

#include "tests/host/lab/campaign/seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::pages_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("a restart is a detection; a lock-up or bridges that switched off are not") {
  const TemporaryDirectory directory;
  Result restarted = seen("logic_sag", "rest", 1), stuck = seen("logic_sag", "rest", 2),
         quiet = seen("logic_sag", "rest", 3);
  restarted.restarts = 2;
  stuck.locked_up = true;
  quiet.off_after_s = 1e-3;
  const std::array all{restarted, stuck, quiet};
  CHECK(summarise(all).detected == 1);
  write_page(all, directory / "campaign.md");
  const std::string text = pages_of(directory / "campaign.md");
  CHECK(text.find("| `logic_sag` | lock-up; restart (1 of 3) |") != std::string::npos);
  CHECK(text.find("| `logic_sag` | rest (1 of 3) | without use |") !=
        std::string::npos);  // locked up with the bridges on
  CHECK(text.find("| `logic_sag` | rest (1 of 3) | - | The microcontroller does not run") !=
        std::string::npos);  // bridges off
}

TEST_CASE("bridges that switched on unexpectedly are listed before other results") {
  const TemporaryDirectory directory;
  Result off = seen("bridge_fault", "ready", 1), on = seen("wire_high:bridge_enable", "ready", 2);
  const auto page = directory / "campaign.md";
  write_page(std::array{off, on}, page);
  CHECK(pages_of(page).find("No bridge switched on unexpectedly after the injection.") != std::string::npos);
  on.bridges_went_on = true;
  on.peak_force_N = 1.25;
  write_page(std::array{off, on}, page);
  const std::string text = pages_of(page);
  const auto section = text.find("## Bridges that switched on unexpectedly");
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

TEST_CASE("undetected faults are listed with their result during use, compared with a healthy arm") {
  const TemporaryDirectory directory;
  Result stuck = seen("encoder_stuck:2", "rest", 1), stuck_later = seen("encoder_stuck:2", "wall", 2),
         hot = seen("motor_hot:2", "rest", 1), fault_free = seen("none", "rest", 1);
  for (Result* result : {&stuck, &stuck_later, &hot, &fault_free}) result->peak_force_in_use_N = 3.25;
  stuck.noticed_in_use_as = {NoticedInUse::By::fault, protocol::Fault::encoder_implausible};
  stuck.noticed_in_use_s = 0.9;
  stuck_later.peak_force_in_use_N = 3.4;
  stuck_later.noticed_in_use_as = {NoticedInUse::By::fault, protocol::Fault::motor_implausible};
  stuck_later.noticed_in_use_s = 1.75;
  // One of the situations has no fault-free case at the same instant.
  fault_free.energy_in_use_J = 0.04;
  hot.energy_in_use_J = 0.039;
  stuck.energy_in_use_J = 0.0425;
  stuck_later.energy_in_use_J = 0.09;
  const auto text_with = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    return pages_of(directory / "campaign.md");
  };
  const std::string text = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(text.find(
            "for another 0.6 s. After this, the hand pressed 2 times into the front wall and into the side wall with "
            "the force limit. Finally it swung 4 times.") != std::string::npos);
  CHECK(text.find(
            "Without a fault, the largest force during use was 3.25 N, and a fault was reported in 0 of 1 cases.") !=
        std::string::npos);
  CHECK(text.find("none needed (encoder_implausible during use)") != std::string::npos);
  CHECK(text.find(
            "| `encoder_stuck:2` | rest, wall | encoder_implausible; motor_implausible, within 1.75 s | 3.40 | - | ") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | rest | - | 3.25 | none | ") != std::string::npos);
  stuck.noticed_in_use_s = std::nullopt;
  fault_free.noticed_in_use_s = 0.1;
  const std::string other = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(other.find("| rest, wall | motor_implausible (1 of 2), within 1.75 s | 3.40 | - | ") != std::string::npos);
  CHECK(other.find("a fault was reported in 1 of 1 cases.") != std::string::npos);
  fault_free.noticed_in_use_s = std::nullopt;
  CHECK(text_with({stuck, stuck_later, hot, fault_free}).find("(1 of 2), within 1.75 s | 3.40 | 2.5 | ") !=
        std::string::npos);
  stuck.peak_force_in_use_N = std::nullopt;
  hot.peak_force_in_use_N = 3.6;
  const std::string third = text_with({stuck, stuck_later, hot, fault_free});
  CHECK(third.find("| rest, wall | motor_implausible, within 1.75 s; 1 without use | ") != std::string::npos);
  CHECK(third.find("| `motor_hot:2` | rest, continued use | 3.6 | - | - | - | - |") != std::string::npos);
}

TEST_CASE("bridges that switched off without a report are listed with the later report, and only they") {
  const TemporaryDirectory directory;
  const auto section_of = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    const std::string text = pages_of(directory / "campaign.md");
    const auto begin = text.find("## Bridges off without a report");
    return text.substr(begin, text.find("\n## ", begin) - begin);
  };
  Result halted = seen("core_halted", "wall", 1), halted_at_rest = seen("core_halted", "rest", 2),
         told = seen("core_halted", "rest", 3), off_before = seen("core_halted", "ready", 1),
         stayed = seen("core_halted", "motion", 1), failed = seen("core_halted", "motion", 2);
  for (Result* result : {&halted, &halted_at_rest, &told, &failed}) result->off_after_s = 1e-6;
  halted.fault_on_healing = protocol::Fault::heartbeat_missed;
  told.detected_as = protocol::Fault::watchdog;
  told.fault_on_healing = protocol::Fault::over_speed;
  failed.error = "The board did not start.";
  const std::string row =
      "| `core_halted` | rest (1 of 2), wall | heartbeat_missed | A halted core cannot report a fault.";
  const std::string section = section_of({halted, halted_at_rest, told, off_before, stayed, failed});
  CHECK(section.find(row) != std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  CHECK(section_of({halted_at_rest}).find("| `core_halted` | rest | - | ") != std::string::npos);
  CHECK(section_of({told, off_before, stayed, failed})
            .ends_with("a fault was reported whenever the bridges switched off.\n"));
}

TEST_CASE("self-test pulses do not count as force") {
  const TemporaryDirectory directory;
  std::vector<Result> results;
  for (const char* situation : {"wall", "ramping", "limited", "landing", "testing"}) {
    results.push_back(seen("none", situation, 1));
    results.push_back(seen("motor_hot:2", situation, 1));
  }
  for (Result& result : results) {
    const bool is_test = result.situation == CaseSituation::testing;
    result.bridges_were_on = true;
    result.peak_force_N = is_test ? 9.0 : 2.0;
    result.energy_J = is_test ? 0.5 : 0.001;
    if (is_test) result.off_after_s = 0.01;
  }
  write_page(results, directory / "campaign.md");
  const std::string text = pages_of(directory / "campaign.md");
  for (const char* heading : {"wall", "ramping", "limited", "landing", "testing"})
    CHECK(text.find("\n## " + std::string(heading) + "\n\n") != std::string::npos);
  CHECK(text.find("the largest force on the hand was 2.00 N") != std::string::npos);
  CHECK(text.find("no case exceeded 105 % of the force limit.") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | wall, ramping, limited, landing | without use |") != std::string::npos);
  CHECK(text.find("a fault was reported whenever the bridges switched off.") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | testing | A motor that is 100 K") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | 200 | 9.00 | 500.0 |") != std::string::npos);
  const std::string force = content_of(directory / "campaign/force.svg");
  CHECK(force.find("wall 2.0 N, ramping 2.0 N, limited 2.0 N, landing 2.0 N<") != std::string::npos);
  CHECK(content_of(directory / "campaign/off.svg").find("undetected: 0 of 4 are wire faults") != std::string::npos);
}

TEST_CASE("faults that are undetected without force have a separate table") {
  const TemporaryDirectory directory;
  const auto section_of = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    const std::string text = pages_of(directory / "campaign.md");
    const auto begin = text.find("## Undetected without force");
    return text.substr(begin, text.find("\n## ", begin) - begin);
  };
  Result lost = seen("encoder_slip:2=400", "unreferenced", 1), jumped = seen("encoder_slip:2=400", "ready", 1),
         pressed = seen("encoder_slip:2=400", "wall", 1), fault_free = seen("none", "ready", 1);
  jumped.detected_as = protocol::Fault::encoder_implausible;
  const std::string section = section_of({lost, jumped, pressed, fault_free});
  CHECK(section.find("| `encoder_slip:2=400` | unreferenced | Without a reference, the slip has") != std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  // Faults with the same reason and the same situations share a row.
  const std::string shared = section_of({seen("wire_open:button_1", "ready", 1), seen("wire_open:supply", "ready", 1),
                                         seen("wire_open:button_2", "ready", 1), seen("wire_low:button_2", "rest", 1),
                                         seen("wire_high:button_2", "testing", 1)});
  CHECK(shared.find("| `wire_open:button_1`, `wire_open:button_2` | ready | A faulty switch wire") !=
        std::string::npos);
  CHECK(shared.find("| `wire_open:supply` | ready | ") != std::string::npos);
  CHECK(shared.find("| `wire_high:button_2` | testing | A faulty switch wire") != std::string::npos);
  CHECK(section_of({jumped, pressed, fault_free}).ends_with("No fault without force was undetected.\n"));
}

TEST_CASE("if only some of three equivalent parts are undetected, the page names them") {
  const TemporaryDirectory directory;
  std::vector<Result> results{seen("motor_open:2", "wall", 1),    seen("motor_open:1", "wall", 3),
                              seen("motor_open:3", "wall", 2),    seen("encoder_stuck:2", "wall", 1),
                              seen("encoder_stuck:1", "wall", 3), seen("encoder_stuck:3", "wall", 2)};
  for (const auto& [fault, phase] :
       {std::pair{"leg_slow:2A", 1u}, {"leg_slow:2A", 2u}, {"leg_slow:1A", 3u}, {"leg_slow:3A", 2u}})
    results.push_back(seen(fault, "wall", phase));
  results[6].detected_as = protocol::Fault::motor_implausible;
  results[0].detected_as = results[3].detected_as = results[4].detected_as = protocol::Fault::motor_implausible;
  write_page(results, directory / "campaign.md");
  const std::string text = pages_of(directory / "campaign.md");
  CHECK(text.find("| `motor_open:2` | wall (2 of 3, at 1 and 3) | without use |") != std::string::npos);
  CHECK(text.find("| `encoder_stuck:2` | wall (1 of 3, at 3) | without use |") != std::string::npos);
  CHECK(text.find("| `leg_slow:2A` | wall (3 of 4) | without use |") != std::string::npos);
}

TEST_CASE("interrupts have separate reasons, and so do motors in the self-test") {
  const TemporaryDirectory directory;
  const auto row_of = [&](const std::string& fault, const std::string& situation) {
    write_page(std::array{seen(fault, situation, 1)}, directory / "campaign.md");
    std::istringstream lines(pages_of(directory / "campaign.md"));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("| `" + fault + "` | " + situation + " | ")) return line;
    return std::string();
  };
  for (const char* exception : {"exception_lost:14", "exception_late:14"})
    CHECK(row_of(exception, "rest").find("where the main loop hangs") != std::string::npos);
  for (const char* exception : {"exception_lost:17", "exception_late:17"})
    CHECK(row_of(exception, "rest").find("the brown-out reset also monitor this supply") != std::string::npos);
  CHECK(row_of("exception_lost:34", "rest").find("No reason is known") != std::string::npos);
  CHECK(row_of("exception_late:34", "rest").find("The delay is shorter than") != std::string::npos);
  CHECK(row_of("models_lost", "rest").find("A model fades 20 ms") != std::string::npos);
  CHECK(row_of("models_stale", "rest").find("The board refuses the models") != std::string::npos);
  CHECK(row_of("models_contradictory", "rest").find("Each model is valid") != std::string::npos);
  for (const char* fault : {"leg_slow:2A", "motor_open:2", "shunt_frozen:2", "wire_open:motor_current[1]",
                            "wires_shorted:bridges[1].leg_a+bridges[1].leg_b"}) {
    CAPTURE(fault);
    for (const char* situation : {"testing", "starting"})
      CHECK(row_of(fault, situation).find("after the self-test pulses of this motor") != std::string::npos);
    CHECK(row_of(fault, "ready").size() > 40);
    CHECK(row_of(fault, "ready").find("after the self-test pulses") == std::string::npos);
  }
  CHECK(row_of("motor_hot:2", "testing").find("passes the self-test") != std::string::npos);
  CHECK(row_of("encoder_stuck:2", "testing").find("The hand keeps the joint stationary") != std::string::npos);
}

TEST_CASE("each undetected fault has a reason in each of the three tables") {
  const TemporaryDirectory directory;
  struct Table {
    const char* situation;
    std::optional<double> off_after_s;
    std::string before_reason;
  };
  std::string text;
  for (const Table& table :
       {Table{"ready", {}, "ready | "}, {"rest", 1e-6, "rest | - | "}, {"rest", {}, "rest | without use | - | "}}) {
    std::vector<Result> results;
    for (const CaseFault& fault : case_faults())
      if (fault.fault || is_about_models(fault.deed)) {
        results.push_back(seen(fault.name(), table.situation, 1));
        results.back().off_after_s = table.off_after_s;
      }
    write_page(results, directory / "campaign.md");
    text = pages_of(directory / "campaign.md");
    for (const Result& result : results) {
      CAPTURE(result.fault.name());
      CAPTURE(table.before_reason);
      // Each fault is listed alone or with faults of the same reason.
      std::string reason;
      std::istringstream lines(text);
      for (std::string line; reason.empty() && std::getline(lines, line);) {
        const auto at = line.find("` | " + table.before_reason);
        if (line.starts_with("| `") && line.find("`" + result.fault.name() + "`") <= at && at != std::string::npos)
          reason = line.substr(at + 4 + table.before_reason.size());
      }
      REQUIRE(reason.ends_with(" |"));
      reason.resize(reason.size() - 2);
      CHECK(reason.size() > 20);
      CHECK(reason.ends_with("."));
      // A reason that applies only with disabled bridges must not appear while the force is on.
      if (result.situation == CaseSituation::rest)
        CHECK(reason.find("correct while the bridges are off") == std::string::npos);
    }
  }
  CHECK(text.find("`shunt_frozen:2` | rest | without use | - | - | Voltage, reading and speed agree") !=
        std::string::npos);
  CHECK(text.find("`program_astray` | rest | without use | - | - | The code at the target address returned") !=
        std::string::npos);
}

TEST_CASE("faults without force or without a report have separate reasons") {
  const TemporaryDirectory directory;
  struct Row {
    const char *fault, *situation, *reason;
  };
  for (const Row& row :
       {Row{"wire_low:inkwell_switch", "unreferenced", "Without a reference, the wire looks like a stylus in"},
        {"wire_open:inkwell_switch", "unreferenced", "A faulty switch wire looks like a"},
        {"wire_low:bridge_fault_tim8", "ready", "Only the break input of TIM8 reads this pin, and only while"},
        {"wire_open:bridge_fault_tim8", "ready", "The wire has the level of healthy bridges."},
        {"wire_spikes:bridge_fault_tim8", "ready", "Only the break input of TIM8"},
        {"wire_spikes:inkwell_switch", "ready", "The input filters and repeated"},
        {"wire_open:bridges[1].leg_a", "ready", "The leg is low, which is correct while the bridges are"},
        {"wire_frozen:bridge_enable", "ready", "The microcontroller pin has the correct level. A low level at the"},
        {"wire_open:bridge_heartbeat", "ready", "The wire is low, which is correct while the bridges"},
        {"wire_frozen:motor_current[1]", "ready", "No current flows, and the"},
        {"wire_open:encoders[1].a", "ready", "The hand keeps the joint stationary"},
        {"wire_open:usb_supply", "ready", "A lost USB connection is reported only while the"},
        {"wire_low:usb_supply", "landing", "The force was already decreasing after it was"},
        {"wire_high:usb_supply", "ready", "The wire has the same level as with the cable connected."},
        {"wire_low:bridge_hold", "ready", "The wire is low, which is correct while the bridges"},
        {"wire_high:bridge_hold", "wall", "The wire has the same level as with the bridges on."},
        {"wire_low:bridge_heartbeat", "rest", "No reason is known"},
        {"wire_open:supply", "rest", "No reason is known"},
        {"crystal_drift", "ready", "A lost USB connection is reported only while the"},
        {"crystal_drift", "landing", "The force was already decreasing after it was"},
        {"usb_cut", "ready", "A lost USB connection is reported only while the"},
        {"usb_cut", "landing", "The force was already decreasing after it was"},
        {"usb_cut", "rest", "No reason is known: each cause that switches the bridges off is reported."},
        {"bus_suspended", "ready", "A lost USB connection is reported only while the"},
        {"bus_suspended", "landing", "The force was already decreasing after it was"},
        {"bus_suspended", "rest", "No reason is known: each cause that switches the bridges off is reported."},
        {"models_contradictory", "ready", "Without a force, a local model moves nothing."},
        {"host_silent", "ready", "A silent host is detected only while the force is on."},
        {"host_silent", "rest", "No host polls the"},
        {"core_halted", "ready", "A halted core cannot report a fault. Afterwards it continued normally,"},
        {"wires_shorted:encoders[1].a+encoders[1].b", "ready", "The two wires have the same"},
        {"host_silent", "landing", "A force that is already decreasing does not"},
        {"encoder_lost_counts:2=0.1", "ready", "The hand keeps the joint stationary, so no counts occur that could"},
        {"encoder_stuck:2", "ready", "The hand keeps the joint stationary, and no motor turns it."},
        {"shunt_gain:2", "ready", "No current flows, and the sensor reads zero. The"},
        {"motor_hot:2", "ready", "A motor that is 100 K hotter passes the self-test, and no other"},
        {"leg_open:2A", "ready", "The bridges are off and no current flows. The next"},
        {"leg_high:2A", "ready", "The bridge trips when the other"},
        {"supply_spike+0.005", "fault", "The supply is not monitored during another fault or in the boot"},
        {"logic_sag", "starting", "The microcontroller does not run"},
        {"core_stalled", "starting", "The core was stopped before its first instruction, so no firmware"},
        {"core_stalled", "ready", "No reason is known: the heartbeat stops with the core, and"},
        {"main_loop_stalled", "fault", "No reason is known: the control interrupt monitors the main loop."},
        {"logic_sag", "ready", "The voltage is above 2.9 V"},
        {"supply_spike+0.005", "ready", "The capacitors buffer the supply for"},
        {"program_astray", "ready",
         "The code at the target address returned to the main loop and changed nothing that is checked. |"},
        {"main_loop_stalled=0.012", "fault", "The main loop is not monitored during start-up, during another"},
        {"main_loop_stalled", "starting", "The core was stopped before its first instruction, so no firmware"},
        {"program_astray", "starting",
         "The code at the target address returned to the main loop and changed nothing that is checked. If the fault "
         "occurred before the watchdog"},
        {"wire_low:inkwell_switch", "fault", "Without a reference, the wire looks like a stylus in"},
        {"fast_hand", "ready", "Without a force, the hand speed is not limited."},
        {"bridge_fault", "rest", "No reason is known: each cause that switches the bridges off is reported."}}) {
    CAPTURE(row.fault);
    CAPTURE(row.situation);
    Result result = seen(row.fault, row.situation, 1);
    if (row.situation == std::string("rest") ||
        std::string_view(row.reason).starts_with("The force was already decreasing after it"))
      result.off_after_s = 1e-6;
    write_page(std::array{result}, directory / "campaign.md");
    CHECK(pages_of(directory / "campaign.md").find(std::string(" | ") + row.reason) != std::string::npos);
  }
}
