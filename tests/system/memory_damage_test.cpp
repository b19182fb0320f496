// Tests the reaction of the firmware to bit errors in its code or parameters.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/control/settings.hpp"
#include "firmware/store/parameter_store.hpp"
#include "protocol/parameters.hpp"
#include "protocol/store.hpp"

#include "tests/system/firmware_image.hpp"
#include "tests/system/hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::Parameter;
using protocol::State;

namespace {

std::string text_of(std::uint32_t address) { return std::to_string(address); }

bool is_in_fault(const device::Pose& pose) { return pose.state == State::fault; }

/// Flips one bit per address while a hand presses the stylus.
void check_found_and_written_anew(const std::vector<std::uint32_t>& addresses, int bit) {
  BoardRig rig;
  press_into_wall(rig);
  for (const std::uint32_t address : addresses)
    rig.control.inject({"ram_bit", text_of(address), static_cast<double>(bit)});
  rig.run_until(is_in_fault);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  CHECK_FALSE(bridges_enabled(rig.control));

  // The fault cannot be cleared, because the damage remains.
  rig.command(protocol::Command::clear_fault);
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);

  rig.control.reset();
  reconnect(rig);
  rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
}

/// Offset of a byte in the force limit. A flip of the byte's exponent bit doubles or halves the force limit.
constexpr std::uint32_t byte_of_force_limit = sizeof(float) * static_cast<std::uint32_t>(Parameter::force_limit_N) + 2;

/// The current parameters are the first member of the link object. The next member after the ParameterStore contains
/// the stored parameters.
std::uint32_t held_force_limit() { return firmware_symbol("host_link") + byte_of_force_limit; }
std::uint32_t stored_force_limit() { return held_force_limit() + std::uint32_t{sizeof(link::ParameterStore)}; }

}  // namespace

TEST_CASE("a bit flip in the code or vectors of interrupts switches the force off, and a reset restores the memory") {
  // The firmware does not use these memory addresses while the hand presses the stylus. The memory check detects each
  // error before the error has an effect.
  constexpr std::uint32_t memory_management_vector = 0x10;
  const std::uint32_t addresses[] = {firmware_symbol("interrupt_vectors") + memory_management_vector,
                                     firmware_symbol("remove_idle_torque"), firmware_symbol("wall_normals")};
  for (const std::uint32_t address : addresses) {
    CAPTURE(address);
    check_found_and_written_anew({address}, 7);
  }
}

TEST_CASE("a bit flip in the settings switches the force off, and a reset prepares the settings again") {
  // Two copies of the settings follow the parameters in memory.
  const std::uint32_t settings = firmware_symbol("host_link") + sizeof(link::Guarded<protocol::ParameterSet>);
  constexpr std::uint32_t bytes = sizeof(control::Settings);
  // The flipped bit belongs to a limit that is not reached, so the flip has no other effect.
  constexpr std::uint32_t limit =
      offsetof(control::Settings, limits) + offsetof(control::Limits, speed_limit_squared_m2_per_s2);
  check_found_and_written_anew({settings + limit, settings + bytes + limit}, 0);
}

TEST_CASE("a bit flip in a parameter that no code reads switches the force off, and a reset restores the parameter") {
  check_found_and_written_anew({held_force_limit()}, 7);
}

TEST_CASE("a parameter of which a bit has flipped is neither taken over nor stored") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  const float force_limit_N = rig.device->parameters()[Parameter::force_limit_N];
  rig.control.inject({"ram_bit", text_of(held_force_limit()), 7});
  const float damaged_N = rig.device->parameters()[Parameter::force_limit_N];
  CHECK((damaged_N == 2.0f * force_limit_N || damaged_N == 0.5f * force_limit_N));
  SUBCASE("by a transaction of another parameter") {
    CHECK_THROWS_AS(rig.set({{Parameter::wall_damping_Ns_per_m, 1.0f}}), device::Refused);
  }
  SUBCASE("with all other parameters") {
    rig.command(protocol::Command::store_parameters);
    rig.run(0.02);
    CHECK(rig.device->store_report().result == protocol::StoreResult::flash_failed);
  }
  SUBCASE("nor hidden by the defaults") { CHECK_THROWS_AS(rig.device->restore_default_parameters(), device::Refused); }
  rig.run_until(is_in_fault, 0.5);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  CHECK(rig.device->store_report().records_written == 0);

  rig.control.reset();
  reconnect(rig);
  CHECK(rig.device->parameters()[Parameter::force_limit_N] == force_limit_N);
}

TEST_CASE("a bit flip in the RAM copy of the stored parameters raises a fault, and this copy cannot be restored") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  rig.command(protocol::Command::store_parameters);
  while (rig.device->store_report().contents != protocol::StoreContents::parameters) rig.run(0.02);
  const float force_limit_N = rig.device->parameters()[Parameter::force_limit_N];
  rig.control.inject({"ram_bit", text_of(stored_force_limit()), 7});
  CHECK(rig.device->stored_parameters()[Parameter::force_limit_N] != force_limit_N);
  CHECK_THROWS_WITH_AS(rig.device->restore_stored_parameters(),
                       doctest::Contains(protocol::info(protocol::Refusal::busy).cause), device::Refused);
  CHECK(rig.device->parameters()[Parameter::force_limit_N] == force_limit_N);
  rig.run_until(is_in_fault, 0.5);
  CHECK(rig.pose().fault == Fault::memory_damaged);
}

TEST_CASE("a flash that is damaged when the board starts is found before the first pulse, and before the main loop") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });  // the self-test has driven the bridges
  // Damages the last word that the firmware checks. The main loop's check alone would detect this error too late.
  rig.control.inject({"flash_bit", text_of(firmware_symbol("image_check")), 0});
  const double reset_s = rig.board_time_s();
  rig.control.reset();
  reconnect(rig);
  rig.run(0.3);  // by this time one round of the check and a self-test would be over
  CHECK(rig.pose().fault == Fault::memory_damaged);
  const double driven_until_s = rig.control.truth().at("bridges_driven_until_s").get<double>();
  CHECK(driven_until_s > 0.0);
  CHECK(driven_until_s < reset_s);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::memory_damaged);
  CHECK(box.rows_before == 0);  // of the 1.5 ms that the main loop records at its start
}

TEST_CASE("a bit that flips in the flash switches the force off, and no reset brings it back while it is wrong") {
  BoardRig rig;
  press_into_wall(rig);
  const std::uint32_t address = firmware_symbol("start_boot_loader");
  rig.control.inject({"flash_bit", text_of(address), 0});
  rig.run_until(is_in_fault);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  CHECK_FALSE(bridges_enabled(rig.control));
  check_reports(reported_by_info(rig), Fault::memory_damaged);

  rig.control.reset();
  rig.control.dock(true);
  reconnect(rig);
  rig.run_until(is_in_fault);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  rig.command(protocol::Command::clear_fault);
  rig.command(protocol::Command::enable_force);
  rig.run(0.3);
  CHECK(rig.pose().state == State::fault);
  CHECK_FALSE(any_leg_high_within(rig.control, control_period_s));

  rig.control.heal("flash_bit");
  rig.control.reset();
  reconnect(rig);
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });
}
