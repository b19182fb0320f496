#include "host/lab/campaign/board_run.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "host/client/device/address.hpp"
#include "host/client/device/control_channel.hpp"
#include "host/client/firmware_update/boot_loader.hpp"

namespace inkwell::campaign {
namespace {

using namespace std::chrono_literals;

constexpr double slice_s = 0.005;
constexpr unsigned slices_per_sign_of_life = 2;

}  // namespace

BoardRun::BoardRun(const device::VirtualBoardOptions& options) : board_(options), control_(board_.control()) {
  control_.stand_by();
}

bool BoardRun::connect(double limit_s) {
  let_go_of_device();
  if (is_locked_up()) return false;  // a locked-up processor does not answer
  for (double waited_s = 0;; waited_s += slice_s) {
    try {
      if (const auto endpoint = board_.find()) {
        device_ = device::Device::open(*endpoint);
        return true;
      }
    } catch (const device::Error&) {
      let_go_of_device();  // the device disappeared during the opening
    }
    if (waited_s >= limit_s) return false;
    pass(slice_s);
  }
}

bool BoardRun::connect_after_restart() {
  if (!connect(0.3)) return false;
  run(0.15);
  return true;
}

void BoardRun::set(std::initializer_list<device::ParameterChange> changes) {
  device_->set_parameters(std::vector<device::ParameterChange>(changes));
}

void BoardRun::pass(double time_s) { control_.run(time_s); }

bool BoardRun::is_locked_up() { return control_.status().all.contains("locked_up"); }

unsigned BoardRun::resets() { return control_.status().all.value("resets", 0u); }

void BoardRun::let_go_of_device() {
  device_.reset();
  pose_.reset();
}

void BoardRun::drop_device() {
  if (device_) device_->abandon();
  let_go_of_device();
  // Board time is stopped, so the duration of this wait does not affect the result.
  constexpr int tries = 5000;
  for (int i = 0; i < tries && control_.status().all.at("usb").at("imported").get<bool>(); ++i)
    std::this_thread::sleep_for(1ms);
}

void BoardRun::read_poses() {
  if (!device_) return;
  try {
    while (const auto pose = device_->read_pose(0ms)) {
      pose_ = pose;
      if (watch_) watch_(*pose);
    }
  } catch (const device::Error&) {
    let_go_of_device();
  }
}

void BoardRun::use_device(const std::function<void(device::Device&)>& use) {
  if (!device_) return;
  try {
    use(*device_);
  } catch (const device::Error&) {
    let_go_of_device();
  }
}

void BoardRun::command(protocol::Command command) {
  use_device([&](device::Device& device) { device.send(command); });
}

void BoardRun::place(const device::Shapes& shapes) {
  use_device([&](device::Device& device) {
    device.claim();
    device.place_shapes(shapes);
  });
}

void BoardRun::send(const device::LocalModel& model, const device::ForceRequest& force) {
  use_device([&](device::Device& device) { device.send_local_model(model, force); });
}

void BoardRun::run(double time_s, bool sends_heartbeats) {
  double left_s = time_s;
  while (left_s > 1e-9) {
    if (sends_heartbeats && slices_++ % slices_per_sign_of_life == 0) command(protocol::Command::heartbeat);
    pass(std::min(left_s, slice_s));
    left_s -= slice_s;
    read_poses();
  }
}

bool BoardRun::wait_for(const std::function<bool(const device::Pose&)>& condition, double limit_s) {
  double waited_s = 0;
  while (waited_s < limit_s) {
    if (pose_ && condition(*pose_)) return true;
    run(slice_s);
    waited_s += slice_s;
  }
  return pose_ && condition(*pose_);
}

bool BoardRun::wait_for(protocol::State state, double limit_s) {
  return wait_for([state](const auto& pose) { return pose.state == state; }, limit_s);
}

void BoardRun::reset() {
  control_.reset();
  let_go_of_device();
}

void BoardRun::request_boot_loader() {
  if (const auto endpoint = board_.find()) device::detach_firmware(*endpoint);
}

std::vector<device::Endpoint> BoardRun::boot_loaders() const {
  return device::find_boot_loaders({.kind = device::Address::Kind::usbip, .server = board_.usbip()});
}

bool BoardRun::is_in_boot_loader() const { return !boot_loaders().empty(); }

bool BoardRun::start_from_boot_loader() {
  let_go_of_device();
  try {
    const auto loaders = boot_loaders();
    if (loaders.empty()) return false;
    const auto channel = device::open_boot_loader(loaders.front());
    firmware_update::BootLoader loader(*channel);
    loader.start();
    loader.leave();
    return true;
  } catch (const device::Error&) {
    return false;
  }
}

device::Vector3 BoardRun::true_position_m() {
  const auto truth = control_.truth();
  return {truth.at("true_position_x_m"), truth.at("true_position_y_m"), truth.at("true_position_z_m")};
}

}  // namespace inkwell::campaign
