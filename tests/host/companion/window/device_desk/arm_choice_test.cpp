// A single arm is chosen automatically; several arms require a name or a choice.
#include <doctest/doctest.h>

#include "host/companion/window/device_desk/arm_choice.hpp"
#include "tests/failure.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using window::ArmChoice;

namespace {

device::Endpoint arm(const std::string& serial_number) {
  return {device::Endpoint::Kind::usb, serial_number, "Inkwell haptic arm", "/dev/" + serial_number, "", 0};
}
const device::Endpoint a = arm("A"), b = arm("B");

std::string picked(ArmChoice& choice, const std::vector<device::Endpoint>& found) {
  const auto endpoint = choice.pick(found);
  return endpoint ? endpoint->serial_number : "none";
}
std::string question(ArmChoice& choice, const std::vector<device::Endpoint>& found) {
  return message_of<device::NoDevice>([&] { choice.pick(found); });
}

}  // namespace

TEST_CASE("an arm that is alone is taken, also after another one that was alone") {
  ArmChoice choice("");
  CHECK(picked(choice, {}) == "none");
  CHECK(picked(choice, {a}) == "A");
  CHECK(picked(choice, {b}) == "B");
}

TEST_CASE("of several arms none is taken that was not named") {
  ArmChoice choice("");
  CHECK(contains(question(choice, {a, b}), "2 arms are plugged in. Choose an arm"));
  ArmChoice named("B");
  CHECK(picked(named, {a, b}) == "B");
  CHECK(picked(named, {a}) == "none");
}

TEST_CASE("an arm that was chosen alone is chosen again next to another arm, and the other arm never replaces it") {
  ArmChoice choice("");
  CHECK(picked(choice, {a}) == "A");
  CHECK(picked(choice, {b, a}) == "A");
  CHECK(picked(choice, {}) == "none");  // the choice resets itself
  CHECK(contains(question(choice, {b}), "The arm A is disconnected, but the arm B is connected"));
  CHECK(picked(choice, {b, a}) == "A");
}

TEST_CASE("arms of a server without serial numbers are chosen in their order") {
  ArmChoice choice("");
  auto one = arm(""), other = arm("");
  other.path = "second";
  CHECK(choice.pick({one, other})->path == "/dev/");
}
