#include "hazards.hpp"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include <doctest/doctest.h>

#include <device/fault_text.hpp>

#include "program.hpp"

namespace inkwell::tests {

using protocol::Parameter;
using protocol::State;

void reconnect(BoardRig& rig) {
  rig.device.reset();
  rig.control.run(0.02);  // long enough for the bus to see that the device is gone
  rig.connect();
}

bool any_leg_high(device::ControlClient& control) {
  const auto truth = control.truth();
  bool high = false;
  for (const auto& legs : truth.at("bridge_legs"))
    for (const auto& level : legs) high |= level == "high";
  return high;
}

bool any_leg_high_within(device::ControlClient& control, double time_s) {
  bool high = false;
  for (int i = 0; i < 20; ++i) {
    control.run(time_s / 20);
    high |= any_leg_high(control);
  }
  return high;
}

bool bridges_enabled(device::ControlClient& control) { return control.truth().at("bridges_enabled").get<bool>(); }

void press_into_wall(BoardRig& rig) {
  rig.make_active();
  rig.take_to(free_point_m);
  rig.set({{Parameter::box_minimum_z_m, -0.015f}});
  rig.run(0.1);
  REQUIRE(protocol::force_is_on(rig.pose().state));
  REQUIRE(largest_current_A(rig.control) > 0.1);
  REQUIRE(bridges_enabled(rig.control));
  REQUIRE(any_leg_high_within(rig.control, control_period_s));
}

std::string told_by_info(BoardRig& rig) {
  rig.device.reset();
  const auto result =
      run_program("inkwell", {"info", "--usbip", "127.0.0.1:" + std::to_string(rig.board.usbip_port())});
  CHECK(result.exit_code == 0);
  return result.out;
}

void check_tells(const std::string& text, protocol::Fault fault) {
  INFO("inkwell info: ", text);
  CHECK(text.find(device::fault_line(fault)) != std::string::npos);
}

std::uint32_t endless_loop_address() {
  constexpr std::string_view loop = "\xBF\xF3\x4F\x8F\xFC\xE7";
  std::ifstream file(build_directory() + "/../board/inkwell.elf", std::ios::binary);
  const std::string image{std::istreambuf_iterator<char>(file), {}};
  Elf32_Ehdr header;
  REQUIRE(image.size() > sizeof header);
  std::memcpy(&header, image.data(), sizeof header);
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    Elf32_Phdr segment;
    std::memcpy(&segment, image.data() + header.e_phoff + i * sizeof segment, sizeof segment);
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0) continue;
    for (std::uint32_t offset = 0; offset + loop.size() <= segment.p_filesz; offset += 2)
      if (image.compare(segment.p_offset + offset, loop.size(), loop) == 0) return segment.p_paddr + offset;
  }
  FAIL("the firmware holds no endless loop to jump to");
  return 0;
}

int restarts(device::ControlClient& control) { return control.status().all.at("resets").get<int>(); }

}  // namespace inkwell::tests
