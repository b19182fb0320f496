// The page with the campaign results: the worst case of each row, the figures and the plots.
#include <campaign/page.hpp>
#include <campaign/result.hpp>

#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <temporary_directory.hpp>

#include <device/error.hpp>

#include "seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

TEST_CASE("of three instants the worst is told") {
  Result a = seen("shunt_high:2", "wall", 1), b = seen("shunt_high:2", "wall", 2), c = seen("shunt_high:2", "wall", 3);
  a.detected_as = b.detected_as = "over_current";
  a.off_after_s = 20e-6;
  b.off_after_s = 90e-6;
  a.peak_force_N = 2.0;
  c.peak_force_N = 3.0;
  b.energy_J = 0.002;
  c.travel_m = 0.004;
  a.recovery = b.recovery = "clear_fault";
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

TEST_CASE(
    "what failed at the first or third of three stands in the row of the second, and is named where it is worst") {
  const TemporaryDirectory directory;
  Result first = seen("leg_high:1A", "wall", 3), second = seen("leg_high:2A", "wall", 2),
         third = seen("leg_high:3A", "wall", 2);
  for (Result* each : {&first, &second, &third}) {
    each->detected_as = "bridge_fault";
    each->off_after_s = 50e-6;
    each->recovery = "clear_fault";
  }
  third.off_after_s = 90e-6;
  first.peak_force_N = 2.5;
  second.peak_force_N = 2.25;
  write_page(std::array{second, first, third}, directory / "campaign.md");
  const std::string text = content_of(directory / "campaign.md");
  CHECK(text.find("| `leg_high:2A` | bridge_fault | 1.8 | 2.50 |") != std::string::npos);
  CHECK(text.find("| `leg_high:1A` |") == std::string::npos);
  CHECK(text.find("at most 2.50 N in that time (`leg_high:1A` in wall)") != std::string::npos);
}

TEST_CASE("the page has the figures, and leaves nothing out that passed unnoticed or could not be run") {
  const TemporaryDirectory directory;
  Result quick = seen("bridge_fault", "wall", 1);
  quick.detected_as = "bridge_fault";
  quick.off_after_s = 75e-6;
  quick.peak_force_N = 2.49;
  quick.energy_J = 0.00134;
  quick.travel_m = 0.00436;
  quick.recovery = "clear_fault";
  Result missed = seen("motor_hot:2", "motion", 2), off = seen("motor_hot:2", "ready", 2);
  missed.peak_force_N = 9.5;
  missed.position_error_m = 0.012;
  Result failed = seen("dma_stopped", "rest", 3);
  failed.error = "The device did not enumerate.";
  const auto page = directory / "campaign.md";
  write_page(std::array{quick, missed, off, failed}, page);
  const std::string text = content_of(page);
  CHECK(text.find("simulation") != std::string::npos);
  CHECK(text.find("whose brown-out level\nis 3, as `inkwell flash` sets it.") != std::string::npos);
  CHECK(text.find("4 of " + std::to_string(all_cases().size()) + " cases were run") != std::string::npos);
  CHECK(text.find("while the board starts.\n4 of ") != std::string::npos);
  CHECK(text.find("Each fault is put in at 3 random instants while the arm is unreferenced") != std::string::npos);
  CHECK(text.find("are of the 0.3 s after") != std::string::npos);
  CHECK(text.find("at the supply any more, in control periods of 50 us.") != std::string::npos);
  CHECK(text.find("free space, 60 mm in 0.1 s, with all joints.") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | bridge_fault | 1.5 | 2.49 | 1.3 | 4.4 | clear_fault |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | stayed on | 9.50 | 0.0 | 0.0 | none needed; position 12 mm off |") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | were off |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | not used | - | - | The current loop makes up for it") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | 9.5 | 0 | 0 | - | stayed on |") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | wall | 2.5 |") == std::string::npos);  // within the limit
  CHECK(text.find("| " + std::to_string(failed.number) + " | `dma_stopped` rest 3 | The device did not enumerate. |") !=
        std::string::npos);
  CHECK(text.find("`bridge_fault` | wall") == std::string::npos);  // detected
  const std::string plot = content_of(directory / "campaign-off.svg");
  CHECK(text.find("campaign-off.svg") != std::string::npos);
  CHECK(plot.find(">1 to 2</text>") != std::string::npos);
  CHECK(plot.find(">stayed on</text>") != std::string::npos);
  Result fault_free = seen("none", "wall", 1);
  fault_free.energy_J = 0.0003;
  write_page(std::array{quick, fault_free}, page);
  CHECK(content_of(page).find("at most 2.49 N in that time (`bridge_fault` in wall), and got at most 1.0 mJ more") !=
        std::string::npos);
  CHECK(content_of(page).find("more than the force limit and a twentieth of it: none.") != std::string::npos);
  CHECK_THROWS_AS(write_page({}, page), device::Error);
}

TEST_CASE("a page of some of the cases tells what can be told, and says what cannot") {
  const TemporaryDirectory directory;
  const auto page = directory / "campaign.md";
  const auto page_of = [&](const std::vector<Result>& results) {
    write_page(results, page);
    return content_of(page);
  };
  Result off = seen("bridge_fault", "ready", 1);
  CHECK(page_of({off}).find("No case with the force on was run") != std::string::npos);

  Result pressed = seen("bridge_fault", "wall", 1), swung = seen("bridge_fault", "motion", 1);
  pressed.peak_force_N = 2.98;
  pressed.energy_J = 0.002;
  swung.peak_force_N = 1.5;
  swung.energy_J = 0.030;
  const std::string alone = page_of({off, pressed, swung});
  CHECK(alone.find("felt at most 2.98 N in that time (`bridge_fault` in wall). How much more energy") !=
        std::string::npos);
  CHECK(alone.find("cannot be told of wall, motion: the case `none` was not run at each of its instants.") !=
        std::string::npos);
  CHECK(alone.find("no case)") == std::string::npos);

  Result fault_free = seen("none", "wall", 1), failed = seen("none", "motion", 1);
  failed.error = "The board did not start.";
  const std::string partly = page_of({fault_free, failed, pressed, swung});
  CHECK(partly.find("felt at most 2.98 N in that time (`bridge_fault` in wall), and got at most 2.0 mJ more than "
                    "without a fault in the same situation at the same instant (`bridge_fault` in wall). How") !=
        std::string::npos);
  CHECK(partly.find("cannot be told of motion:") != std::string::npos);
  fault_free.energy_J = 0.003;
  CHECK(page_of({fault_free, pressed})
            .find("and got no more energy than without a fault in the same situation at the same instant.\n") !=
        std::string::npos);
  CHECK(page_of({fault_free}).find("felt at most 0.00 N in that time (`none` in wall).\n") != std::string::npos);
}

TEST_CASE("energy is compared with that of the same instant, so that none hides behind another instant's") {
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
    return content_of(directory / "campaign.md");
  };
  const std::string text = text_of_page({slow, fast, hit, other});
  CHECK(text.find("at most 50.0 mJ more than without a fault in the same situation at the same instant") !=
        std::string::npos);
  CHECK(text.find("cannot be told") == std::string::npos);
  // An instant without a fault-free case is not compared.
  const std::string partly = text_of_page({slow, fast, hit, other, third});
  CHECK(partly.find("at most 50.0 mJ more") != std::string::npos);
  CHECK(partly.find("cannot be told of motion: ") != std::string::npos);
  third.error = "The board did not start.";
  CHECK(text_of_page({slow, fast, hit, other, third}).find("cannot be told") == std::string::npos);
}

TEST_CASE("the force limit is that of the cases that could be run") {
  const TemporaryDirectory directory;
  const auto page = directory / "campaign.md";
  Result failed = seen("bridge_fault", "wall", 1), run = seen("bridge_fault", "wall", 2);
  failed.error = "The board did not start.";
  failed.force_limit_N = 0;
  run.peak_force_N = 2.0;
  write_page(std::array{failed, run}, page);
  CHECK(content_of(page).find("The force limit is 3.3 N") != std::string::npos);
  CHECK(content_of(page).find("a twentieth of it: none.") != std::string::npos);
}

TEST_CASE("the plots say what is counted, in which unit, what a colour means and where the limit is") {
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
    return std::pair{content_of(directory / "campaign-off.svg"), content_of(directory / "campaign-force.svg")};
  };
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  Result later = seen("encoder_stuck:2", "wall", 1);
  later.peak_force_N = 2.45;
  later.noticed_in_use_as = "encoder_implausible";
  CHECK(count(plots_of({fault_free, later}).first, "not noticed: ") == 0);
  const auto [off, force] = plots_of({fault_free, button, hot, quick});
  CHECK(count(off, "in control periods of 50 μs</text>") == 1);
  CHECK(count(off, "not noticed: 1 of 2 are wires") == 1);
  CHECK(count(off, "#b9c1ca") == 2);  // the bar and its legend entry
  CHECK(count(force, ">peak force at the hand, N</text>") == 1);
  CHECK(count(force, ">force limit 3.3 N</text>") == 1);
  CHECK(count(force, "no more; without a fault: wall 2.4 N") == 1);
  // The axis stops at the largest force: nine classes, three of them with a case. Bars of forces that also occur
  // without a fault are gray. Each color appears once more in the legend.
  CHECK(count(force, ">4.5</text>") == 1);
  CHECK(count(force, ">5</text>") == 0);
  CHECK(count(force, "#b9c1ca") == 3);
  CHECK(count(force, "#3b6ea5") == 2);
  CHECK(count(force, "not compared") == 0);
  const std::string few = plots_of({fault_free, moved}).second;
  CHECK(count(few, "or not compared: no case") == 1);
  // A plot with few bars is wide enough for its title and its legend.
  CHECK(std::stoul(few.substr(few.find("width=\"") + 7)) > 600);
}
