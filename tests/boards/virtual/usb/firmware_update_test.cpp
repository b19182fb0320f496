// Tests the change from the flashed firmware to the chip's boot loader, an update, and the return to the firmware.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint8_t class_in = 0xA1, class_out = 0x21;
constexpr std::uint8_t detach = 0, download = 1, upload = 2, get_status = 3, clear_status = 4, abort_request = 6;
constexpr std::uint8_t idle = 2, busy = 4, download_idle = 5, manifest = 7, error = 10;
constexpr std::uint32_t free_sector = 0x0802'0000, free_sector_bytes = 0x2'0000;

Bytes command(std::uint8_t code, std::uint32_t address) {
  return {std::byte{code}, std::byte(address), std::byte(address >> 8), std::byte(address >> 16),
          std::byte(address >> 24)};
}

/// Updates the firmware with single requests, so that each state is observed.
struct Loader {
  explicit Loader(FirmwareOnBus& the_bus) : bus(the_bus) {}

  void enter() {
    bus.connect();
    REQUIRE(bus.control(class_out, detach, 1000, 3, 0).status == 0);
    bus.run_for(0.05);
    bus.connect();
  }
  std::int32_t send(std::uint16_t block, Bytes data) {
    const auto length = static_cast<std::uint16_t>(data.size());
    return bus.control(class_out, download, block, 0, length, std::move(data)).status;
  }
  struct Status {
    unsigned status, poll_ms, state;
  };
  Status status() {
    const auto answer = bus.control(class_in, get_status, 0, 0, 6);
    REQUIRE(answer.data.size() == 6);
    const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(answer.data[i]); };
    return {byte(0), byte(1) | byte(2) << 8 | byte(3) << 16, byte(4)};
  }
  /// Returns the board time until the next answer.
  double wait_s() {
    const Ticks begin = bus.chip.now();
    CHECK(status().state == download_idle);
    return virtual_board::seconds(bus.chip.now() - begin);
  }
  void carry_out(std::uint16_t block, Bytes data) {
    REQUIRE(send(block, std::move(data)) == 0);
    REQUIRE(status().state == busy);
    REQUIRE(status().state == download_idle);
  }
  Bytes read(std::uint32_t address, std::uint16_t length) {
    carry_out(0, command(0x21, address));
    REQUIRE(bus.control(class_out, abort_request, 0, 0, 0).status == 0);
    auto answer = bus.control(class_in, upload, 2, 0, length);
    REQUIRE(answer.status == 0);
    REQUIRE(bus.control(class_out, abort_request, 0, 0, 0).status == 0);
    return answer.data;
  }
  std::string text(std::uint16_t index) {
    std::string text;
    const auto answer = bus.control(0x80, 6, static_cast<std::uint16_t>(0x0300 | index), 0x0409, 255);
    for (std::size_t i = 2; i < answer.data.size(); i += 2) text += static_cast<char>(answer.data[i]);
    return text;
  }

  FirmwareOnBus& bus;
};

TEST_CASE("a detach request starts the chip's boot loader, and a reset the firmware again") {
  FirmwareOnBus bus(flashed_image());
  Loader loader(bus);
  loader.enter();
  const auto device = bus.control(0x80, 6, 0x0100, 0, 18).data;
  REQUIRE(device.size() == 18);
  CHECK(Bytes(device.begin() + 8, device.begin() + 12) ==
        Bytes{std::byte{0x83}, std::byte{0x04}, std::byte{0x11}, std::byte{0xDF}});
  CHECK(loader.text(4) == "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg");
  CHECK(loader.text(5) == "@Option Bytes  /0x1FFFC000/01*016 e");
  CHECK(loader.status().state == idle);
  CHECK(bus.violations().empty());
  bus.chip.reset();
  bus.run_for(0.05);  // the port detects that the boot loader has disconnected
  bus.connect();
  CHECK(loader.text(2) == "Inkwell haptic arm");
  CHECK(bus.violations().empty());
}

TEST_CASE("the boot loader erases and programs the flash in the flash's own time") {
  FirmwareOnBus bus(flashed_image());
  Loader loader(bus);
  loader.enter();
  Bytes block(2048);
  for (std::size_t i = 0; i < block.size(); ++i) block[i] = std::byte(i * 7);

  REQUIRE(loader.send(0, command(0x41, free_sector)) == 0);
  const auto answer = loader.status();
  CHECK(answer.state == busy);
  CHECK(answer.poll_ms == 1000);
  CHECK(loader.wait_s() == doctest::Approx(1.0).epsilon(0.02));  // data sheet: 128 KiB, word programming, typical
  CHECK(loader.read(free_sector + free_sector_bytes - 4, 4) == Bytes(4, std::byte{0xFF}));

  loader.carry_out(0, command(0x21, free_sector));
  REQUIRE(loader.send(3, block) == 0);  // the second block
  CHECK(loader.status().state == busy);
  CHECK(loader.wait_s() == doctest::Approx(0.0085).scale(0).epsilon(0.1));  // 512 words of 16 us, in whole frames
  CHECK(loader.read(free_sector + 2048, 2048) == block);
  CHECK(loader.read(free_sector, 4) == Bytes(4, std::byte{0xFF}));

  // Without an erase, programming can clear bits but cannot set bits.
  loader.carry_out(0, command(0x21, free_sector + 2048));
  loader.carry_out(2, Bytes(4, std::byte{0x0F}));
  const auto mixed = loader.read(free_sector + 2048, 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(mixed[i] == (block[i] & std::byte{0x0F}));
  CHECK(bus.violations().empty());
}

TEST_CASE("the boot loader refuses an invalid request with a status and continues after the error is cleared") {
  FirmwareOnBus bus(flashed_image());
  Loader loader(bus);
  loader.enter();
  CHECK(loader.send(1, Bytes(4)) != 0);  // invalid block
  CHECK(loader.status().state == error);
  CHECK(loader.send(2, Bytes(4)) != 0);  // not accepted before the error is cleared
  CHECK(bus.control(class_out, clear_status, 0, 0, 0).status == 0);
  CHECK(loader.status().state == idle);
  CHECK(loader.send(0, Bytes{std::byte{0x77}}) != 0);  // invalid command
  CHECK(bus.control(class_out, clear_status, 0, 0, 0).status == 0);
  REQUIRE(loader.send(0, command(0x41, 0x4000'0000)) == 0);  // not flash memory
  const auto answer = loader.status();
  CHECK(answer.state == error);
  CHECK(answer.status == 1);  // errTARGET
  CHECK(bus.control(class_out, clear_status, 0, 0, 0).status == 0);
  CHECK(bus.control(class_out, detach, 0, 0, 0).status != 0);
  CHECK(loader.status().state == idle);
}

TEST_CASE("an empty download starts the firmware") {
  FirmwareOnBus bus(flashed_image());
  Loader loader(bus);
  loader.enter();
  REQUIRE(loader.send(0, {}) == 0);
  CHECK(loader.status().state == manifest);
  bus.run_for(0.1);
  bus.connect();
  CHECK(loader.text(2) == "Inkwell haptic arm");
  CHECK(bus.violations().empty());
}

TEST_CASE("option bytes that the boot loader writes hold after the reset that it makes") {
  FirmwareOnBus bus(flashed_image());
  Loader loader(bus);
  loader.enter();
  constexpr std::uint32_t options_address = 0x1FFF'C000;
  auto options = loader.read(options_address, 16);
  CHECK(options[1] == std::byte{0xAA});                      // not protected
  CHECK((options[0] & std::byte{0x0C}) == std::byte{0x0C});  // new chip: brown-out reset disabled
  options[0] &= ~std::byte{0x0C};
  loader.carry_out(0, command(0x21, options_address));
  REQUIRE(loader.send(2, options) == 0);
  CHECK(loader.status().state == busy);
  bus.run_for(0.5);
  bus.connect();
  CHECK(loader.text(2) == "Inkwell haptic arm");  // the firmware runs after the reset
  CHECK(bus.control(class_out, detach, 1000, 3, 0).status == 0);
  bus.run_for(0.05);
  bus.connect();
  CHECK((loader.read(options_address, 1)[0] & std::byte{0x0C}) == std::byte{0});
  CHECK(bus.violations().empty());
}

TEST_CASE("with BOOT0 high the boot loader runs although the flash is empty, and is there for a host") {
  RestingCircuit circuit;
  Chip chip(circuit);
  virtual_board::Connector connector(chip.connections());
  chip.add_peripheral(virtual_board::OtgFsDevice::base, virtual_board::OtgFsDevice::size, "OTG_FS", connector);
  chip.on_boot_loader = [&] { return connector.boot_loader_order(chip.debug_port()); };
  chip.reset(virtual_board::ResetCause::power_on);
  chip.start_boot_loader();
  chip.run_until(ticks(0.001));
  CHECK(connector.attachment() != 0);
  chip.reset();
  CHECK(connector.attachment() == 0);
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
