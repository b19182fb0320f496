// Tests updates through openocd with a debug probe.
#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "host/client/firmware_update/probe.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/host/client/firmware_update/made_elf.hpp"

using namespace inkwell;
using namespace inkwell::firmware_update;
using inkwell::tests::contains;
using inkwell::tests::message_of;

namespace {

namespace fs = std::filesystem;

Image good_image() {
  return read_image(tests::made_elf(tests::made_segments(protocol::image_identity("omni_driver", 1, 2, 3))),
                    "it was never there.elf");
}

/// The probes of this computer have no influence.
DebugProbe without_list(const std::string& interface) { return {.interface = interface, .usb_devices = "/nowhere"}; }

void add_usb_device(const fs::path& folder, const std::map<std::string, std::string>& attributes) {
  fs::create_directories(folder);
  for (const auto& [name, text] : attributes) std::ofstream(folder / name) << text << '\n';
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::map<std::uint32_t, std::byte> bytes_of(const Image& image) {
  std::map<std::uint32_t, std::byte> bytes;
  for (const Segment& segment : image.segments)
    for (std::size_t i = 0; i < segment.bytes.size(); ++i)
      bytes[segment.address + static_cast<std::uint32_t>(i)] = segment.bytes[i];
  return bytes;
}

/// Bytes of an Intel HEX file by their address.
std::map<std::uint32_t, std::byte> bytes_of_hex(const std::string& text) {
  std::map<std::uint32_t, std::byte> bytes;
  std::uint32_t upper = 0;
  std::string line;
  std::istringstream lines(text);
  bool has_ended = false;
  while (std::getline(lines, line)) {
    REQUIRE_FALSE(has_ended);
    REQUIRE(line.front() == ':');
    std::vector<unsigned> record;
    unsigned sum = 0;
    for (std::size_t i = 1; i < line.size(); i += 2) {
      record.push_back(static_cast<unsigned>(std::stoul(line.substr(i, 2), nullptr, 16)));
      sum += record.back();
    }
    REQUIRE((sum & 0xFF) == 0);
    REQUIRE(record.size() == record[0] + 5);
    const std::uint32_t address = upper << 16 | record[1] << 8 | record[2];
    if (record[3] == 4) upper = record[4] << 8 | record[5];
    has_ended = record[3] == 1;
    for (std::size_t i = 0; record[3] == 0 && i < record[0]; ++i) {
      REQUIRE((address & 0xFFFF) + i <= 0xFFFF);
      REQUIRE_FALSE(bytes.contains(address + static_cast<std::uint32_t>(i)));
      bytes[address + static_cast<std::uint32_t>(i)] = std::byte(record[4 + i]);
    }
  }
  CHECK(has_ended);
  return bytes;
}

std::string begin_of_flash(const protocol::ImageIdentity& identity) {
  std::string bytes(identity_end, '\xFF');
  std::memcpy(bytes.data() + protocol::image_identity_offset, &identity, sizeof identity);
  return bytes;
}

/// A fake `openocd` script in the first folder of PATH. The script outputs the first bytes of the flash, or logs its
/// arguments and the files in its folder.
class FakeOpenocd {
 public:
  explicit FakeOpenocd(const std::string& end, const std::string& flash = std::string(identity_end, '\xFF')) {
    const fs::path bin = directory_ / "bin", program = bin / "openocd";
    fs::create_directory(bin);
    std::ofstream(noted("flash"), std::ios::binary) << flash;
    std::ofstream(program) << "#!/bin/sh\ncase \"$*\" in *dump_image*) echo \"$*\" >" << noted("reading") << "; cat "
                           << noted("flash")
                           << " >installed.bin; exit;; esac\nfor word in \"$@\"; do echo \"$word\"; done >"
                           << noted("words") << "\npwd -P >" << noted("folder") << "\nls -R >" << noted("files")
                           << "\ncat image.hex >" << noted("image") << "\n"
                           << end << "\n";
    fs::permissions(program, fs::perms::owner_all);
    path_before_ = std::getenv("PATH");
    setenv("PATH", (bin.string() + ":" + path_before_).c_str(), 1);
    // openocd must not use the scripts in the user's current folder.
    folder_before_ = fs::current_path();
    fs::create_directories(directory_ / "here/interface");
    std::ofstream(directory_ / "here/interface/stlink.cfg") << "shutdown\n";
    fs::current_path(directory_ / "here");
  }
  ~FakeOpenocd() {
    fs::current_path(folder_before_);
    setenv("PATH", path_before_.c_str(), 1);
  }
  std::string noted(const std::string& what) const { return directory_.file(what); }
  std::string text(const std::string& what) const { return content_of(noted(what)); }

 private:
  tests::TemporaryDirectory directory_;
  std::string path_before_;
  fs::path folder_before_;
};

const std::string reports_verified = "echo 'Info : flash'; echo '" + std::string(verified_line) + "' >&2";

std::string failure(const std::string& interface = "stlink", Consent consent = Consent::none) {
  return message_of<device::Error>(
      [&] { update_by_probe(good_image(), without_list(interface), consent, [](const auto&) {}); });
}

}  // namespace

TEST_CASE("openocd runs in a private folder and gets the bytes that were checked") {
  const FakeOpenocd fake(reports_verified);
  std::vector<std::string> lines;
  const Image image = good_image();
  update_by_probe(image, without_list("cmsis-dap"), {}, [&](const std::string& line) { lines.push_back(line); });
  CHECK(lines == std::vector<std::string>{"Info : flash", verified_line});
  CHECK(fake.text("files") == ".:\nimage.hex\ninstalled.bin\n");
  CHECK(bytes_of_hex(fake.text("image")) == bytes_of(image));
  std::string folder = fake.text("folder");
  folder.pop_back();
  CHECK_FALSE(fs::equivalent(fs::path(folder).parent_path(), fs::current_path()));
  CHECK_FALSE(fs::exists(folder));
  const std::string words = fake.text("words");
  CHECK(contains(words, "-f\ninterface/cmsis-dap.cfg\n-f\ntarget/stm32f4x.cfg\n"));
  CHECK(contains(words, "flash write_image erase image.hex; verify_image image.hex\n"));
  CHECK(words.find("verify_image") < words.find(verified_line));
  CHECK(contains(words, "options_write"));
  CHECK(contains(words, "reset run; shutdown"));
  CHECK_FALSE(contains(words, "never there"));
}

TEST_CASE("an update by a probe counts as done only after openocd's report that the image is verified") {
  const auto said_after = [](const std::string& end) {
    const FakeOpenocd fake(end);
    return failure();
  };
  CHECK(said_after(reports_verified).empty());
  CHECK(contains(said_after("exit 0"), "without a report that the firmware was verified"));
  CHECK(contains(said_after("echo 'not so: " + std::string(verified_line) + "'"), "without a report"));
  CHECK(contains(said_after(reports_verified + "; exit 1"), "the probe is connected"));
  CHECK(contains(said_after(reports_verified + "; kill -KILL $$"), "the probe is connected"));
}

TEST_CASE("a probe replaces a newer firmware, or one that it cannot read, only with consent") {
  const auto newer = begin_of_flash(protocol::image_identity("omni_driver", 2, 0, 0));
  const auto said = [](const std::string& flash, Consent consent) {
    const FakeOpenocd fake(reports_verified, flash);
    auto sentence = failure("stlink", consent);
    CHECK(fs::exists(fake.noted("words")) == sentence.empty());
    return sentence;
  };
  CHECK(contains(said(newer, Consent::none), "older than the installed firmware 2.0.0"));
  CHECK(said(newer, Consent::to_downgrade).empty());
  CHECK(said(newer, Consent::to_everything).empty());
  CHECK(said(begin_of_flash(protocol::image_identity("omni_driver", 1, 2, 3)), Consent::none).empty());
  CHECK(contains(said(begin_of_flash(protocol::image_identity("bench_modules", 1, 2, 3)), Consent::to_downgrade),
                 "is for the board omni_driver, but this board is bench_modules"));
  CHECK(contains(said("cut off", Consent::none), "could not read the board's firmware"));
  CHECK(said("cut off", Consent::to_everything).empty());
}

TEST_CASE("the installed firmware is read without a halt") {
  const FakeOpenocd fake(reports_verified);
  CHECK(failure().empty());
  const std::string reading = fake.text("reading");
  CHECK(contains(reading, "dump_image installed.bin 0x8000000 " + std::to_string(identity_end)));
  CHECK_FALSE(contains(reading, "halt"));
}

TEST_CASE("control characters in the output of openocd are replaced by question marks") {
  const FakeOpenocd fake("printf 'serial \\033[2Jred\\r\\nlast'; " + reports_verified);
  std::vector<std::string> lines;
  update_by_probe(good_image(), without_list("stlink"), {}, [&](const std::string& line) { lines.push_back(line); });
  REQUIRE(lines.size() >= 2);
  CHECK(lines[0] == "serial ?[2Jred");
  CHECK(lines[1] == "lastInfo : flash");
}

TEST_CASE("one of two debug probes must be chosen by its serial number") {
  const FakeOpenocd fake(reports_verified);
  const tests::TemporaryDirectory usb;
  add_usb_device(usb / "1-1",
                 {{"idVendor", "0483"}, {"idProduct", "374b"}, {"product", "STM32 STLink"}, {"serial", "0677FF"}});
  add_usb_device(usb / "1-2",
                 {{"idVendor", "0483"}, {"idProduct", "3748"}, {"product", "STM32 STLink"}, {"serial", "0011AA"}});
  add_usb_device(usb / "1-3",
                 {{"idVendor", "0483"}, {"idProduct", "5740"}, {"product", "Inkwell"}, {"serial", "3932"}});
  add_usb_device(
      usb / "1-4",
      {{"idVendor", "2e8a"}, {"idProduct", "000c"}, {"product", "Debug Probe (CMSIS-DAP)"}, {"serial", "E66"}});
  add_usb_device(usb / "1-4:1.0", {{"interface", "CMSIS-DAP v2"}});
  const auto update = [&](const std::string& interface, const std::string& serial_number) {
    update_by_probe(good_image(), {interface, serial_number, usb.path()}, {}, [](const auto&) {});
  };
  const auto refusal = [&](const std::string& serial_number) {
    return message_of<device::Error>([&] { update("stlink", serial_number); });
  };
  CHECK(contains(refusal(""), "2 debug probes are connected: 0011AA, 0677FF. Choose one with --probe-serial"));
  CHECK(contains(refusal("E66"), "0011AA, 0677FF"));
  for (const char* wrong : {"0677FF; exit", "[exit]", "$x", "06 77"})
    CHECK(contains(refusal(wrong), "is not the serial number"));
  CHECK_FALSE(fs::exists(fake.noted("words")));
  update("stlink", "0677FF");
  CHECK(contains(fake.text("words"), "-f\ntarget/stm32f4x.cfg\n-c\nadapter serial 0677FF\n-c\ninit"));
  CHECK_NOTHROW(update("cmsis-dap", ""));
  CHECK_NOTHROW(update("ftdi", ""));
}

TEST_CASE("an interface is a name, not a path or a piece of a script") {
  for (const char* name : {"stlink", "cmsis-dap", "stlink-v2-1", "ft232r_x"}) CHECK(is_interface_name(name));
  const FakeOpenocd fake(reports_verified);
  for (const char* name :
       {"", "../stlink", "ftdi/x", "st link", "St", "x;y", "x.cfg", "[exit]", "$x", "st\n", "\xC3\xA4"}) {
    CAPTURE(name);
    CHECK_FALSE(is_interface_name(name));
    CHECK(contains(failure(name), "is not a name of an openocd interface"));
  }
  CHECK_FALSE(fs::exists(fake.noted("words")));
}

TEST_CASE("an image of several parts is one file in Intel HEX") {
  Image image;
  for (const auto& [address, size] :
       {std::pair{0x0800'0000u, 5u}, {0x0800'0007u, 40u}, {0x0800'FFF8u, 20u}, {0x0801'0010u, 1u}}) {
    Segment segment{address, std::vector<std::byte>(size)};
    for (std::size_t i = 0; i < size; ++i) segment.bytes[i] = std::byte(address + 7 * i);
    image.segments.push_back(segment);
  }
  CHECK(bytes_of_hex(intel_hex(image)) == bytes_of(image));
  CHECK(intel_hex(image).starts_with(":020000040800F2\n:05000000"));
}
