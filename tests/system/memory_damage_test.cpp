// What the firmware does when a bit of it, or of its parameters, has changed by itself.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <control/settings.hpp>
#include <protocol/parameters.hpp>

#include "firmware_image.hpp"
#include "hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::State;

namespace {

std::string text_of(std::uint32_t address) { return std::to_string(address); }

bool is_in_fault(const protocol::PoseReport& pose) { return pose.state == State::fault; }

/// A bit of each place flips under a pressing hand.
void check_found_and_written_anew(const std::vector<std::uint32_t>& places, int bit) {
  BoardRig rig;
  press_into_wall(rig);
  for (const std::uint32_t address : places)
    rig.control.inject({"ram_bit", text_of(address), static_cast<double>(bit)});
  rig.run_until(is_in_fault);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  CHECK_FALSE(bridges_enabled(rig.control));

  // It is as damaged as before: the fault can not be cleared.
  rig.command(protocol::Command::clear_fault);
  rig.run(0.05);
  CHECK(rig.pose().state == State::fault);

  rig.control.reset();
  reconnect(rig);
  rig.run_until([](const auto& pose) { return pose.state == State::unreferenced; });
}

}  // namespace

TEST_CASE("a bit that flips in what the interrupts run from switches the force off, and a reset writes it anew") {
  // Each where nothing is read or run meanwhile: it is to be found before it does harm.
  constexpr std::uint32_t memory_management_vector = 0x10;
  const std::uint32_t places[] = {firmware_symbol("interrupt_vectors") + memory_management_vector,
                                  firmware_symbol("leave_out"), firmware_symbol("nowhere")};
  for (const std::uint32_t address : places) {
    CAPTURE(address);
    check_found_and_written_anew({address}, 7);
  }
}

TEST_CASE("a bit that flips in the settings switches the force off, and a reset prepares them anew") {
  // The link begins with the parameters and the two places of the settings, of which the interrupt uses one.
  const std::uint32_t settings = firmware_symbol("host_link") + sizeof(protocol::ParameterSet);
  constexpr std::uint32_t bytes = sizeof(control::Settings);
  // The last bit of a limit that is far away: it is to be found before it does harm.
  constexpr std::uint32_t limit =
      offsetof(control::Settings, limits) + offsetof(control::Limits, speed_limit_squared_m2_per_s2);
  check_found_and_written_anew({settings + limit, settings + bytes + limit}, 0);
}

TEST_CASE("a flash that is damaged when the board starts is found before the first pulse, and before the main loop") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == State::ready; });  // the self-test has driven the bridges
  // The last word that is looked at: the check in the main loop alone would take too long to come to it.
  rig.control.inject({"flash_bit", text_of(firmware_symbol("image_check")), 0});
  const double reset_s = rig.board_time_s();
  rig.control.reset();
  reconnect(rig);
  rig.run(0.3);  // a round of the check is over by then, and so would be a self-test
  CHECK(rig.pose().fault == Fault::memory_damaged);
  const double driven_until_s = rig.control.truth().at("bridges_driven_until_s").get<double>();
  CHECK(driven_until_s > 0.0);
  CHECK(driven_until_s < reset_s);
  const auto box = rig.device->black_box();
  CHECK(box.fault == Fault::memory_damaged);
  CHECK(box.rows_before == 0);  // of the 1.5 ms that the main loop looks back to as it begins
}

TEST_CASE("a bit that flips in the flash switches the force off, and no reset brings it back while it is wrong") {
  BoardRig rig;
  press_into_wall(rig);
  const std::uint32_t address = firmware_symbol("start_boot_loader");
  rig.control.inject({"flash_bit", text_of(address), 0});
  rig.run_until(is_in_fault);
  CHECK(rig.pose().fault == Fault::memory_damaged);
  CHECK_FALSE(bridges_enabled(rig.control));
  check_tells(told_by_info(rig), Fault::memory_damaged);

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
