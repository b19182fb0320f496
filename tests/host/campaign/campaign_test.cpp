// The list of cases, their files, and the page that is made of them.
#include <campaign/cases.hpp>
#include <campaign/handling.hpp>
#include <campaign/page.hpp>
#include <campaign/result.hpp>
#include <campaign/run.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <temporary_directory.hpp>

#include <device/error.hpp>
#include <protocol/supervision.hpp>

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::TemporaryDirectory;

namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Result seen(const std::string& fault, const std::string& situation, unsigned phase) {
  for (const Case& c : all_cases())
    if (c.fault.name() == fault && name_of(c.situation) == situation && c.phase == phase)
      return {.number = c.number,
              .fault = fault,
              .situation = situation,
              .phase = phase,
              .bridges_were_on = is_active(c.situation),
              .force_limit_N = 3.3,
              .recovery = "none needed"};
  FAIL("there is no such case: ", fault);
  return {};
}

}  // namespace

TEST_CASE("the list has every fault of the table in every situation, three times or once, and is numbered through") {
  const auto cases = all_cases();
  std::set<std::string> names;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CHECK(cases[i].number == i + 1);
    CHECK(names.insert(cases[i].name()).second);
  }
  CHECK(cases.size() == case_faults().size() * (5 * 3 + 4));
  CHECK_FALSE(cases[0].fault.fault);
  for (const auto& row : protocol::injection_table) {
    CAPTURE(row.name);
    for (const CaseSituation situation : situations)
      CHECK(std::ranges::count_if(cases, [&](const Case& c) {
              return c.fault.fault && protocol::info(*c.fault.fault).name == row.name && c.situation == situation;
            }) >= phases_of(situation));
  }
  // Wires by what the board's facts call them, those of one motor; none that a host or a probe hangs on.
  CHECK(names.contains("wire_open:encoders[1].a wall 2"));
  CHECK(names.contains("wire_high:bridge_enable rest 1"));
  CHECK_FALSE(names.contains("wire_open:encoders[0].a wall 1"));
  CHECK_FALSE(names.contains("wire_open:usb_plus wall 1"));
  CHECK(names.contains("supply_spike+0.005 motion 3"));
  CHECK(names.contains("none wall 3"));
  for (const char* once : {"ramping", "limited", "landing", "testing"}) {
    CHECK(names.contains("none " + std::string(once) + " 1"));
    CHECK_FALSE(names.contains("none " + std::string(once) + " 2"));
  }
  // As the table has it, and more or less.
  for (const char* amount :
       {"shunt_gain:2", "shunt_gain:2=2", "logic_sag", "logic_sag=2.86", "analog_sag", "analog_sag=3.5"})
    CHECK(names.contains(std::string(amount) + " rest 1"));
  // SysTick, and positions 18 and 67 of RM0090's vector table.
  for (const char* exception : {"15", "34", "83"})
    CHECK(names.contains("exception_lost:" + std::string(exception) + " rest 1"));
}

TEST_CASE("every state of the board in which more than its first fault can be told is tried") {
  const auto is_tried = [](const protocol::StateInfo& state) {
    // While the force is on it is tried at rest, in the wall and in motion.
    return state.name == "active" ||
           std::ranges::any_of(situations, [&](CaseSituation situation) { return name_of(situation) == state.name; });
  };
  for (std::size_t i = 0; i < protocol::state_count; ++i) {
    const auto state = static_cast<protocol::State>(i);
    CAPTURE(protocol::info(state).name);
    const bool is_watched = std::ranges::any_of(
        protocol::watch_table, [&](const protocol::Watch& row) { return row.watched_in.contains(state); });
    CHECK(is_tried(protocol::info(state)) == (is_watched && state != protocol::State::starting));
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
  result.detected_as = "bridge_fault";
  result.peak_force_N = 2.5;
  result.position_error_m = 1e-5;
  save(result, directory.path());
  Result other = seen("none", "rest", 1);
  other.error = "The board did not \"start\".";
  save(other, directory.path());
  const auto loaded = load_all(directory.path());
  REQUIRE(loaded.size() == 2);
  CHECK(loaded[0] == other);
  CHECK(loaded[1] == result);
  CHECK(std::distance(std::filesystem::directory_iterator(directory.path()), {}) == 2);  // nothing unfinished is left

  std::ofstream(file_of(directory.path(), 9)) << "{\"number\": 9}";
  CHECK_THROWS_WITH_AS(load_all(directory.path()), doctest::Contains("case-00009.json: This is no result of a case"),
                       device::Error);
  CHECK_THROWS_AS(load_all(directory / "nowhere"), device::Error);
  CHECK_THROWS_AS(save(result, directory / "nowhere"), device::Error);
}

TEST_CASE("a result whose counts are no counts is refused with their name") {
  const std::string text = text_of({.number = 7, .phase = 2, .restarts = 1});
  CHECK(parse_result(text).number == 7);
  for (const auto& [sound, damaged] : {std::pair{"\"number\": 7", "\"number\": 5e29"},
                                       {"\"number\": 7", "\"number\": 4294967296"},
                                       {"\"phase\": 2", "\"phase\": -2"},
                                       {"\"restarts\": 1", "\"restarts\": 1.5"},
                                       {"\"restarts\": 1", "\"restarts\": \"\\u00ff\""}}) {
    CAPTURE(damaged);
    const std::string name = std::string(sound).substr(1, std::string(sound).find('"', 1) - 1);
    std::string wrong = text;
    wrong.replace(wrong.find(sound), std::string(sound).size(), damaged);
    CHECK_THROWS_WITH_AS(parse_result(wrong), doctest::Contains((name + " is ").c_str()), device::Error);
  }
}

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
  CHECK(text.find("whose brown-out level\nis 3, as `inkwell flash` sets it;") != std::string::npos);
  CHECK(text.find("4 of " + std::to_string(all_cases().size()) + " cases were run") != std::string::npos);
  CHECK(text.find("and in the others no further fault is told.\n4 of ") != std::string::npos);
  CHECK(text.find("fast motion, at 3 random instants, and at one while the force rises") != std::string::npos);
  CHECK(text.find("are of the 0.3 s after") != std::string::npos);
  CHECK(text.find("at the supply any more, in control periods of 50 us.") != std::string::npos);
  CHECK(text.find("free space, 60 mm in 0.1 s, with all joints.") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | bridge_fault | 1.5 | 2.49 | 1.3 | 4.4 | clear_fault |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | stayed on | 9.50 | 0.0 | 0.0 | none needed; position 12 mm off |") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | - | were off |") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | not used | - | The current loop makes up for it") != std::string::npos);
  CHECK(text.find("| `motor_hot:2` | motion | 9.5 | 0 | 0 | - | stayed on |") != std::string::npos);
  CHECK(text.find("| `bridge_fault` | wall | 2.5 |") == std::string::npos);  // within the limit
  CHECK(text.find("| " + std::to_string(failed.number) + " | `dma_stopped` rest 3 | The device did not enumerate. |") !=
        std::string::npos);
  CHECK(text.find("`bridge_fault` | wall") == std::string::npos);  // it was noticed
  const std::string plot = content_of(directory / "campaign-off.svg");
  CHECK(text.find("campaign-off.svg") != std::string::npos);
  CHECK(plot.find(">1 to 2</text>") != std::string::npos);
  CHECK(plot.find(">stayed on</text>") != std::string::npos);
  Result sound = seen("none", "wall", 1);
  sound.energy_J = 0.0003;
  write_page(std::array{quick, sound}, page);
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

  Result sound = seen("none", "wall", 1), failed = seen("none", "motion", 1);
  failed.error = "The board did not start.";
  const std::string partly = page_of({sound, failed, pressed, swung});
  CHECK(partly.find("felt at most 2.98 N in that time (`bridge_fault` in wall), and got at most 2.0 mJ more than "
                    "without a fault in the same situation at the same instant (`bridge_fault` in wall). How") !=
        std::string::npos);
  CHECK(partly.find("cannot be told of motion:") != std::string::npos);
  sound.energy_J = 0.003;
  CHECK(page_of({sound, pressed})
            .find("and got no more energy than without a fault in the same situation at the same instant.\n") !=
        std::string::npos);
  CHECK(page_of({sound}).find("felt at most 0.00 N in that time (`none` in wall).\n") != std::string::npos);
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
  // An instant without a sound case is compared with no other one.
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
  Result sound = seen("none", "wall", 1), button = seen("wire_open:button_1", "wall", 1),
         hot = seen("motor_hot:2", "wall", 1), quick = seen("bridge_fault", "wall", 1),
         moved = seen("bridge_fault", "motion", 1);
  sound.peak_force_N = 2.41;
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
  CHECK(count(plots_of({sound, later}).first, "not noticed: ") == 0);
  const auto [off, force] = plots_of({sound, button, hot, quick});
  CHECK(count(off, "in control periods of 50 μs</text>") == 1);
  CHECK(count(off, "not noticed: 1 of 2 are wires") == 1);
  CHECK(count(off, "#b9c1ca") == 2);  // its bar, and what it means
  CHECK(count(force, ">peak force at the hand, N</text>") == 1);
  CHECK(count(force, ">force limit 3.3 N</text>") == 1);
  CHECK(count(force, "no more; without a fault: wall 2.4 N") == 1);
  // Up to the largest force and no further: nine classes, of which three have a case; what it would have been anyway
  // is quiet. Each colour once more, for its meaning.
  CHECK(count(force, ">4.5</text>") == 1);
  CHECK(count(force, ">5</text>") == 0);
  CHECK(count(force, "#b9c1ca") == 3);
  CHECK(count(force, "#3b6ea5") == 2);
  CHECK(count(force, "not compared") == 0);
  const std::string few = plots_of({sound, moved}).second;
  CHECK(count(few, "or not compared: no case") == 1);
  // Few bars do not cut off the title or a colour's meaning.
  CHECK(std::stoul(few.substr(few.find("width=\"") + 7)) > 600);
}

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
  CHECK(text.find("| `logic_sag` | rest (1 of 3) | - | The chip stands") != std::string::npos);  // they went off
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
    "in use the hand presses thrice into the wall, swings to either side and ends in the middle, without a jump") {
  const auto parameters = protocol::default_parameters();
  const auto middle_m = middle_of_box_m(parameters), pressed_m = beyond_forward_wall_m(parameters, 1.0);
  int presses = 0, swings_there = 0;
  double last_s = 0;
  device::Vector3 last_m = middle_m;
  const auto path = pressing_and_swinging(parameters);
  for (const auto& [after_s, target_m] : path) {
    CHECK(after_s > last_s);
    presses += target_m == pressed_m && last_m != pressed_m;
    swings_there += std::abs(target_m[0] - middle_m[0]) > 0.01;
    last_s = after_s;
    last_m = target_m;
  }
  CHECK(presses == 3);
  CHECK(swings_there == 4);
  CHECK(last_m == middle_m);
}

TEST_CASE("what was not noticed is told with what became of it in use, and with what a sound arm showed there") {
  const TemporaryDirectory directory;
  Result stuck = seen("encoder_stuck:2", "rest", 1), stuck_later = seen("encoder_stuck:2", "wall", 2),
         hot = seen("motor_hot:2", "rest", 1), sound = seen("none", "rest", 1);
  for (Result* result : {&stuck, &stuck_later, &hot, &sound}) result->peak_force_in_use_N = 3.25;
  stuck.noticed_in_use_as = "encoder_implausible";
  stuck.noticed_in_use_s = 0.9;
  stuck_later.peak_force_in_use_N = 3.4;
  stuck_later.noticed_in_use_as = "motor_implausible";
  stuck_later.noticed_in_use_s = 1.75;
  const auto text_with = [&](const std::vector<Result>& results) {
    write_page(results, directory / "campaign.md");
    return content_of(directory / "campaign.md");
  };
  const std::string text = text_with({stuck, stuck_later, hot, sound});
  CHECK(
      text.find("for 0.6 s as before, then it pressed 3 times into the wall in front with the force limit and swung 4 "
                "times.") != std::string::npos);
  CHECK(text.find("Without a fault it felt 3.25 N at most, and a fault was told in 0 of 1 cases.") !=
        std::string::npos);
  CHECK(text.find("none needed of the encoder_implausible in use") != std::string::npos);
  CHECK(text.find("| `encoder_stuck:2` | rest, wall | encoder_implausible; motor_implausible, 1.75 s | 3.40 | ") !=
        std::string::npos);
  CHECK(text.find("| `motor_hot:2` | rest | - | 3.25 | ") != std::string::npos);
  stuck.noticed_in_use_s = std::nullopt;
  sound.noticed_in_use_s = 0.1;
  const std::string other = text_with({stuck, stuck_later, hot, sound});
  CHECK(other.find("| rest, wall | motor_implausible (1 of 2), 1.75 s | ") != std::string::npos);
  CHECK(other.find("a fault was told in 1 of 1 cases.") != std::string::npos);
  stuck.peak_force_in_use_N = std::nullopt;
  hot.peak_force_in_use_N = 3.6;
  const std::string third = text_with({stuck, stuck_later, hot, sound});
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
         told = seen("core_halted", "rest", 3), off_before = seen("core_halted", "ready", 1),
         stayed = seen("core_halted", "motion", 1), failed = seen("core_halted", "motion", 2);
  for (Result* result : {&halted, &halted_at_rest, &told, &failed}) result->off_after_s = 1e-6;
  halted.fault_on_healing = "heartbeat_missed";
  told.detected_as = "watchdog";
  told.fault_on_healing = "over_speed";
  failed.error = "The board did not start.";
  const std::string row =
      "| `core_halted` | rest (1 of 2), wall | heartbeat_missed | A core that stands tells nothing;";
  const std::string section = section_of({halted, halted_at_rest, told, off_before, stayed, failed});
  CHECK(section.find(row) != std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  CHECK(section_of({halted_at_rest}).find("| `core_halted` | rest | - | ") != std::string::npos);
  CHECK(section_of({told, off_before, stayed, failed}).ends_with("but no fault was told: none.\n"));
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
         pressed = seen("encoder_slip:2=400", "wall", 1), sound = seen("none", "ready", 1);
  jumped.detected_as = "encoder_implausible";
  const std::string section = section_of({lost, jumped, pressed, sound});
  CHECK(section.find("| `encoder_slip:2=400` | unreferenced | Before there is a reference it does") !=
        std::string::npos);
  CHECK(std::ranges::count(section, '`') == 2);
  // Those of one reason and the same situations share a row.
  const std::string shared = section_of({seen("wire_open:button_1", "ready", 1), seen("wire_open:supply", "ready", 1),
                                         seen("wire_open:button_2", "ready", 1), seen("wire_low:button_2", "rest", 1),
                                         seen("wire_high:button_2", "testing", 1)});
  CHECK(shared.find("| `wire_open:button_1`, `wire_open:button_2` | ready | A switch that is open") !=
        std::string::npos);
  CHECK(shared.find("| `wire_open:supply` | ready | ") != std::string::npos);
  CHECK(shared.find("| `wire_high:button_2` | testing | A switch that is open") != std::string::npos);
  CHECK(section_of({jumped, pressed, sound}).ends_with("in which no fault was told: none.\n"));
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
      // In a row of its own, or with others of the same reason.
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
      // What is so with the bridges off is no reason with the force on.
      if (result.situation == "rest")
        CHECK(reason.find("as it has to be while the bridges are off") == std::string::npos);
    }
  }
  CHECK(text.find("`shunt_frozen:2` | rest | not used | - | Voltage, reading and speed fit") != std::string::npos);
  CHECK(text.find("`program_astray` | rest | not used | - | The code that it came to returned") != std::string::npos);
}

TEST_CASE("what a fault does without force, or silently, has reasons of its own") {
  const TemporaryDirectory directory;
  struct Row {
    const char *fault, *situation, *reason;
  };
  for (const Row& row : {Row{"wire_low:inkwell_switch", "unreferenced", "Before there is a reference it looks like"},
                         {"wire_open:inkwell_switch", "unreferenced", "A switch that is open"},
                         {"wire_low:bridge_fault_tim8", "ready", "This pin is seen by the break input of TIM8"},
                         {"wire_open:bridge_fault_tim8", "ready", "It stands as with sound bridges."},
                         {"wire_spikes:bridge_fault_tim8", "ready", "This pin is seen"},
                         {"wire_spikes:inkwell_switch", "ready", "The inputs' filters"},
                         {"wire_open:bridges[1].leg_a", "ready", "It is low, as a leg has to be"},
                         {"wire_frozen:bridge_enable", "ready", "The chip's own pin is as it has to be."},
                         {"wire_open:bridge_heartbeat", "ready", "It is low, as it has to be"},
                         {"wire_frozen:motor_current[1]", "ready", "No current flows"},
                         {"wire_open:encoders[1].a", "ready", "The hand holds the joint still"},
                         {"wire_open:usb_supply", "ready", "It is a cable that is pulled"},
                         {"wire_low:usb_supply", "rest", "It is a cable that is pulled"},
                         {"wire_high:usb_supply", "ready", "It stands as with the cable in."},
                         {"wire_low:bridge_hold", "ready", "It is low, as it has to be"},
                         {"wire_high:bridge_hold", "wall", "It stands as with the bridges on."},
                         {"wire_low:bridge_heartbeat", "rest", "None is known"},
                         {"wire_open:supply", "rest", "None is known"},
                         {"crystal_drift", "ready", "USB is lost with the clock"},
                         {"crystal_drift", "rest", "USB is lost with the clock"},
                         {"usb_cut", "ready", "It is a cable that is pulled"},
                         {"usb_cut", "rest", "It is a cable that is pulled"},
                         {"host_silent", "ready", "A host is missed while the force is on only."},
                         {"host_silent", "rest", "Nobody asks"},
                         {"core_halted", "ready", "A core that stands tells nothing; it goes on"},
                         {"wires_shorted:encoders[1].a+encoders[1].b", "ready", "The two agree while"},
                         {"host_silent", "landing", "A force that falls by itself"},
                         {"encoder_lost_counts:2=0.1", "ready", "The hand holds the joint still, so that no count"},
                         {"encoder_stuck:2", "ready", "The hand holds the joint still, and no motor"},
                         {"shunt_gain:2", "ready", "No current flows, and it reads none"},
                         {"motor_hot:2", "ready", "A motor that is 100 K hotter passes the self-test, and"},
                         {"leg_open:2A", "ready", "The bridges are off and no current flows"},
                         {"leg_high:2A", "ready", "The bridge trips when"},
                         {"bridge_fault", "rest", "None is known: what takes the bridges off is told."}}) {
    CAPTURE(row.fault);
    CAPTURE(row.situation);
    Result result = seen(row.fault, row.situation, 1);
    if (row.situation == std::string("rest")) result.off_after_s = 1e-6;
    write_page(std::array{result}, directory / "campaign.md");
    CHECK(content_of(directory / "campaign.md").find(std::string(" | ") + row.reason) != std::string::npos);
  }
}
