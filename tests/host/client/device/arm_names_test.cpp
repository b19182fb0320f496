// Tests the file that binds names to arms.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "host/client/device/arm_names.hpp"
#include "tests/environment.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/host/client/device/fake_usb.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using device::NamedArm;

namespace {

constexpr char two_arms[] = R"(
[[arm]]
name = "right"
address = "00000000000000000000002B"
[[arm]]
name = "left"
address = "usbip:127.0.0.1:3240"
control = "127.0.0.1:3250"
)";

std::string refusal_of(const std::string& text) {
  return message_of<device::Error>([&] { device::parse_arm_names(text, "arms.toml"); });
}

/// A file of names that is used during the lifetime of this object.
struct UsedFile {
  TemporaryDirectory directory;
  std::string path = directory.file("arms.toml");
  Environment variable{"INKWELL_ARMS", path};
  explicit UsedFile(const std::string& text) { std::ofstream(path) << text; }
};

}  // namespace

TEST_CASE("the file of names has an order, and names have no case") {
  const auto arms = device::parse_arm_names(two_arms, "arms.toml");
  REQUIRE(arms.size() == 2);
  CHECK(arms[0] == NamedArm{"right", "00000000000000000000002B"});
  CHECK(arms[1] == NamedArm{"left", "usbip:127.0.0.1:3240", "127.0.0.1:3250"});
  CHECK(device::names_of(arms) == "right, left");
  REQUIRE(device::find_arm_name(arms, "LEFT") != nullptr);
  CHECK(device::find_arm_name(arms, "LEFT")->name == "left");
  CHECK(device::find_arm_name(arms, "middle") == nullptr);
  CHECK(device::name_of_address(arms, "usbip:127.0.0.1:3240") == "left");
  CHECK(device::name_of_address(arms, "2C").empty());
  CHECK(device::parse_arm_names("\xEF\xBB\xBF# nothing\r\n", "arms.toml").empty());
}

TEST_CASE("names that were written are read again, and the folder is created") {
  const TemporaryDirectory directory;
  const auto file = directory / "new" / "arms.toml";
  CHECK(device::read_arm_names(file).empty());
  const std::vector<NamedArm> arms{{"the left-hand arm", "2A"}, {"Default_2.b", "usbip:unix:/run/b", "unix:/run/c"}};
  device::write_arm_names(arms, file);
  CHECK(device::read_arm_names(file) == arms);
  CHECK(contains(message_of<device::Error>([&] { device::read_arm_names(file.parent_path()); }), "cannot be read"));
  CHECK(contains(message_of<device::Error>([&] { device::write_arm_names(arms, "/proc/none/arms.toml"); }),
                 "/proc/none/arms.toml cannot be written"));
}

TEST_CASE("a mistake in the file of names is reported with its line") {
  CHECK(contains(refusal_of("[[arm]]\nname = \"a\"\naddress = \"2A\"\n[[arm]]\nname = \"A\"\naddress = \"2B\"\n"),
                 "arms.toml, line 4: The name `A` is bound twice."));
  CHECK(contains(refusal_of("[[arm]]\nname = \"left\"\n"), "line 1: The arm `left` has no `address`"));
  CHECK(contains(refusal_of("[[arm]]\nname = 3\n"), "`name` is not a text in quotes"));
  CHECK(contains(refusal_of("[[arm]]\nname = \"left\"\naddress = \"usbip:\"\n"), "127.0.0.1:3240"));
  CHECK(contains(refusal_of("[[arm]]\nname = \"left\"\naddress = \"2A\"\ncontrol = \"x\"\n"), "line 1"));
  CHECK(contains(refusal_of("\nleft = \"2A\"\n"), "line 2: `left` is unknown. Write each arm as [[arm]]"));
  CHECK(contains(refusal_of("[[arm]\n"), "arms.toml, line 1:"));
  CHECK(contains(refusal_of("arm = 7\n"), "`arm` is unknown"));
}

TEST_CASE("a name is neither an address nor a serial number") {
  for (const auto good : {"left", "Left 2", "PHANToM_1", "a.b-c", "face"}) CHECK_NOTHROW(device::check_arm_name(good));
  for (const auto bad : {"", " left", "left ", "-left", "usbip:a", "virtual", "Virtual", "virtual?seed=1", "left,right",
                         "00000000000000000000002b", "a name of an arm that is far too long"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(device::check_arm_name(bad), device::Error);
  }
}

TEST_CASE("a name selects its arm, and the error for an unknown or absent arm lists names and arms") {
  FakeUsb usb;
  usb.add_arm("00000000000000000000002B");
  const UsedFile file(std::string(two_arms) + "[[arm]]\nname = \"absent\"\naddress = \"2C\"\n");
  CHECK(device::find_arm(device::named_address("Right")).serial_number == "00000000000000000000002B");
  const auto left = device::named_address("left");
  CHECK(left.kind == device::Address::Kind::usbip);
  CHECK(left.server.port == 3240);
  REQUIRE(left.control);
  CHECK(left.control->port == 3250);
  CHECK(device::named_address("").name.empty());
  const auto refusal = [](const char* text) {
    return message_of<device::Error>([&] { device::find_arm(device::named_address(text)); });
  };
  CHECK(contains(refusal("rigt"), "Did you mean right? Known names: right, left, absent."));
  CHECK(contains(refusal("absent"), "The arm absent is not plugged in. Its serial number in " + file.path + " is 2C."));
  CHECK(contains(refusal("absent"), "The connected arms are: 00000000000000000000002B."));
}

TEST_CASE("an empty INKWELL_ARMS means that there are no names, and otherwise the user's configuration contains them") {
  const TemporaryDirectory home;
  const Environment configuration("XDG_CONFIG_HOME", home.path());
  {
    const Environment none("INKWELL_ARMS", "");
    CHECK(device::arm_names_file().empty());
    CHECK(device::read_arm_names().empty());
    CHECK(contains(message_of<device::Error>([] { device::write_arm_names({}, device::arm_names_file()); }),
                   "INKWELL_ARMS"));
  }
  const std::string before = std::getenv("INKWELL_ARMS") == nullptr ? "" : std::getenv("INKWELL_ARMS");
  unsetenv("INKWELL_ARMS");
  CHECK(device::arm_names_file() == home / "inkwell" / "arms.toml");
  setenv("INKWELL_ARMS", before.c_str(), 1);
}
