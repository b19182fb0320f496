// Tests the order of the update steps. The test's loader records the steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "host/client/firmware_update/update.hpp"
#include "tests/failure.hpp"
#include "tests/host/client/device/fake_usb.hpp"

#include "tests/host/client/firmware_update/made_elf.hpp"

using namespace inkwell;
using namespace inkwell::firmware_update;
using inkwell::tests::contains;
using inkwell::tests::made_elf;
using inkwell::tests::made_segments;
using inkwell::tests::message_of;

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t options_address = 0x1FFF'C000;

/// A fake of ST's loader, with the flash and the option bytes at separate addresses.
class FakeLoader final : public device::ControlChannel {
 public:
  FakeLoader() { options[1] = std::byte{0xAA}; }

  std::vector<std::byte> read(const device::UpdateRequest& request, std::uint16_t length) override {
    if (gone) throw device::Disconnected("unplugged");
    if (request.request == 3) return status();
    REQUIRE(request.request == 2);
    REQUIRE(request.value == 2);
    REQUIRE((state == 2 || state == 9));
    state = 9;
    Bytes bytes(length);
    for (std::uint32_t i = 0; i < length; ++i)
      bytes[i] = pointer >= options_address    ? options[i]
                 : flash.contains(pointer + i) ? flash[pointer + i]
                                               : std::byte{0xFF};
    if (spoilt && pointer == *spoilt) bytes[0] ^= std::byte{1};
    return bytes;
  }
  void write(const device::UpdateRequest& request, std::span<const std::byte> data) override {
    if (gone) throw device::Disconnected("unplugged");
    if (request.request == 4 || request.request == 6) {
      state = 2;
      return;
    }
    REQUIRE(request.request == 1);
    REQUIRE((state == 2 || state == 5));
    if (data.empty()) {
      did.push_back("leave");
      state = 7;
      return;
    }
    state = 4;
    if (request.value != 0) return write_memory(data);
    std::uint32_t address = 0;
    for (std::size_t i = 0; i < 4; ++i) address |= std::to_integer<std::uint32_t>(data[1 + i]) << 8 * i;
    if (data[0] == std::byte{0x21}) {
      pointer = address;
      return;
    }
    REQUIRE(data[0] == std::byte{0x41});
    did.push_back("erase " + std::to_string(address - protocol::image_begin));
    std::erase_if(flash, [&](const auto& each) { return each.first / 0x4000 == address / 0x4000; });
    if (did.size() == dies_after) gone = true;
  }
  void select_alternate(std::uint8_t) override {}
  std::string alternate_name(std::uint8_t) override { return layout; }

  std::string layout = "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg";
  std::map<std::uint32_t, std::byte> flash;
  std::array<std::byte, 16> options{};
  std::vector<std::string> did;
  std::optional<std::uint32_t> spoilt;  ///< reading this address returns another byte
  std::size_t dies_after = 0;
  bool gone = false;
  unsigned state = 10;  ///< dfuERROR, left by another program

 private:
  Bytes status() {
    Bytes answer(6);
    answer[4] = std::byte(state);
    if (state == 4) state = 5;
    return answer;
  }
  void write_memory(std::span<const std::byte> data) {
    if (pointer >= options_address) {
      std::ranges::copy(data, options.begin());
      did.push_back("options");
      return;
    }
    did.push_back("write " + std::to_string(pointer - protocol::image_begin));
    for (std::size_t i = 0; i < data.size(); ++i) flash[pointer + static_cast<std::uint32_t>(i)] = data[i];
  }
  std::uint32_t pointer = 0;
};

Image good_image() {
  return read_image(made_elf(made_segments(protocol::image_identity("omni_driver", 1, 2, 3))), "made.elf");
}

}  // namespace

TEST_CASE("the vectors are erased first and written last, and the brown-out level is set at the end") {
  FakeLoader fake;
  BootLoader loader(fake);
  const auto image = good_image();
  std::vector<double> progress;
  auto written =
      write_image(loader, image, {.on_progress = [&](std::string_view, double done) { progress.push_back(done); }});
  CHECK_FALSE(written.before.has_value());
  CHECK(written.has_set_brown_out == false);  // all option bits of the fake are 0
  CHECK(fake.did ==
        std::vector<std::string>{"erase 0", "erase 65536", "write 65536", "write 67584", "write 0", "leave"});
  CHECK(std::ranges::is_sorted(progress));
  CHECK(progress.back() < 1);

  fake.did.clear();
  fake.options[0] = std::byte{0xEC};
  written = write_image(loader, image, {});
  CHECK(written.before->board_name() == "omni_driver");
  CHECK(written.has_set_brown_out);
  CHECK(fake.options[0] == std::byte{0xE0});
  CHECK(fake.options[1] == std::byte{0xAA});
  CHECK(fake.did.back() == "options");  // writing the option bytes resets the chip
}

TEST_CASE("the board name of the installed firmware can select the image") {
  FakeLoader fake;
  BootLoader loader(fake);
  const auto other = read_image(made_elf(made_segments(protocol::image_identity("other", 1, 2, 3))), "other.elf");
  write_image(loader, other, {});
  SUBCASE("another than the given one") {
    const auto written = write_image(loader, good_image(), {.image_for = [&](const auto& there) {
                                       return there == "other" ? std::optional(other) : std::nullopt;
                                     }});
    CHECK(written.image.identity->board_name() == "other");
    return;
  }
  SUBCASE("the image is missing, so that the board returns to its firmware") {
    fake.did.clear();
    CHECK_THROWS_AS(write_image(loader, good_image(),
                                {.image_for = [](const auto&) -> std::optional<Image> { throw NoImage("missing"); }}),
                    NoImage);
    CHECK(fake.did == std::vector<std::string>{"leave"});
  }
}

TEST_CASE("if the image differs when it is read back, its vectors are not written") {
  FakeLoader fake;
  BootLoader loader(fake);
  fake.spoilt = protocol::image_begin + 0x1'0000;
  const auto said = message_of<Interrupted>([&] { write_image(loader, good_image(), {}); });
  CHECK(contains(said, "0x08010000"));
  CHECK(contains(said, "same command again"));
  CHECK(std::ranges::find(fake.did, "write 0") == fake.did.end());
  CHECK(std::ranges::find(fake.did, "leave") == fake.did.end());
  fake.spoilt.reset();
  fake.did.clear();
  write_image(loader, good_image(), {});
  CHECK(fake.did.back() == "leave");
}

TEST_CASE("an image that the board chose is named for going on, since the board cannot choose it again") {
  FakeLoader fake;
  BootLoader loader(fake);
  const auto other = read_image(made_elf(made_segments(protocol::image_identity("other", 1, 2, 3))), "other.elf");
  write_image(loader, other, {});
  fake.spoilt = protocol::image_begin + 0x1'0000;
  const auto chosen = message_of<Interrupted>(
      [&] { write_image(loader, good_image(), {.image_for = [&](auto) { return std::optional(other); }}); });
  CHECK(contains(chosen, "same command again, now with other.elf"));
  fake.spoilt.reset();
  write_image(loader, other, {});
  fake.spoilt = protocol::image_begin + 0x1'0000;
  const auto given = message_of<Interrupted>([&] { write_image(loader, other, {}); });
  CHECK(contains(given, "same command again: the command continues the update"));
}

TEST_CASE("the error after an unplugged cable during an update states how to continue") {
  FakeLoader fake;
  fake.dies_after = 2;
  BootLoader loader(fake);
  const auto said = message_of<Interrupted>([&] { write_image(loader, good_image(), {}); });
  CHECK(contains(said, "BOOT0"));
}

TEST_CASE("before the first erase an update ends with the board as it was") {
  FakeLoader fake;
  BootLoader loader(fake);
  SUBCASE("cancelled") {
    CHECK(contains(
        message_of<device::Error>([&] { write_image(loader, good_image(), {.is_cancelled = [] { return true; }}); }),
        "Nothing was changed"));
  }
  SUBCASE("another board's image") {
    write_image(loader, good_image(), {});
    fake.did.clear();
    const auto other = read_image(made_elf(made_segments(protocol::image_identity("other", 1, 2, 3))), "other.elf");
    CHECK_THROWS_AS(write_image(loader, other, {}), Objected);
    CHECK(fake.did == std::vector<std::string>{"leave"});  // starts the firmware again
    return;
  }
  SUBCASE("an older image") {
    write_image(loader, good_image(), {});
    fake.did.clear();
    const auto older = read_image(made_elf(made_segments(protocol::image_identity("omni_driver", 1, 2, 2))), "old.elf");
    CHECK_THROWS_AS(write_image(loader, older, {}), Downgrade);
    CHECK(fake.did == std::vector<std::string>{"leave"});
    CHECK_NOTHROW(write_image(loader, older, {.consent = Consent::to_downgrade}));
    return;
  }
  SUBCASE("a chip that is protected") {
    fake.options[1] = std::byte{0x00};
    CHECK(contains(message_of<device::Error>([&] { write_image(loader, good_image(), {}); }), "protected"));
  }
  SUBCASE("a loader of another chip") {
    fake.layout = "@Internal Flash  /0x90000000/04*016Kg";
    CHECK(contains(message_of<device::Error>([&] { write_image(loader, good_image(), {}); }), "right board"));
  }
  CHECK(fake.did.empty());
}

TEST_CASE(
    "with several boards an update requires a serial number, and without a board the error states the next action") {
  tests::FakeUsb usb;
  CHECK(contains(message_of<device::NoDevice>([] { update({}, good_image(), {}); }), "BOOT0"));
  usb.add_arm("111");
  auto& loader = usb.add_arm("222");
  loader.vendor_id = 0x0483;
  loader.product_id = 0xDF11;
  const auto said = message_of<device::NoDevice>([] { update({}, good_image(), {}); });
  CHECK(contains(said, "2 boards"));
  CHECK(contains(said, "111 (runs)"));
  CHECK(contains(said, "222 (boot loader)"));
  CHECK(contains(said, "--serial"));
  loader.open_result = -3;  // LIBUSB_ERROR_ACCESS
  CHECK_THROWS_AS(update({}, good_image(), {}), device::NoPermission);
}

TEST_CASE("a board stays in its firmware while the force is on, and the error states how to switch it off") {
  tests::FakeUsb usb;
  auto& arm = usb.add_arm("111");
  SUBCASE("by its status") { arm.update_status = Bytes{std::byte{0x0B}, {}, {}, {}, {}, {}}; }
  SUBCASE("by a stall") { arm.stalls_detach = true; }
  const auto said = message_of<device::Error>([] { update({}, good_image(), {}); });
  CHECK(contains(said, "while the force is on"));
  CHECK(contains(said, "inkwell force off"));
}

TEST_CASE("a boot loader that has just appeared may be denied until the system has set its rights") {
  tests::FakeUsb usb;
  auto& arm = usb.add_arm("111");
  arm.becomes_loader_at_detach = true;
  SUBCASE("for a moment") {
    arm.denied_opens = 3;
    CHECK(contains(message_of<device::Stalled>([] { update({}, good_image(), {}); }), "refused"));  // a fake loader
    CHECK(arm.denied_opens == 0);
  }
  SUBCASE("for good") {
    arm.denied_opens = 1'000'000;
    CHECK_THROWS_AS(update({}, good_image(), {}), device::NoPermission);
  }
  CHECK(arm.detaches == 1);
}
