// Tests a short fault campaign: some cases with the flashed firmware, and the campaign commands.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include "boards/stm32f405/core/exception_numbers.hpp"
#include "host/client/firmware_update/image.hpp"
#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/expected.hpp"
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

/// Result of a case. A case that several tests need is run only once, because its result is always the same.
const Result& result_of(const std::string& name) {
  static std::map<std::string, Result> results;
  CAPTURE(name);
  if (!results.contains(name)) results[name] = campaign::run_case(campaign::case_named(name));
  const Result& result = results.at(name);
  INFO("error: ", result.error);
  REQUIRE(result.error.empty());
  return result;
}

/// Energy exchange of a moving arm without a fault.
void check_sample(bool (*is_chosen)(const campaign::Expected&)) {
  for (const campaign::Expected& expected : campaign::expected_cases()) {
    if (!expected.is_in_sample || !is_chosen(expected)) continue;
    const std::string name(expected.name);
    CAPTURE(name);
    const Result& result = result_of(name);
    const std::string fault_free = campaign::fault_free_name(campaign::case_named(name));
    const auto found =
        campaign::deviations(expected, result, fault_free.empty() ? 0.0 : result_of(fault_free).energy_J);
    INFO(fmt::format("{}", fmt::join(found, " ")));
    CHECK(found.empty());
  }
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

TEST_CASE("a rising, falling or limited force exceeds the force limit by at most 5 %") {
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

TEST_CASE(
    "self-test pulses without a fault finish normally, and the pulses of motor 2 detect a fault from the pulses of "
    "motor 1") {
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
  REQUIRE(campaign::regain_force(board));
  board.run(0.3);
  board.command(protocol::Command::disable_force);
  REQUIRE(board.wait_for(protocol::State::landing, 0.1));
  CHECK(campaign::regain_force(board));
  CHECK(board.force_is_on());
  CHECK_FALSE(board.is(protocol::State::landing));
}

TEST_CASE("a fault with a slowly disappearing cause is cleared repeatedly, as by a user") {
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
  CHECK(campaign::regain_force(board));
}

TEST_CASE("the use after a case detects a stuck encoder, and reports no fault of a healthy arm") {
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

TEST_CASE("electrical faults that the firmware detects switch the bridges off within two control periods") {
  check_sample(
      [](const campaign::Expected& expected) { return expected.longest_off_periods <= campaign::quick_periods; });
}

TEST_CASE("a broken wire of the supply divider is a low supply after its capacitor is discharged") {
  const Result result = result_of("wire_open:supply wall 2");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 30 * control_period_s);
  CHECK(result.detected_as == protocol::Fault::supply_low);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a motor with an implausible voltage is switched off before the hand feels more than the permitted force") {
  check_sample(
      [](const campaign::Expected& expected) { return expected.longest_off_periods > campaign::quick_periods; });
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

TEST_CASE("wrong local models leave the force on and within its limit") {
  for (const char* name : {"models_lost rest 1", "models_contradictory wall 1"}) {
    const Result result = result_of(name);
    CHECK_FALSE(result.off_after_s);
    CHECK(result.detected_as == protocol::Fault::none);
    CHECK(result.peak_force_N > 0.7);  // 0.54 N without models
    CHECK(result.peak_force_N < 1.05 * result.force_limit_N);
    CHECK(result.energy_J < 0.01);
    CHECK(result.recovery == Recovery::none_needed);
  }
}

TEST_CASE("an unplugged cable or a suspended bus switches the force off within 5 ms and raises usb_gone") {
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

TEST_CASE("a main loop that stalls for 12 ms switches the force off with a fault and continues without a restart") {
  const Result result = result_of("main_loop_stalled=0.012 wall 1");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 0.0105);
  CHECK(result.detected_as == protocol::Fault::main_loop_stalled);
  CHECK(result.restarts == 0);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a board without converter interrupts is restarted by the watchdog, and the fault is reported") {
  const Result result = result_of("adc_stopped:1 wall 2");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 2 * control_period_s);  // without the control interrupt there is no heartbeat
  CHECK(result.restarts >= 1);                        // repeatedly while the cause lasts
  CHECK(result.detected_as == protocol::Fault::watchdog);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("a failing 3.3 V supply resets the chip and is reported after the restart") {
  const Result result = result_of("logic_sag wall 1");
  REQUIRE(result.off_after_s);
  CHECK(*result.off_after_s < 2 * control_period_s);
  CHECK(result.restarts >= 1);
  CHECK_FALSE(result.locked_up);
  CHECK(result.detected_as == protocol::Fault::logic_supply_low);
  CHECK(result.recovery == Recovery::clear_fault);
}

TEST_CASE("the campaign measures the energy of the use after a fault-free case") {
  const Result fault_free = result_of("none rest 1");
  CHECK(fault_free.energy_in_use_J.value_or(0.0) > 0.01);
  CHECK(fault_free.energy_in_use_J.value_or(0.0) > fault_free.energy_J);
}

TEST_CASE("without force nothing goes on, and the arm finds its reference in the inkwell afterwards") {
  const Result result = result_of("encoder_slip:2=400 unreferenced 1");
  CHECK_FALSE(result.bridges_were_on);
  CHECK_FALSE(result.bridges_went_on);
  CHECK_FALSE(result.off_after_s);
  CHECK(result.position_error_m.value() < 0.0005);
}

TEST_CASE("the first of two faults is reported until it is cleared, or is in the black box after a restart") {
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

TEST_CASE("a board with a fault still reaches its boot loader, and the firmware reports the fault afterwards") {
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

TEST_CASE("the board reports a fault that exists at power-on or occurs during start-up") {
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

TEST_CASE("a hand that moves the arm too fast raises over_speed, feels less than without a force, and can continue") {
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
  const auto c = campaign::case_named("encoder_lost_counts:2=0.1 motion 2");
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

TEST_CASE("a location that the seed chose is printed with the case") {
  const TemporaryDirectory directory;
  const auto c = campaign::case_named("ram_bit unreferenced 1");
  const auto run = run_program("inkwell-lab", {"campaign", "run", std::to_string(c.number), "--out", directory.path()});
  CHECK(run.exit_code == 0);
  const auto results = campaign::load_all(directory.path());
  REQUIRE(results.size() == 1);
  CHECK(results[0].location.starts_with("0x"));
  CHECK(run.out.find("ram_bit unreferenced 1 at " + results[0].location + ": ") != std::string::npos);
}

TEST_CASE("campaign list prints text or numbers, and an unknown case is refused") {
  const auto numbers = run_program("inkwell-lab", {"campaign", "list", "--numbers"});
  CHECK(numbers.exit_code == 0);
  CHECK(std::ranges::count(numbers.out, '\n') == static_cast<std::ptrdiff_t>(campaign::all_cases().size()));
  CHECK(run_program("inkwell-lab", {"campaign", "list"}).out.find("    1 none unreferenced 1\n") != std::string::npos);
  const auto none = run_program("inkwell-lab", {"campaign", "run", "999999"});
  CHECK(none.exit_code == 2);
  CHECK(none.err.find("There is no case 999999") != std::string::npos);
}

TEST_CASE("the sample has each detection, most injected faults, and each of three equivalent parts") {
  std::set<protocol::Fault> detections, in_sample;
  std::set<protocol::InjectedFault> injected, injected_in_sample;
  std::set<char> motors;
  for (const campaign::Expected& expected : campaign::expected_cases()) {
    const campaign::CaseFault put_in = campaign::case_named(expected.name).fault;
    const protocol::InjectedFault fault = put_in.fault.value();
    detections.insert(expected.detected_as);
    injected.insert(fault);
    if (!expected.is_in_sample) continue;
    in_sample.insert(expected.detected_as);
    injected_in_sample.insert(fault);
    if (const auto location = protocol::info(fault).location;
        location == protocol::InjectionLocation::motor || location == protocol::InjectionLocation::leg)
      motors.insert(put_in.of[0]);
  }
  CHECK(in_sample == detections);
  CHECK(injected_in_sample.size() * 2 > injected.size());
  CHECK(motors == std::set{'1', '2', '3'});
}

TEST_CASE("a check of a case with a known detection names each difference") {
  const campaign::Expected& expected = campaign::expected_cases().front();
  const campaign::Case the_case = campaign::case_named(expected.name);
  Result result{
      .number = the_case.number, .fault = the_case.fault, .situation = the_case.situation, .phase = the_case.phase};
  result.off_after_s = control_period_s;
  result.detected_as = expected.detected_as;
  result.force_limit_N = 3.3;
  result.recovery = Recovery::clear_fault;
  result.position_error_m = 0.0;
  CHECK(campaign::deviations(expected, result, 0.0).empty());
  const auto differs = [&](auto change, const char* text) {
    Result other = result;
    change(other);
    const auto found = campaign::deviations(expected, other, 0.0);
    REQUIRE(found.size() == 1);
    CHECK(found[0].find(text) != std::string::npos);
  };
  differs([](Result& other) { other.off_after_s = std::nullopt; }, "did not switch off");
  differs([](Result& other) { other.off_after_s = 2 * control_period_s; }, "after 2.0 control periods");
  differs([](Result& other) { other.detected_as = protocol::Fault::none; }, "`none` instead of");
  differs([](Result& other) { other.peak_force_N = 3.5; }, "3.50 N");
  differs([](Result& other) { other.energy_J = 0.02; }, "20.0 mJ");
  differs([](Result& other) { other.recovery = Recovery::board_reset; }, "`board reset`");
  differs([](Result& other) { other.position_error_m = 0.002; }, "2.00 mm");
  differs([](Result& other) { other.error = "The board did not start."; }, "did not start");
}
