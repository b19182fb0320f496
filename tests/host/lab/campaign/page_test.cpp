// Tests the page with the campaign results: worst case of each row, figures and plots.
#include "host/lab/campaign/page.hpp"
#include "host/lab/campaign/result.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include "tests/temporary_directory.hpp"

#include "host/client/device/error.hpp"

#include "tests/host/lab/campaign/seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::pages_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("a row shows the worst of three instants") {
  Result a = seen("shunt_high:2", "wall", 1), b = seen("shunt_high:2", "wall", 2), c = seen("shunt_high:2", "wall", 3);
  a.detected_as = b.detected_as = protocol::Fault::over_current;
  a.off_after_s = 20e-6;
  b.off_after_s = 90e-6;
  a.peak_force_N = 2.0;
  c.peak_force_N = 3.0;
  b.energy_J = 0.002;
  c.travel_m = 0.004;
  a.recovery = b.recovery = Recovery::clear_fault;
  const std::array all{a, b, c};
  const Summary s = summarise(all);
  CHECK(s.cases == 3);
  CHECK(s.detected == 2);
  CHECK(s.detected_as == "over_current");
  CHECK(s.were_on == 3);
  CHECK(s.went_off == 2);
  CHECK(s.off_after_s == 90e-6);
  CHECK(s.peak_force_N == 3.0);
  CHECK(s.energy_J == 0.002);
  CHECK(s.travel_m == 0.004);
  CHECK(s.recovery == "clear_fault; none needed");
  b.error = "The board did not start.";
  CHECK(summarise(std::array{a, b, c}).cases == 2);
}

TEST_CASE("the row of the second part includes the first and third part, and the worst part is named") {
  const TemporaryDirectory directory;
  Result first = seen("leg_high:1A", "wall", 3), second = seen("leg_high:2A", "wall", 2),
         third = seen("leg_high:3A", "wall", 2);
  for (Result* each : {&first, &second, &third}) {
    each->detected_as = protocol::Fault::bridge_fault;
    each->off_after_s = 50e-6;
    each->recovery = Recovery::clear_fault;
  }
  third.off_after_s = 90e-6;
  first.peak_force_N = 2.5;
  second.peak_force_N = 2.25;
  write_page(std::array{second, first, third}, directory / "campaign.md");
  const std::string text = pages_of(directory / "campaign.md");
  CHECK(text.find("| `leg_high:2A` | bridge_fault | 1.8 | 2.50 |") != std::string::npos);
  CHECK(text.find("| `leg_high:1A` |") == std::string::npos);
  CHECK(text.find("largest force on the hand was 2.50 N (`leg_high:1A` in wall)") != std::string::npos);
}

TEST_CASE("the pages contain all figures, all undetected faults and all cases that could not be run") {
  const TemporaryDirectory directory;
  Result quick = seen("bridge_fault", "wall", 1);
  quick.detected_as = protocol::Fault::bridge_fault;
  quick.off_after_s = 75e-6;
  quick.peak_force_N = 2.49;
  quick.energy_J = 0.00134;
  quick.travel_m = 0.00436;
  quick.recovery = Recovery::clear_fault;
  Result missed = seen("motor_hot:2", "motion", 2), off = seen("motor_hot:2", "ready", 2);
  missed.peak_force_N = 9.5;
  missed.position_error_m = 0.012;
  Result failed = seen("dma_stopped", "rest", 3);
  failed.error = "The device did not enumerate.";
  const auto page = directory / "campaign.md";
  write_page(std::array{quick, missed, off, failed}, page);
  const std::string text = pages_of(page);
  CHECK(text.find("All results are simulated.") != std::string::npos);
  CHECK(text.find("with brown-out level 3.") != std::string::npos);
  CHECK(text.find("| completed cases | 3 of " + std::to_string(all_cases().size()) + " |") != std::string::npos);
  CHECK(text.find("| cases that could not be run | 1 |") != std::string::npos);
  CHECK(text.find("in 12 situations, at 3 random instants each.") != std::string::npos);
  CHECK(text.find("values of the 0.3 s after") != std::string::npos);
  CHECK(text.find("was driven high, in control periods of 50 us.") != std::string::npos);
  CHECK(text.find("free space by 60 mm in 0.1 s, and all joints move.") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | bridge_fault | 1.5 | 2.49 | 1.3 | 4.4 | clear_fault |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | stayed on | 9.50 | 0.0 | 0.0 | none needed; position error 12 mm |") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | already off |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | without use | - | - | The current loop compensates for") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | 9.5 | 0 | 0 | - | stayed on |") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | wall | 2.5 |") == std::string::npos);  // within the limit
  CHECK(text.find("| " + std::to_string(failed.number) + " | `dma_stopped` rest 3 | The device did not enumerate. |") !=
        std::string::npos);
  CHECK(text.find("`bridge_fault` | wall") == std::string::npos);  // detected
  const std::string plot = content_of(directory / "campaign/off.svg");
  CHECK(text.find("campaign/off.svg") != std::string::npos);
  CHECK(plot.find(">1 to 2</text>") != std::string::npos);
  CHECK(plot.find(">stayed on</text>") != std::string::npos);
  Result fault_free = seen("none", "wall", 1);
  fault_free.energy_J = 0.0003;
  write_page(std::array{quick, fault_free}, page);
  CHECK(pages_of(page).find("the largest extra energy was 1.0 mJ (`bridge_fault` in wall).\n") != std::string::npos);
  CHECK(pages_of(page).find("no case exceeded 105 % of the force limit.") != std::string::npos);
  CHECK_THROWS_AS(write_page({}, page), device::Error);
}

TEST_CASE("the summary has one screen, counts faults and links to the details") {
  const TemporaryDirectory directory;
  Result undetected = seen("motor_hot:2", "wall", 1), revealed = seen("motor_open:2", "wall", 1),
         off = seen("host_silent", "rest", 1), idle = seen("motor_hot:2", "ready", 1),
         above = seen("bridge_fault", "wall", 1), lost = seen("bridge_fault", "update", 1);
  undetected.peak_force_in_use_N = revealed.peak_force_in_use_N = 2.0;
  revealed.noticed_in_use_s = 0.5;
  revealed.noticed_in_use_as = {NoticedInUse::By::fault, protocol::Fault::motor_implausible};
  off.off_after_s = 1e-3;
  above.detected_as = lost.detected_as = protocol::Fault::bridge_fault;
  above.peak_force_N = 9.0;
  lost.missed_boot_loader = true;
  const auto page = directory / "results.of.today.md";
  write_page(std::array{undetected, revealed, off, idle, above, lost}, page);
  const std::string text = content_of(page);
  CHECK(std::ranges::count(text, '\n') <= 45);
  for (const char* row :
       {"| bridges that switched on unexpectedly | 0 |", "force limit (3.3 N) | 1 |",
        "| faults undetected with the force on | 2 |", "during continued use | 1 |",
        "| faults after which the bridges were off without a report | 1 |", "| faults undetected without force | 1 |",
        "| cases that lost the report of an earlier fault | 0 |", "| cases that did not reach the boot loader | 1 |"}) {
    CAPTURE(row);
    CHECK(text.find(row) != std::string::npos);
  }
  CHECK(text.find("](results.of.today/off.svg)") != std::string::npos);
  CHECK(content_of(directory / "results.of.today/hand.md").find("](../results.of.today.md)") != std::string::npos);
  CHECK_THROWS_AS(write_page(std::array{off}, directory / "results"), device::Error);  // the name of the folder
}

TEST_CASE("pages of only some cases state which values are unknown") {
  const TemporaryDirectory directory;
  const auto page = directory / "campaign.md";
  const auto page_of = [&](const std::vector<Result>& results) {
    write_page(results, page);
    return pages_of(page);
  };
  Result off = seen("bridge_fault", "ready", 1);
  CHECK(page_of({off}).find("No case with the force on was run") != std::string::npos);

  Result pressed = seen("bridge_fault", "wall", 1), swung = seen("bridge_fault", "motion", 1);
  pressed.peak_force_N = 2.98;
  pressed.energy_J = 0.002;
  swung.peak_force_N = 1.5;
  swung.energy_J = 0.030;
  const std::string alone = page_of({off, pressed, swung});
  CHECK(alone.find("the largest force on the hand was 2.98 N (`bridge_fault` in wall). The extra energy is unknown") !=
        std::string::npos);
  CHECK(alone.find("unknown for some cases in wall, motion, because the case `none` was not run at each instant.") !=
        std::string::npos);

  Result fault_free = seen("none", "wall", 1), failed = seen("none", "motion", 1);
  failed.error = "The board did not start.";
  const std::string partly = page_of({fault_free, failed, pressed, swung});
  CHECK(partly.find(
            "the largest force on the hand was 2.98 N (`bridge_fault` in wall). Compared with the fault-free case in "
            "the same situation at the same instant, the largest extra energy was 2.0 mJ (`bridge_fault` in "
            "wall). The extra energy is unknown") != std::string::npos);
  CHECK(partly.find("unknown for some cases in motion,") != std::string::npos);
  fault_free.energy_J = 0.003;
  CHECK(page_of({fault_free, pressed}).find("same situation at the same instant, no case delivered extra energy.\n") !=
        std::string::npos);
  CHECK(page_of({fault_free}).find("the largest force on the hand was 0.00 N (`none` in wall).\n") !=
        std::string::npos);
}

TEST_CASE("energy is compared with that of the same instant") {
  const TemporaryDirectory directory;
  Result slow = seen("none", "motion", 1), fast = seen("none", "motion", 2), hit = seen("bridge_fault", "motion", 1),
         other = seen("bridge_fault", "motion", 2), third = seen("bridge_fault", "motion", 3);
  slow.energy_J = 0.010;
  fast.energy_J = 0.100;
  hit.energy_J = 0.060;
  other.energy_J = 0.090;
  third.energy_J = 0.200;
  const auto text_of_page = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    return pages_of(directory / "campaign.md");
  };
  const std::string text = text_of_page({slow, fast, hit, other});
  CHECK(text.find("the same situation at the same instant, the largest extra energy was 50.0 mJ") != std::string::npos);
  CHECK(text.find("extra energy is unknown") == std::string::npos);
  // A case is compared only with a fault-free case at the same instant.
  const std::string partly = text_of_page({slow, fast, hit, other, third});
  CHECK(partly.find("the largest extra energy was 50.0 mJ") != std::string::npos);
  CHECK(partly.find("unknown for some cases in motion,") != std::string::npos);
  third.error = "The board did not start.";
  CHECK(text_of_page({slow, fast, hit, other, third}).find("extra energy is unknown") == std::string::npos);
}

TEST_CASE("the force limit is that of the cases that could be run") {
  const TemporaryDirectory directory;
  const auto page = directory / "campaign.md";
  Result failed = seen("bridge_fault", "wall", 1), run = seen("bridge_fault", "wall", 2);
  failed.error = "The board did not start.";
  failed.force_limit_N = 0;
  run.peak_force_N = 2.0;
  write_page(std::array{failed, run}, page);
  CHECK(pages_of(page).find("105 % of the force limit (3.3 N)") != std::string::npos);
  CHECK(pages_of(page).find("no case exceeded 105 % of the force limit.") != std::string::npos);
}

TEST_CASE("the plots have titles, units, a legend and the force limit") {
  const TemporaryDirectory directory;
  Result fault_free = seen("none", "wall", 1), button = seen("wire_open:button_1", "wall", 1),
         hot = seen("motor_hot:2", "wall", 1), quick = seen("bridge_fault", "wall", 1),
         moved = seen("bridge_fault", "motion", 1);
  fault_free.peak_force_N = 2.41;
  button.peak_force_N = 2.45;
  hot.peak_force_N = 4.2;
  quick.peak_force_N = 0.3;
  quick.off_after_s = moved.off_after_s = 75e-6;
  moved.peak_force_N = 0.8;
  const auto plots_of = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    return std::pair{content_of(directory / "campaign/off.svg"), content_of(directory / "campaign/force.svg")};
  };
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  Result later = seen("encoder_stuck:2", "wall", 1);
  later.peak_force_N = 2.45;
  later.noticed_in_use_as = {NoticedInUse::By::fault, protocol::Fault::encoder_implausible};
  CHECK(count(plots_of({fault_free, later}).first, "undetected: ") == 0);
  const auto [off, force] = plots_of({fault_free, button, hot, quick});
  CHECK(count(off, "in control periods of 50 μs</text>") == 1);
  CHECK(count(off, "undetected: 1 of 2 are wire faults") == 1);
  CHECK(count(off, "#b9c1ca") == 2);  // the bar and its legend entry
  CHECK(count(force, ">peak force at the hand, N</text>") == 1);
  CHECK(count(force, ">force limit 3.3 N</text>") == 1);
  CHECK(count(force, "at most this; forces without a fault: wall 2.4 N") == 1);
  // The force axis has nine classes. Three of the nine classes contain cases. Bars are gray for forces that fault-free
  // cases also reach. The legend repeats each color.
  CHECK(count(force, ">4.5</text>") == 1);
  CHECK(count(force, ">5</text>") == 0);
  CHECK(count(force, "#b9c1ca") == 3);
  CHECK(count(force, "#3b6ea5") == 2);
  CHECK(count(force, "fault-free case") == 0);
  const std::string few = plots_of({fault_free, moved}).second;
  CHECK(count(few, "or without a fault-free case") == 1);
  // A plot with few bars is wide enough for its title and its legend.
  CHECK(std::stoul(few.substr(few.find("width=\"") + 7)) > 600);
}
