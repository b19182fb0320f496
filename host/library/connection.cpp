#include "connection.hpp"

#include <utility>

#include <control/settings.hpp>

#include "address.hpp"
#include "errors.hpp"
#include "pose_reader.hpp"

namespace inkwell::library {
namespace {

using namespace std::chrono_literals;

constexpr double first_pose_limit_s = 60.0;
constexpr auto read_timeout = 2ms;

}  // namespace

Connection::Connection(const std::string& address, PoseFeed& poses) : poses_(poses) {
  std::promise<void> opened;
  auto is_open = opened.get_future();
  thread_ = std::thread([this, address, promise = std::move(opened)]() mutable { run(address, std::move(promise)); });
  try {
    is_open.get();
  } catch (...) {
    ends_ = true;
    ends_.notify_all();
    thread_.join();
    throw;
  }
}

Connection::~Connection() {
  ends_ = true;
  ends_.notify_all();
  thread_.join();
}

void Connection::run(const std::string& address, std::promise<void> opened) {
  bool is_open = false;
  try {
    arm_ = open_arm(address);
    set_geometry(arm_.device->parameters());
    read_poses(opened, is_open);
  } catch (const std::exception& error) {
    if (is_open)
      poses_.end(error.what());
    else
      opened.set_exception(std::current_exception());
  }
  ends_.wait(false);  // a board of its own ends with the thread that made it, and others may still ask the device
  const device::OpenArm let_go = std::move(arm_);  // the device before its board
}

void Connection::read_poses(std::promise<void>& opened, bool& is_open) {
  const auto give_up_at = in(first_pose_limit_s);
  PoseReader reader;
  while (!ends_) {
    if (const auto newest = reader.read_newest(*arm_.device, read_timeout, geometry())) {
      const auto& [pose, is_referenced] = *newest;
      poses_.publish(pose, is_referenced);
      // A board of its own has its stylus in the inkwell until the program moves the hand.
      if (!is_open && (!arm_.board || (is_referenced && pose.state != INKWELL_STARTING))) {
        is_open = true;
        opened.set_value();
      }
    }
    arm_.device->keep_alive();
    if (!is_open && Clock::now() > give_up_at)
      throw TimedOut("The device sends no poses. Reset the board, or let a paused virtual board run.");
  }
}

device::ControlClient& Connection::own_board() {
  if (!arm_.control) throw NotNow("Only an arm that was opened as \"virtual\" has a simulated hand.");
  poses_.require_open();
  return *arm_.control;
}

control::Arm Connection::geometry() const {
  const std::lock_guard lock(geometry_mutex_);
  return geometry_;
}

void Connection::set_geometry(const protocol::ParameterSet& parameters) {
  const auto prepared = control::prepare(parameters).arm;
  const std::lock_guard lock(geometry_mutex_);
  geometry_ = prepared;
}

}  // namespace inkwell::library
