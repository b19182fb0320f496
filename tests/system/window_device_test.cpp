// Tests disconnections of the device, recordings and guides in the window.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "host/client/recording/recording.hpp"

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

void unplug(WindowRig& rig) {
  rig.control.usb(false);
  rig.wait_until("the window notices", [](const Sight& now) { return !now.connected(); });
}

void plug_in(WindowRig& rig, const std::string& state = "ready") {
  rig.control.usb(true);
  rig.wait_until("the window is connected again", [&](const Sight& now) { return now.state() == state; });
}

}  // namespace

TEST_CASE("an unplugged device is reported and connects again automatically") {
  WindowRig rig;
  rig.switch_force_on();
  unplug(rig);
  rig.wait_until("it says so", [](const Sight& now) { return now.says("No arm was found. Plug in an arm"); });
  CHECK_FALSE(rig.look().can_click("status/Switch force on"));
  plug_in(rig, "fault");
  CHECK(rig.look().says("The USB connection was lost while the force was on"));
  rig.click("banner/Clear fault");
  // The arm is still referenced, and the force is off.
  rig.wait_until("the fault is cleared", [](const Sight& now) { return now.state() == "ready"; });
  CHECK(rig.look().can_click("status/Switch force on"));
  CHECK_FALSE(rig.look().says("No arm was found"));
}

TEST_CASE("closing the window switches the force off, and the board reports no fault") {
  WindowRig rig;
  rig.switch_force_on();
  rig.close_and_read_parameters();
  const auto arm = device::Device::open(*rig.board.find());
  const auto pose = arm->read_pose(std::chrono::seconds(60));
  REQUIRE(pose.has_value());
  CHECK(pose->state == protocol::State::ready);
  CHECK(pose->fault == protocol::Fault::none);
}

TEST_CASE("while another program drives, the window names it and can take over the arm") {
  WindowRig rig;
  RunningProgram other({build_directory() + "/inkwell", "force", "on", "--usbip", rig.board.usbip().text()});
  REQUIRE(other.read_line() == "The force is on.");
  const auto change = [&](const char* stiffness) {
    rig.enter("tuning/wall_stiffness_N_per_m", stiffness);
    rig.press_key("Return");
  };
  change("700");
  rig.wait_until("the driver is named", [](const Sight& now) {
    return now.has("banner/Take over") && now.says("The arm is driven by inkwell (process");
  });
  rig.click("banner/Take over");
  rig.wait_until("the banner is gone", [](const Sight& now) { return !now.has("banner/Take over"); });
  const auto before = rig.look().applied_at_periods();
  change("900");
  rig.wait_until("the change has an effect", [&](const Sight& now) { return now.applied_at_periods() != before; });
}

TEST_CASE("a recording is started, marked, stopped and replayed") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("push.h5");
  WindowRig rig;
  rig.click("tabs/Recording");
  rig.enter("recording/file", file);
  rig.enter("recording/name", "subject 7");
  rig.enter("recording/note", "left hand");
  rig.click("recording/Start recording");
  rig.wait_until("it records", [](const Sight& now) { return now.has("recording/Stop recording"); });
  rig.enter("recording/mark text", "here");
  rig.click("recording/Mark");
  rig.control.run(0.5);
  rig.control.resume();
  rig.click("recording/Stop recording");
  rig.wait_until("it is complete", [](const Sight& now) { return now.says("push.h5 is complete"); });

  const auto recording = recording::read(file);
  CHECK(recording.complete);
  CHECK(recording.size() > 10'000);  // half a second and the duration of the clicks
  CHECK(recording.lost() == 0);
  CHECK(recording.information.simulation);
  CHECK(recording.information.name == "subject 7");
  CHECK(recording.information.note == "left hand");
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.marks[0].text == "here");

  rig.click("recording/Open a recording");
  rig.enter("choose a file/path", file);
  rig.click("choose a file/Open");
  rig.wait_until("it plays to its end", [](const Sight& now) { return now.has("replay/Play"); });
  CHECK(rig.look().says("push (simulation)"));
  rig.click("tabs/Tuning");
  CHECK(rig.look().says("These parameters are from the recording."));
  rig.click("replay/Close replay");
  CHECK_FALSE(rig.look().says("These parameters are from the recording."));
}

TEST_CASE("a recording whose device is unplugged contains everything before the unplug") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("cut.h5");
  WindowRig rig;
  rig.click("tabs/Recording");
  rig.enter("recording/file", file);
  rig.click("recording/Start recording");
  rig.wait_until("it records", [](const Sight& now) { return now.has("recording/Stop recording"); });
  rig.control.run(0.5);
  rig.control.resume();
  unplug(rig);
  rig.wait_until("it says so", [](const Sight& now) { return now.says("The device was disconnected."); });
  const auto recording = recording::read(file);
  CHECK_FALSE(recording.complete);
  CHECK(recording.size() > 9'000);
  CHECK(recording.lost() == 0);
}

TEST_CASE("a guide whose device is unplugged reports this and restores the parameters") {
  WindowRig rig;
  rig.click("tabs/Guides");
  rig.click("guides/Current-loop tuning");
  // Each step waits for a confirmation. The first transaction activates the trial gains.
  const auto before = rig.look().applied_at_periods();
  rig.wait_until("gains are on trial", [&](const Sight& now) {
    if (now.can_click("guides/Confirm")) rig.click(now.item("guides/Confirm").centre());
    return now.applied_at_periods() != before;
  });
  unplug(rig);
  rig.wait_until("it says so", [](const Sight& now) { return now.says("The device was disconnected in the step"); });
  plug_in(rig);
  rig.wait_until("they are put back", [](const Sight& now) { return now.applied_at_periods() != 0; });
  rig.click("guides/Back");
  CHECK(rig.look().can_click("guides/Current-loop tuning"));
  CHECK(rig.close_and_read_parameters() == rig.parameters_at_start());
}
