// What the firmware does when a bit of it, or of its parameters, has changed by itself.
#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "firmware_image.hpp"
#include "hazards.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Fault;
using protocol::State;

namespace {

std::string text_of(std::uint32_t address) { return std::to_string(address); }

bool is_in_fault(const protocol::PoseReport& pose) { return pose.state == State::fault; }

}  // namespace

TEST_CASE("a bit that flips in what the interrupts run from switches the force off, and a reset writes it anew") {
  // Each where nothing is read or run meanwhile: it is to be found before it does harm.
  constexpr std::uint32_t memory_management_vector = 0x10;
  const std::uint32_t places[] = {firmware_symbol("interrupt_vectors") + memory_management_vector,
                                  firmware_symbol("write_brake"), firmware_symbol("nowhere")};
  for (const std::uint32_t address : places) {
    CAPTURE(address);
    BoardRig rig;
    press_into_wall(rig);
    rig.control.inject({"ram_bit", text_of(address), 7});
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
