// The fuzz target for the firmware's USB device. The host sends any packets in any order. The fake port checks the
// device.
#include "tests/firmware/usb/device_bench.hpp"
#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {
namespace {

/// Each byte is one step of the host. The upper bits of a byte set how many input bytes the step uses.
void host(Input input) {
  test::DeviceBench bench;
  const auto take = [&](std::size_t most) {
    const Input taken = input.first(std::min(most, input.size()));
    input = input.subspan(taken.size());
    return taken;
  };
  while (!input.empty()) {
    const auto step = std::to_integer<unsigned>(take(1)[0]);
    const unsigned argument = step >> 4;
    switch (step & 15) {
      case 0: bench.port.reset(); break;
      case 1: bench.port.suspend(); break;
      case 2: bench.port.resume(); break;
      case 3:
        bench.setup(test::request(0x00, 9, 1, 0, 0));
        bench.port.in(0);
        bench.device.poll();
        break;
      // Most steps are shorter than one bus frame, because control periods take most of the run time.
      case 4: bench.run(argument < 12 ? argument + 1 : 20 * (argument - 11)); break;
      case 5: bench.port.frames_run = argument % 2 == 0; break;
      case 6:
      case 7: {
        std::array<std::byte, sizeof(usb::SetupPacket)> packet{};
        std::ranges::copy(take(packet.size()), packet.begin());
        bench.port.setup(packet);
        break;
      }
      case 8:
      case 9: bench.port.out(static_cast<std::uint8_t>(argument % 4), take(4 * argument)); break;
      case 10: bench.port.out(static_cast<std::uint8_t>(argument % 4), take(usb::packet_size_maximum)); break;
      case 11:
      case 12: bench.port.in(static_cast<std::uint8_t>(argument % 4)); break;
      case 13: {  // a complete report on endpoint 0
        const Input report = take(16 * argument + 16);
        if (report.empty()) break;
        bench.setup(test::request(0x21, 9, static_cast<std::uint16_t>(0x0300 | std::to_integer<unsigned>(report[0])), 0,
                                  static_cast<std::uint16_t>(report.size())));
        for (Input rest = report; !rest.empty(); rest = rest.subspan(std::min(rest.size(), usb::packet_size_maximum))) {
          bench.port.out(0, rest.first(std::min(rest.size(), usb::packet_size_maximum)));
          bench.device.poll();
        }
        bench.port.in(0);
        break;
      }
      default: bench.device.poll(); break;
    }
  }
  // The device must enumerate after any input.
  bench.port.reset();
  bench.device.poll();
  if (bench.get_descriptor(0x0100, 18).data.size() != 18) throw std::logic_error("the device does not enumerate");
}

const Registered usb_device{"usb_device", host};

}  // namespace
}  // namespace inkwell::fuzz
