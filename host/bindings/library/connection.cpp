#include "host/bindings/library/connection.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "firmware/control/settings.hpp"

#include "host/bindings/library/address.hpp"
#include "host/bindings/library/errors.hpp"
#include "host/bindings/library/pose_reader.hpp"

namespace inkwell::library {
namespace {

using namespace std::chrono_literals;

constexpr auto pose_timeout = 2ms;
constexpr auto search_interval = 200ms;
constexpr auto silence_limit = 2s;
static_assert(Turns::patience.servo < silence_limit);
/// A longer loop period counts as this time, because the process may have been suspended.
constexpr auto longest_wait = 50ms;

constexpr char silent[] = "No pose has arrived for 2 s. Reset the board, or let a paused virtual board run.";

/// Thrown if the library cannot use a reconnected board.
class CannotReturn : public Error {
 public:
  using Error::Error;
};

}  // namespace

Connection::Connection(const std::string& address, PoseFeed& poses, PoseReports& reports, Clock::duration timeout,
                       OnReport on_report)
    : poses_(poses), reports_(reports), on_report_(std::move(on_report)) {
  inherit_priority(geometry_mutex_);
  std::promise<void> opened;
  auto is_open = opened.get_future();
  thread_ = std::thread([this, address, promise = std::move(opened)]() mutable { run(address, std::move(promise)); });
  try {
    if (is_open.wait_for(timeout) == std::future_status::timeout)
      throw TimedOut("The device sends no poses. Reset the board, or let a paused virtual board run.");
    is_open.get();
  } catch (...) {
    end();
    throw;
  }
}

Connection::~Connection() { end(); }

void Connection::end() {
  {
    const std::lock_guard lock(end_mutex_);
    ends_ = true;
    end_changed_.notify_all();
  }
  poses_.leave_turns();
  thread_.join();
}

bool Connection::ends() const {
  const std::lock_guard lock(end_mutex_);
  return ends_;
}

void Connection::run(const std::string& address, std::promise<void> opened) {
  try {
    auto opening = open_arm(address, &poses_);
    arm_ = std::move(opening.arm);
    if (arm_.endpoint.is_virtual)
      poses_.take_turns(arm_.board ? Turns::of_own_boards() : std::make_shared<Turns>(false), opening.is_stepped);
    set_geometry(arm_.device->parameters());
    read_poses([&](const ReadPose& first) {
      // The stylus of a new virtual board is in the inkwell, so the board references its encoders.
      if (is_open_ || (arm_.board && (!first.is_referenced || first.pose.state == INKWELL_STARTING))) return;
      is_open_ = true;
      poses_.let_program_decide();
      opened.set_value();
    });
  } catch (const std::exception& error) {
    if (is_open_)
      poses_.lose(Loss::link, error.what());
    else
      opened.set_exception(std::current_exception());
  }
  while (is_open_ && reopen()) {
    try {
      read_poses([this, is_first = true](const ReadPose& read) mutable {
        if (!std::exchange(is_first, false)) return;
        poses_.let_program_decide();
        // The program must receive the error before the force is on again.
        if (read.pose.state == INKWELL_ACTIVE && poses_.uses_force())
          arm_.device->send(protocol::Command::disable_force);
      });
    } catch (const std::exception& error) {
      poses_.lose(Loss::link, error.what());
    }
  }
  {
    // The virtual board exits when this thread exits, because this thread created the board. Other threads may use the
    // device until `ends_` is set.
    std::unique_lock lock(end_mutex_);
    end_changed_.wait(lock, [this] { return ends_; });
  }
  const device::OpenArm let_go = std::move(arm_);  // destroys the device before its board
}

void Connection::read_poses(const OnPose& on_pose) {
  PoseReader reader;  // the board may have restarted
  reports_.start_link();
  Clock::duration silence{};
  auto before = Clock::now();
  bool drove = false, has_lost_claim = false;
  while (!ends() && poses_.begin_turn()) {
    arm_.device->keep_alive();
    const auto newest = reader.read_newest(*arm_.device, pose_timeout, geometry(), [this](const device::Pose& report) {
      reports_.take(report);
      on_report_(report);
    });
    const auto now = Clock::now();
    silence = newest ? Clock::duration() : silence + std::min<Clock::duration>(now - before, longest_wait);
    before = now;
    if (std::exchange(drove, arm_.device->drives()) && !drove) has_lost_claim = true;
    if (has_lost_claim) has_lost_claim = !drove && !report_lost_claim();
    if (newest) {
      poses_.publish(newest->pose, newest->is_referenced, newest->motion);
      on_pose(*newest);
    } else if (is_open_ && silence > silence_limit && poses_.loss() == Loss::none) {
      poses_.lose(Loss::silence, silent);
    }
  }
}

bool Connection::report_lost_claim() {
  std::optional<device::Driver> driver;
  if (!arm_.device->try_driver(driver)) return false;
  // If this program has released the arm, no loss is reported.
  if (driver && !driver->is_this_device)
    poses_.lose_claim(fmt::format("The arm was taken over by {}. That program now controls the force.",
                                  device::driver_text(*driver)));
  else if (!driver)
    poses_.lose_claim(
        "This program sent nothing for a second, so the board ended its claim to the arm. Switch the force on again.");
  return true;
}

// ---- reconnection ------------------------------------------------------------------------------------------

bool Connection::reopen() {
  for (;;) {
    {
      std::unique_lock lock(end_mutex_);
      if (end_changed_.wait_for(lock, search_interval, [this] { return ends_; })) return false;
    }
    try {
      if (try_to_reopen()) return true;
    } catch (const device::Incompatible& error) {
      poses_.lose(Loss::link, error.what());
    } catch (const CannotReturn& error) {
      poses_.lose(Loss::link, error.what());
    } catch (const std::exception&) {  // not connected yet; the cause of the loss is more informative
    }
  }
}

bool Connection::try_to_reopen() {
  auto endpoint = find_again();
  if (!endpoint) return false;
  endpoint->lock_step = arm_.endpoint.lock_step;
  endpoint->seed = arm_.endpoint.seed;
  const auto opened = device::Device::open(*endpoint);
  const auto serial_number = opened->information().serial_number;
  if (serial_number != arm_.endpoint.serial_number)
    throw CannotReturn(fmt::format(
        "Another arm, {}, is now at the address of the arm {}. Connect the previous arm again, or open the new arm.",
        serial_number, arm_.endpoint.serial_number));
  set_geometry(opened->parameters());
  arm_.device->take_link_of(*opened);
  return true;
}

std::optional<device::Endpoint> Connection::find_again() const {
  if (arm_.board && !arm_.board->is_running())
    throw CannotReturn("The virtual board of this arm has exited. Open the arm again.");
  if (arm_.board) return arm_.board->find();
  const auto found = device::find_arms(device::parse_address(device::address_of(arm_.endpoint)));
  // A server may export several boards. The position of the board in the list may have changed since the loss.
  const auto same =
      std::find_if(found.begin(), found.end(), [this](const auto& each) { return each.path == arm_.endpoint.path; });
  if (same != found.end()) return *same;
  return found.empty() ? std::nullopt : std::optional(found.front());
}

void Connection::connect_control(const std::string& address) {
  if (!arm_.endpoint.is_virtual) throw NotNow("This arm is not a simulation, so it has no simulated hand.");
  device::ControlClient client(device::parse_socket(address));
  client.status();  // throws if this is not a control socket
  const std::lock_guard lock(control_mutex_);
  arm_.control.emplace(std::move(client));
}

device::ControlClient& Connection::own_board() {
  if (!arm_.control)
    throw NotNow(
        "Only an arm that was opened as \"virtual\" has a simulated hand. For a running virtual board, connect the "
        "control socket first.");
  poses_.require_link();
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
