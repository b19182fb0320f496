#include "host/bindings/dropins/device.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "host/bindings/dropins/errors.hpp"

namespace inkwell::dropins {
namespace {

using namespace std::chrono_literals;

constexpr double motor_value_full = 32767.0;
/// Period of the motor heat readings, and period of the arm state checks.
constexpr auto heat_period = 500ms, care_period = 20ms;
constexpr double enable_timeout_s = 1.0;
/// Filter weight of a new angular velocity sample at 1000 samples per second.
constexpr double angular_smoothing = 0.125;
/// Below this speed the probe counts as stationary.
constexpr double rest_m_per_s = 0.1;

// After these faults the force returns automatically when the probe is stationary.
bool passes(int fault) { return fault == INKWELL_FAULT_OVER_SPEED || fault == INKWELL_FAULT_HOST_SILENT; }

/// Returns true if the board has accepted or refused the request. After a link error, the decision of the board is
/// unknown.
bool is_judged(inkwell_result result) { return result == INKWELL_OK || result == INKWELL_REFUSED; }

/// The board raises these faults if a program exits or sends no forces while the force is on.
bool is_of_a_host(int fault) { return fault == INKWELL_FAULT_USB_GONE || fault == INKWELL_FAULT_HOST_SILENT; }

double speed_m_per_s(const inkwell_pose& pose) {
  return std::hypot(pose.velocity_m_s[0], pose.velocity_m_s[1], pose.velocity_m_s[2]);
}

/// Returns the rotation vector between two attitudes, for small angles.
Vector turn_rad(const double (&from)[9], const double (&to)[9]) {
  const auto turn = [&](int row, int column) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += to[3 * row + i] * from[3 * column + i];
    return sum;
  };
  return {0.5 * (turn(2, 1) - turn(1, 2)), 0.5 * (turn(0, 2) - turn(2, 0)), 0.5 * (turn(1, 0) - turn(0, 1))};
}

}  // namespace

bool* Capabilities::find(Enum value) {
  switch (value) {
#define X(code, name, text, at_start) \
  case code: return &(name);
    INKWELL_HD_CAPABILITIES(X)
#undef X
    default: return nullptr;
  }
}

Device::Device(Handle handle, std::string name, const std::string& address)
    : handle_(handle), name_(std::move(name)), address_(address) {
  inkwell_arm* opened = nullptr;
  require(inkwell_open(address.c_str(), &opened));
  arm_.reset(opened);
  require(inkwell_get_information(arm(), &information_));
  facts_ = read_facts(arm());
  claim();
  poll();
  before_ = now_;
  care_thread_ = std::thread([this] { care(); });
}

/// HDAPI reserves a device for one program. The force of a new device is off. A force or a fault of a previous program
/// must not affect this program.
void Device::claim() {
  const double none_N[3]{};
  require(inkwell_set_force(arm(), none_N));  // reports another driver now instead of with the first force
  inkwell_pose pose;
  require(inkwell_get_pose(arm(), &pose));
  if (pose.state == INKWELL_ACTIVE) require(inkwell_disable_force(arm()));
  if (pose.state == INKWELL_FAULT && is_of_a_host(pose.fault)) inkwell_clear_fault(arm());
}

Device::~Device() {
  if (!care_thread_.joinable()) return;
  {
    const std::lock_guard lock(care_mutex_);
    ends_ = true;
    care_changed_.notify_one();
  }
  care_thread_.join();
}

void Device::raise(ErrorCode code, const std::string& sentence, int internal_code) const {
  dropins::raise(code, handle_, sentence, internal_code);
}

// ---- frames ------------------------------------------------------------------------------------------------

void Device::begin_frame(std::optional<std::uint64_t> tick) {
  if (in_frame_) return raise(illegal_begin);
  if (tick && begun_in_tick_ == tick && capabilities.one_frame_limit) return raise(illegal_begin);
  in_frame_ = true;
  begun_in_tick_ = tick;
  poll();
  note_condition();
}

void Device::poll() {
  Moment seen;
  seen.pose = now_.pose;
  const auto result = inkwell_get_pose(arm(), &seen.pose);  // the last known pose if the link is lost
  is_lost_ = result != INKWELL_OK;
  seen.angular_velocity_rad_per_s = now_.angular_velocity_rad_per_s;
  const double passed_s = seen.pose.time_s - now_.pose.time_s;
  if (is_lost_) {
    raise(comm_error, inkwell_error_text(), result);
    held_ = {};
    had_force_ = false;
  } else if (passed_s > 0.0 && now_.pose.time_s > 0.0) {
    const Vector turned_rad = turn_rad(now_.pose.rotation, seen.pose.rotation);
    const double part = 1.0 - std::pow(1.0 - angular_smoothing, passed_s * 1e3);
    for (std::size_t i = 0; i < 3; ++i)
      seen.angular_velocity_rad_per_s[i] += part * (turned_rad[i] / passed_s - seen.angular_velocity_rad_per_s[i]);
  }
  before_ = std::exchange(now_, seen);
}

bool Device::sends_poses() const {
  inkwell_pose pose;
  return inkwell_get_pose(arm(), &pose) == INKWELL_OK;
}

/// Returns true if a previous program or a lost link caused the fault.
bool Device::is_inherited(int fault) const { return is_of_a_host(fault) && !had_force_; }

/// Raises an error for each new condition.
void Device::note_condition() {
  const int fault = !is_lost_ && now_.pose.state == INKWELL_FAULT ? now_.pose.fault : 0;
  if (fault != 0) held_ = {};
  if (std::exchange(fault_, fault) != fault && fault != 0 && !is_inherited(fault))
    raise(fault == INKWELL_FAULT_OVER_SPEED ? exceeded_max_velocity : force_error, inkwell_fault_text(fault), fault);
  const bool is_warm =
      *std::max_element(std::begin(motor_heat_), std::end(motor_heat_)) >= INKWELL_MOTOR_HEAT_HOLDS_BACK;
  if (!std::exchange(was_warm_, is_warm) && is_warm) raise(warm_motors);
}

std::optional<Vector> Device::demanded_force(const Command& command, const inkwell_pose& pose) const {
  if (command.motor_values && (command.force_N || command.joint_torque_mNm)) return std::nullopt;
  if (command.motor_values) {
    Vector torque_Nm;
    for (std::size_t i = 0; i < 3; ++i)
      torque_Nm[i] = (*command.motor_values)[i] / motor_value_full * facts_.joint_torque_full_Nm[i];
    return force_of_torques(arm(), pose, torque_Nm);
  }
  if (command.joint_torque_mNm) {
    const Vector& torque = *command.joint_torque_mNm;
    return force_of_torques(arm(), pose, {1e-3 * torque[0], 1e-3 * torque[1], 1e-3 * torque[2]});
  }
  return command.force_N.value_or(Vector{});
}

void Device::end_frame() {
  if (!std::exchange(in_frame_, false)) return raise(illegal_end);
  was_frame_in_tick_ = true;
  if (now_.command.has_output()) held_ = now_.command;
  if (is_lost_ || !wants_force()) held_ = {};
  now_.command.force_N = send(now_.command.has_output() ? now_.command : held_, now_.pose);
}

void Device::renew_force() {
  if (std::exchange(was_frame_in_tick_, false) || in_frame_ || !held_.has_output()) return;
  inkwell_pose pose;
  if (inkwell_get_pose(arm(), &pose) != INKWELL_OK || pose.state == INKWELL_FAULT)
    held_ = {};
  else
    send(held_, pose);
}

Vector Device::send(const Command& command, const inkwell_pose& pose) {
  auto demanded_N = demanded_force(command, pose);
  if (!demanded_N) {
    held_ = {};
    raise(force_error);
  }
  const ForceDemand demand{demanded_N.value_or(Vector{}), speed_m_per_s(pose), pose.time_s,
                           wants_force() && !is_lost_ && pose.state == INKWELL_ACTIVE && pose.in_inkwell == 0};
  const ForceLimits limits{.maximum_N = facts_.force_maximum_N,
                           .speed_m_per_s = 1e-3 * settings.velocity_limit_mm_per_s,
                           .change_N_per_ms = settings.impulse_limit_N_per_ms,
                           .ramp_N_per_s = settings.ramping_rate_N_per_s,
                           .clamps = capabilities.max_force_clamping,
                           .ramps = capabilities.force_ramping,
                           .limits_force = capabilities.software_force_limit,
                           .limits_speed = capabilities.velocity_limit,
                           .limits_change = capabilities.impulse_limit};
  const auto answer = guard_.step(demand, limits);
  if (std::exchange(dropped_for_, answer.error) != answer.error && answer.error != success) raise(answer.error);
  if (!wants_force() || is_lost_) return answer.force_N;
  const auto result = inkwell_set_force(arm(), answer.force_N.data());
  // For a lost link or a reported fault, FORCE_ERROR is not raised.
  const bool is_new = result != INKWELL_FORCE_LOST || !is_force_loss_reported_;
  is_force_loss_reported_ = result == INKWELL_FORCE_LOST;
  if (result == INKWELL_OK) return answer.force_N;
  held_ = {};
  const bool is_fault_reported = pose.state == INKWELL_FAULT && !is_inherited(pose.fault);
  const bool is_reported_otherwise =
      result == INKWELL_DISCONNECTED || (result == INKWELL_FORCE_LOST && is_fault_reported);
  if (is_new && !is_reported_otherwise) raise(force_error, inkwell_error_text(), result);
  return {};
}

Calibration Device::calibration() {
  inkwell_pose pose;
  int is_referenced = 0;
  auto result = inkwell_is_referenced(arm(), &is_referenced);
  if (result == INKWELL_OK) result = inkwell_get_pose(arm(), &pose);
  if (result != INKWELL_OK) {
    raise(comm_error, inkwell_error_text(), result);
    return calibration_needs_manual_input;
  }
  // The board does not reference the encoders during a fault.
  const bool is_about_to_be = pose.in_inkwell != 0 && pose.state != INKWELL_FAULT;
  return is_referenced != 0 ? calibration_ok
         : is_about_to_be   ? calibration_needs_update
                            : calibration_needs_manual_input;
}

// ---- force output ---------------------------------------------------------------------------------------------------

void Device::set_scheduler_runs(bool runs) {
  scheduler_runs_ = runs;
  if (runs) had_force_ = false;
  follow_force_output();
}

void Device::follow_force_output() {
  if (!wants_force()) held_ = {};
  const std::lock_guard lock(care_mutex_);
  force_is_wanted_ = wants_force();
  force_is_requested_ = force_is_wanted_;
  fault_is_to_be_cleared_ = force_is_wanted_;
  off_problem_.reset();
  care_changed_.notify_one();
}

void Device::wait_until_force_is_off() {
  std::unique_lock lock(care_mutex_);
  off_known_.wait(lock, [this] { return force_is_wanted_ || off_problem_; });
  if (force_is_wanted_ || off_problem_->empty()) return;
  const auto problem = *off_problem_;
  lock.unlock();
  raise(comm_error, problem);
}

void Device::care() {
  using Clock = std::chrono::steady_clock;
  auto heat_at = Clock::now();
  bool switched_on = false, is_on = false, lets_fall = false, clears = false;
  std::unique_lock lock(care_mutex_);
  while (!ends_) {
    const bool wanted = force_is_wanted_;
    clears = std::exchange(fault_is_to_be_cleared_, false) || (clears && wanted);
    bool asked_for = force_is_requested_;
    lock.unlock();
    inkwell_pose pose;
    // If the link is lost, the next frame reports the error. If the arm is not ready, the next pass of this loop tries
    // again.
    const bool is_lost = inkwell_get_pose(arm(), &pose) != INKWELL_OK;
    // inkwell_wait_for_pose() returns a time-out if the board is silent, and INKWELL_DISCONNECTED if the link is lost.
    const bool is_link_lost = is_lost && inkwell_wait_for_pose(arm(), 0.0, &pose) == INKWELL_DISCONNECTED;
    std::string off_problem = is_link_lost ? inkwell_error_text() : "";
    // If another program, a permanent fault or a lost link has switched the force off, the force stays off. The program
    // must request the force again.
    const bool was_on = is_on;
    if (!is_lost || is_link_lost) is_on = !is_lost && pose.state == INKWELL_ACTIVE;
    const bool passes_by = !is_lost && pose.state == INKWELL_FAULT && passes(pose.fault);
    const bool is_over = was_on && !is_on;
    const bool is_taken = is_link_lost || (is_over && !passes_by && !lets_fall);
    if (is_taken && !clears) asked_for = false;
    if (is_on && wanted) asked_for = had_force_ = true;
    if (is_over) lets_fall = false;
    if (is_link_lost) clears = false;
    if (!is_lost) {
      bool is_cleared = true;
      if (pose.state == INKWELL_FAULT && wanted &&
          (clears || (asked_for && passes_by && speed_m_per_s(pose) < rest_m_per_s)))
        is_cleared = is_judged(inkwell_clear_fault(arm()));
      // After a link error, the next pass of the loop repeats the clear request.
      if (is_cleared) clears = false;
      if (pose.state == INKWELL_READY && wanted && asked_for &&
          inkwell_enable_force(arm(), enable_timeout_s) == INKWELL_OK)
        switched_on = is_on = had_force_ = true;
      inkwell_information information;
      if (Clock::now() >= heat_at && inkwell_get_information(arm(), &information) == INKWELL_OK) {
        std::copy_n(information.motor_heat, 3, motor_heat_);
        heat_at = Clock::now() + heat_period;
      }
    }
    if (!wanted && switched_on && is_on) {
      if (inkwell_disable_force(arm()) == INKWELL_OK) {
        switched_on = false;
        lets_fall = is_on;
      } else {
        off_problem = inkwell_error_text();
      }
    }
    if (!is_on) switched_on = false;
    lock.lock();
    if (!wanted && !force_is_wanted_) {
      off_problem_ = off_problem;
      off_known_.notify_all();
    }
    if (force_is_wanted_ == wanted && !fault_is_to_be_cleared_) force_is_requested_ = asked_for;
    care_changed_.wait_for(lock, care_period, [&] {
      return ends_ || force_is_wanted_ != wanted || fault_is_to_be_cleared_ || (!force_is_wanted_ && !off_problem_);
    });
  }
}

}  // namespace inkwell::dropins
