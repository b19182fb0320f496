// Tests a short fault campaign: some cases with the flashed firmware, and the campaign commands.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include "boards/stm32f405/core/exception_numbers.hpp"
#include "host/client/firmware_update/image.hpp"
#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/handling.hpp"
#include "host/lab/campaign/result.hpp"
#include "host/lab/campaign/run.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/system/hazards.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using campaign::NoticedInUse;
using campaign::Recovery;
using campaign::Result;

namespace {

campaign::Case the_case(const std::string& name) {
  for (const auto& c : campaign::all_cases())
    if (c.name() == name) return c;
  FAIL("there is no case ", name);
  return {};
}

Result result_of(const std::string& name) {
  CAPTURE(name);
  const Result result = campaign::run_case(the_case(name));
  INFO("error: ", result.error);
  REQUIRE(result.error.empty());
  return result;
}

/// Energy exchange of an arm in motion without a fault.
double energy_without_fault_J(const Result& result) {
  if (result.situation != campaign::CaseSituation::motion) return 0.0;
  return result_of(fmt::format("none motion {}", result.phase)).energy_J;
}

}  // namespace

TEST_CASE("without a fault the hand feels the wall and nothing happens") {
  const Result result = result_of("none wall 1");
  CHECK(result.bridges_were_on);
  CHECK_FALSE(result.off_after_s);
  CHECK(result.detected_as == protocol::Fault::none);
  CHECK(result.peak_force_N == doctest::Approx(0.75 * result.force_limit_N).epsilon(0.05));
  CHECK(result.travel_m < 0.001);
  CHECK(result.recovery == Recovery::none_needed);
  CHECK(result.position_error_m.value() < 0.0005);
}

TEST_CASE("the force that rises, falls or is held back is less than, or as much as, the force limit") {
  for (const auto& [name, least, most] :
       {std::tuple{"none ramping 1", 0.1, 0.7}, {"none limited 1", 0.9, 1.05}, {"none landing 1", 0.1, 0.76}}) {
    const Result result = result_of(name);
    CHECK(result.bridges_were_on);
    CHECK_FALSE(result.off_after_s);
    CHECK(result.detected_as == protocol::Fault::none);
    CHECK(result.peak_force_N > least * result.force_limit_N);
    CHECK(result.peak_force_N < most * result.force_limit_N);
    CHECK(result.recovery == Recovery::none_needed);
    CHECK(result.peak_force_in_use_N.has_value() == (result.situation != campaign::CaseSituation::landing));
  }
}

TEST_CASE("the self-test's pulses end by themselves, and the second motor's find what came during the first's") {
  const Result fault_free = result_of("none testing 1");
  CHECK(fault_free.bridges_were_on);
  CHECK(fault_free.off_after_s.value() > 0.0095);  // the remaining pulses of the self-test
  CHECK(fault_free.off_after_s.value() < 0.014);
  CHECK(fault_free.detected_as == protocol::Fault::none);
  CHECK(fault_free.recovery == Recovery::none_needed);
  const Result open = result_of("motor_open:2 testing 1");
  CHECK(open.detected_as == protocol::Fault::self_test_failed);
  CHECK(open.recovery == Recovery::clear_fault);
}

TEST_CASE("a force that is falling is switched on again before it counts as regained") {
  campaign::BoardRun board({.real_time = false, .paused = true});
  REQUIRE(board.connect(1.0));
  board.set({{protocol::Parameter::host_timeout_s, 2.0f}, {protocol::Parameter::soft_landing_s, 1.0f}});
  REQUIRE(board.wait_for(protocol::State::ready, 1.0));
  REQUIRE(campaign::regains_force(board));
  board.run(0.3);
  board.command(protocol::Command::disable_force);
  REQUIRE(board.wait_for(protocol::State::landing, 0.1));
  CHECK(campaign::regains_force(board));
  CHECK(board.force_is_on());
  CHECK_FALSE(board.is(protocol::State::landing));
}

TEST_CASE("a fault whose cause takes a while to go is cleared again, as a user does") {
  campaign::BoardRun board({.real_time = false, .paused = true});
  REQUIRE(board.connect(1.0));
  board.set({{protocol::Parameter::host_timeout_s, 2.0f}});
  REQUIRE(board.wait_for(protocol::State::ready, 1.0));
  board.control().inject({.fault = "supply_spike", .for_s = 0.005});
  REQUIRE(board.wait_for(protocol::State::fault, 0.1));
  CHECK(board.pose()->fault == protocol::Fault::supply_high);
  board.run(0.02);
  board.command(protocol::Command::clear_fault);
  CHECK_FALSE(board.wait_for(protocol::State::ready, 0.05));  // the bulk capacitor is still above the threshold
  CHECK(campaign::regains_force(board));
}

TEST_CASE("what is not noticed is used on: a stuck encoder is told then, a sound arm bears it") {
  const Result stuck = result_of("encoder_stuck:2 rest 1");
  CHECK(stuck.detected_as == protocol::Fault::none);
  CHECK(stuck.noticed_in_use_as == NoticedInUse{NoticedInUse::By::fault, protocol::Fault::motor_implausible});
  CHECK(stuck.noticed_in_use_s.value() < 1.5);
  CHECK(stuck.recovery == Recovery::clear_fault);
  CHECK(stuck.fault_on_healing == protocol::Fault::none);
  const Result fault_free = result_of("none motion 3");
  CHECK(fault_free.noticed_in_use_as == NoticedInUse{});
  CHECK_FALSE(fault_free.noticed_in_use_s);
  CHECK(fault_free.peak_force_in_use_N.value() == doctest::Approx(fault_free.force_limit_N).epsilon(0.1));
}

TEST_CASE("the interrupts that are lost and late in the campaign are those that the firmware has a handler of") {
  const auto image = firmware_update::read_image(build_directory() + "/../board/inkwell.elf");
  const auto vector = [&](unsigned exception) {
    std::uint32_t address = 0;
    for (unsigned byte = 0; byte < 4; ++byte)
      address |= std::to_integer<std::uint32_t>(image.at(0x0800'0000 + 4 * exception + byte).value()) << 8 * byte;
    return address;
  };
  constexpr unsigned hard_fault = 3;
  std::set<std::string> handled, tried;
  for (unsigned exception = hard_fault; exception < virtual_board::exception_numbers; ++exception)
    if (vector(exception) != vector(hard_fault)) handled.insert(std::to_string(exception));
  for (const auto& fault : campaign::case_faults())
    if (fault.fault == protocol::InjectedFault::exception_lost) tried.insert(fault.of);
  CHECK(handled.contains("34"));
  CHECK(tried == handled);
}

TEST_CASE("electrical faults that the firmware knows take the bridges off within two control periods") {
  struct Known {
    const char* name;
    protocol::Fault detected_as;
  };
  for (const Known& known : {Known{"wire_low:bridge_fault_tim1 rest 2", protocol::Fault::bridge_fault},
                             {"shunt_high:2 wall 1", protocol::Fault::over_current},
                             {"wire_low:motor_current[1] motion 3", protocol::Fault::over_current},
                             {"leg_low:2A motion 1", protocol::Fault::bridge_fault},
                             {"leg_high:1B limited 3", protocol::Fault::bridge_fault},
                             {"shunt_high:3 wall 2", protocol::Fault::over_current},
                             {"motor_open:2 wall 1", protocol::Fault::current_jump},
                             {"leg_open:2A wall 1", protocol::Fault::current_jump},
                             {"wire_open:bridges[1].leg_a wall 2", protocol::Fault::current_jump},
                             {"wire_low:bridges[1].leg_a motion 1", protocol::Fault::current_jump},
                             {"wire_open:motor_current[1] rest 1", protocol::Fault::current_jump},
                             {"wire_open:motor_current[1] limited 1", protocol::Fault::current_jump},
                             {"wire_open:motor_current[1] motion 2", protocol::Fault::current_jump},
                             {"shunt_gain:2 wall 3", protocol::Fault::current_jump},
                             {"shunt_gain:2=2 wall 1", protocol::Fault::current_jump},
                             {"shunt_offset:2 limited 1", protocol::Fault::current_jump},
                             {"wires_shorted:motor_current[1]+motor_current[2] wall 2", protocol::Fault::current_jump},
                             {"adc_stopped:2 wall 1", protocol::Fault::samples_stale},
                             {"adc_stopped:3 motion 2", protocol::Fault::samples_stale}}) {
    CAPTURE(known.name);
    const Result result = result_of(known.name);
    REQUIRE(result.off_after_s);
    CHECK(*result.off_after_s < 2 * control_period_s);
    CHECK(result.detected_as == known.detected_as);
    CHECK(result.peak_force_N < 1.05 * result.force_limit_N);
    CHECK(result.energy_J < energy_without_fault_J(result) + 0.01);
    CHECK(result.recovery == Recovery::clear_fault);
    CHECK(result.position_error_m.value() < 0.0015);  // the newest pose may be one millisecond old
  }
}

TEST_CASE("the wire of the supply's divider that breaks is a supply far too low, as soon as its capacitor is empty") {
  const Result result = result_of("wire_open:supply wall 2");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 30 * control_period_s);
  CHECK(result.detected_as == protocol::Fault::supply_low);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a motor that does not do as its voltage says is let go of before the hand feels more than it may") {
  struct Known {
    const char* name;
    int periods;  ///< large where the current drifts from a frozen reading that was initially correct
  };
  for (const Known& known : {Known{"wires_shorted:bridges[1].leg_a+bridges[1].leg_b wall 2", 40},
                             {"shunt_frozen:2 wall 3", 4000},
                             {"motor_shorted:2 wall 1", 2000}}) {
    CAPTURE(known.name);
    const Result result = result_of(known.name);
    REQUIRE(result.off_after_s);
    CHECK(*result.off_after_s < known.periods * control_period_s);
    // Depending on the time of the fault, a current jump may be detected first.
    CHECK((result.detected_as == protocol::Fault::motor_implausible ||
           result.detected_as == protocol::Fault::current_jump));
    CHECK(result.peak_force_N < 1.05 * result.force_limit_N);
    CHECK(result.energy_J < energy_without_fault_J(result) + 0.01);
    CHECK(result.recovery == Recovery::clear_fault);
  }
}

TEST_CASE(
    "a reading that freezes while the limit holds the force makes no more of it, and is noticed by the next press") {
  for (const char* name : {"wire_frozen:motor_current[1] limited 1", "shunt_frozen:2 limited 1"}) {
    CAPTURE(name);
    const Result result = result_of(name);
    CHECK(result.peak_force_N < 1.02 * result.force_limit_N);
    CHECK((result.detected_as == protocol::Fault::motor_implausible ||
           result.noticed_in_use_as == NoticedInUse{NoticedInUse::By::fault, protocol::Fault::motor_implausible}));
    CHECK(result.peak_force_in_use_N.value_or(0.0) < 1.02 * result.force_limit_N);
    CHECK(result.recovery == Recovery::clear_fault);
  }
}

TEST_CASE("a core, or a control interrupt, that stops lets go of the bridges within two control periods") {
  for (const char* name : {"core_stalled wall 1", "core_stalled motion 2", "exception_lost:34 wall 3"}) {
    const Result result = result_of(name);
    REQUIRE(result.off_after_s);
    CHECK(*result.off_after_s < 2 * control_period_s);
    CHECK(result.detected_as == protocol::Fault::watchdog);
  }
}

TEST_CASE("a cable that is pulled and a bus that is suspended take the force away at once, and the board tells so") {
  for (const char* name : {"usb_cut wall 1", "bus_suspended motion 2"}) {
    CAPTURE(name);
    const Result result = result_of(name);
    REQUIRE(result.off_after_s);
    CHECK(*result.off_after_s < 0.005);  // 3 ms of silence on the bus count as a disconnection
    CHECK(result.detected_as == protocol::Fault::usb_gone);
    CHECK(result.recovery == Recovery::clear_fault);
    CHECK(result.peak_force_N < 1.05 * result.force_limit_N);
  }
  CHECK_FALSE(campaign::is_detected(result_of("bus_suspended ready 1")));
}

TEST_CASE("a hand that swings the arm while the host falls silent or the core is halted feels no more than it may") {
  for (const char* name : {"host_silent motion 1", "core_halted motion 1", "core_halted motion 3"}) {
    const Result result = result_of(name);
    CHECK(result.off_after_s);
    CHECK(result.peak_force_N < 1.05 * result.force_limit_N);
  }
}

TEST_CASE("a main loop that stands for a while takes the force away and is told, and goes on without a restart") {
  const Result result = result_of("main_loop_stalled=0.012 wall 1");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 0.0105);
  CHECK(result.detected_as == protocol::Fault::main_loop_stalled);
  CHECK(result.restarts == 0);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a chip that no longer hears its converters is restarted by the watchdog, and tells so") {
  const Result result = result_of("adc_stopped:1 wall 2");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 2 * control_period_s);  // without the control interrupt there is no heartbeat
  CHECK(result.restarts >= 1);                        // repeatedly while the cause lasts
  CHECK(result.detected_as == protocol::Fault::watchdog);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a supply of the chip that fades holds it in reset, as on a flashed board, and is told once it is back") {
  const Result result = result_of("logic_sag wall 1");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 2 * control_period_s);
  CHECK(result.restarts >= 1);
  CHECK_FALSE(result.locked_up);
  CHECK(result.detected_as == protocol::Fault::logic_supply_low);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("what an unnoticed fault gives the hand in use is measured, and for a sound arm, too") {
  const Result fault_free = result_of("none rest 1");
  CHECK(fault_free.energy_in_use_J.value_or(0.0) > 0.01);
  CHECK(fault_free.energy_in_use_J.value_or(0.0) > fault_free.energy_J);
}

TEST_CASE("without force nothing goes on, and the arm finds its place in the inkwell afterwards") {
  const Result result = result_of("encoder_slip:2=400 unreferenced 1");
  CHECK_FALSE(result.bridges_were_on);
  CHECK_FALSE(result.bridges_went_on);
  CHECK_FALSE(result.off_after_s);
  CHECK(result.position_error_m.value() < 0.0005);
}

TEST_CASE("a fault that is told stays told, and the next one is told once it is cleared; the black box keeps it else") {
  const Result tripped = result_of("bridge_fault fault 1");
  CHECK(tripped.told_before == protocol::Fault::host_silent);
  CHECK(tripped.first_fault == campaign::FirstFault::reported);
  CHECK(tripped.detected_as == protocol::Fault::none);
  CHECK(tripped.told_once_cleared == protocol::Fault::bridge_fault);
  CHECK_FALSE(tripped.bridges_were_on);
  CHECK_FALSE(tripped.bridges_went_on);
  CHECK(tripped.fault_on_healing == protocol::Fault::none);
  CHECK(tripped.recovery == Recovery::clear_fault);
  const Result fault_free = result_of("none fault 1");
  CHECK(fault_free.first_fault == campaign::FirstFault::reported);
  CHECK_FALSE(campaign::is_detected(fault_free));
  CHECK(fault_free.recovery == Recovery::none_needed);
  const Result restarted = result_of("core_stalled fault 1");
  CHECK(restarted.first_fault == campaign::FirstFault::black_box);
  CHECK(restarted.detected_as == protocol::Fault::watchdog);
  CHECK(restarted.restarts == 1);
  const Result unheard = result_of("usb_cut fault 1");
  CHECK(unheard.first_fault == campaign::FirstFault::reported);
  CHECK(unheard.told_once_cleared == protocol::Fault::none);
  CHECK(result_of("bus_suspended fault 1").told_once_cleared == protocol::Fault::none);
}

TEST_CASE("a board on the way to its boot loader gets there, and its firmware tells afterwards what broke meanwhile") {
  const Result fault_free = result_of("none update 1");
  CHECK_FALSE(fault_free.missed_boot_loader);
  CHECK_FALSE(campaign::is_detected(fault_free));
  CHECK_FALSE(fault_free.bridges_went_on);
  CHECK(fault_free.recovery == Recovery::none_needed);
  const Result broken = result_of("wire_high:bridge_enable update 1");
  CHECK_FALSE(broken.missed_boot_loader);
  CHECK(broken.detected_as == protocol::Fault::bridge_wire);
  CHECK_FALSE(broken.bridges_went_on);
  CHECK(broken.recovery == Recovery::clear_fault);
  const Result stalled = result_of("core_stalled update 1");
  CHECK(stalled.missed_boot_loader);
  CHECK(stalled.restarts == 1);
  CHECK(stalled.detected_as == protocol::Fault::watchdog);
  const Result unplugged = result_of("usb_cut update 1");  // the boot loader appears once the cable is connected again
  CHECK_FALSE(unplugged.missed_boot_loader);
  CHECK_FALSE(campaign::is_detected(unplugged));
  CHECK(unplugged.recovery == Recovery::none_needed);
}

TEST_CASE("what is broken before the power comes, or breaks while the board starts, is told by it") {
  for (const char* name : {"none starting 1", "none starting 2", "none starting 3"}) {
    CAPTURE(name);
    const Result fault_free = result_of(name);
    CHECK(fault_free.bridges_were_on == (name == std::string_view("none starting 2")));  // pulses of the self-test
    CHECK_FALSE(fault_free.bridges_went_on);                                             // except for the pulses of the
                                                                                         // self-test
    CHECK_FALSE(campaign::is_detected(fault_free));
    CHECK(fault_free.peak_force_N < 1);
    CHECK(fault_free.recovery == Recovery::none_needed);
  }
  CHECK(result_of("none starting 1").injected_at_s == 0);
  CHECK(result_of("motor_open:2 starting 1").detected_as == protocol::Fault::self_test_failed);
  const Result late = result_of("wire_high:bridge_enable starting 2");
  CHECK(late.injected_at_s > 0.01);
  CHECK(late.detected_as == protocol::Fault::bridge_wire);
  CHECK(late.recovery == Recovery::clear_fault);
}

TEST_CASE("a hand that flings the arm is told it was too fast, feels no more than without a force, and may go on") {
  const Result free = result_of("fast_hand ready 1");
  CHECK_FALSE(campaign::is_detected(free));
  for (const char* name : {"fast_hand rest 1", "fast_hand wall 1", "fast_hand motion 1"}) {
    const Result flung = result_of(name);
    CHECK(flung.off_after_s.has_value());
    CHECK(flung.detected_as == protocol::Fault::over_speed);
    CHECK(flung.recovery == Recovery::clear_fault);
    CHECK(flung.peak_force_N < free.peak_force_N);
    CHECK(flung.position_error_m.value() < 0.0005);
  }
}

TEST_CASE("a case is the same wherever it runs: two runs give one result") {
  const TemporaryDirectory directory;
  const auto c = the_case("encoder_lost_counts:2=0.1 motion 2");
  const Result here = campaign::run_case(c);
  const auto run = run_program("inkwell-lab", {"campaign", "run", std::to_string(c.number), "--out", directory.path()});
  CHECK(run.exit_code == 0);
  const auto there = campaign::load_all(directory.path());
  REQUIRE(there.size() == 1);
  CHECK(campaign::text_of(there[0]) == campaign::text_of(here));

  const auto page = (directory / "page.md").string();
  const auto merged = run_program("inkwell-lab", {"campaign", "merge", directory.path(), "--page", page});
  CHECK(merged.exit_code == 0);
  CHECK(std::filesystem::exists(page));
  CHECK(std::filesystem::exists(directory / "page/off.svg"));
}

TEST_CASE("a place that the seed chose is told with the case") {
  const TemporaryDirectory directory;
  const auto c = the_case("ram_bit unreferenced 1");
  const auto run = run_program("inkwell-lab", {"campaign", "run", std::to_string(c.number), "--out", directory.path()});
  CHECK(run.exit_code == 0);
  const auto results = campaign::load_all(directory.path());
  REQUIRE(results.size() == 1);
  CHECK(results[0].place.starts_with("0x"));
  CHECK(run.out.find("ram_bit unreferenced 1 at " + results[0].place + ": ") != std::string::npos);
}

TEST_CASE("the list of the campaign is for people and for batch systems; a case that is none is refused") {
  const auto numbers = run_program("inkwell-lab", {"campaign", "list", "--numbers"});
  CHECK(numbers.exit_code == 0);
  CHECK(std::ranges::count(numbers.out, '\n') == static_cast<std::ptrdiff_t>(campaign::all_cases().size()));
  CHECK(run_program("inkwell-lab", {"campaign", "list"}).out.find("    1 none unreferenced 1\n") != std::string::npos);
  const auto none = run_program("inkwell-lab", {"campaign", "run", "999999"});
  CHECK(none.exit_code == 2);
  CHECK(none.err.find("There is no case 999999") != std::string::npos);
}
