#include "host/bindings/library/arm.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/board_store.hpp"
#include "host/client/device/clear_fault.hpp"
#include "host/client/device/fault_text.hpp"
#include "host/client/device/hand_events.hpp"
#include "host/feel/device_model.hpp"

#include "host/bindings/library/errors.hpp"

namespace inkwell::library {
namespace {

using protocol::Command;

constexpr std::string_view by_another_program = ", by another program";

/// The library repeats an unanswered enable_force command after this board time.
constexpr double retry_s = 0.1;

/// Without a pose for this time, the library considers the board silent.
constexpr double silence_s = 2.0;

std::int64_t periods_of(const inkwell_pose& pose) { return std::llround(pose.time_s * protocol::servo_rate_Hz); }

/// Extracts the fault information from a library pose.
device::ShownFault shown_fault(const inkwell_pose& pose) {
  const auto state = pose.state == INKWELL_FAULT      ? protocol::State::fault
                     : pose.state == INKWELL_STARTING ? protocol::State::testing
                                                      : protocol::State::ready;
  return {periods_of(pose), state, static_cast<protocol::Fault>(pose.fault)};
}

void refuse_in_fault(const inkwell_pose& pose) {
  if (pose.state == INKWELL_FAULT) throw NotNow(device::fault_line(static_cast<protocol::Fault>(pose.fault)));
}

Clock::duration duration_of(double timeout_s) {
  constexpr double longest_s = 1e6;
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::min(checked_timeout_s(timeout_s), longest_s)));
}

}  // namespace

Arm::Arm(const std::string& address, double timeout_s)
    : scene_([this](const contact::Scene& scene) { return place_materials(scene); }),
      connection_(address, poses_, reports_, duration_of(timeout_s),
                  [this](const device::Pose& report) { feel_scene(report); }),
      force_(connection_.device(), poses_),
      scope_(connection_.device(), poses_, reports_),
      parameter_watch_([this] { note_foreign_changes(); }),
      servo_(
          poses_, [this](const auto& force_N, std::uint32_t pose_sequence) { drive(force_N, pose_sequence); },
          [this] { force_.let_go(); }, &reports_) {
  inherit_priority(claim_mutex_);
}

Arm::~Arm() {
  servo_.request_end();
  scene_.stop();
  force_.stop();  // discards later forces of a servo that is still running
  if (connection_.device().drives() && poses_.loss() != Loss::link) bid_farewell();
}

void Arm::bid_farewell() {
  auto& device = connection_.device();
  poses_.expect_force_off();
  try {
    device.send_force({.mode = protocol::ForceMode::none});
    device.place_shapes({});
    // The board raises a fault if USB disconnects while the force is on. Over USB/IP, the exit of the last program
    // disconnects USB.
    device.disable_force();
    device.release();
  } catch (const Error&) {  // the device is already gone, and so is its force
  }
}

device::Device& Arm::device() {
  poses_.require_poses();
  return connection_.device();
}

device::Device& Arm::linked_device() {
  poses_.require_link();
  return connection_.device();
}

// ---- pose --------------------------------------------------------------------------------------------------

inkwell_pose Arm::pose() const {
  inkwell_pose pose;
  read([&](const PoseFeed::Seen& last) { pose = last.pose; });
  return pose;
}

inkwell_pose Arm::wait_for_pose(double timeout_s, std::optional<std::uint32_t> after_sequence,
                                Turns::Answer answer) const {
  const std::uint32_t seen = after_sequence.value_or(last().pose.sequence);
  bool is_new = false;
  const auto next =
      poses_.wait([&](const auto& newest, Loss loss) { return is_new = loss == Loss::none && newest.sequence != seen; },
                  checked_timeout_s(timeout_s), answer);
  if (!is_new) throw TimedOut("No pose arrived in time. Reset the board, or let a paused virtual board run.");
  return next;
}

void Arm::sleep(double duration_s) const {
  constexpr double rounding_s = 1e-6;  // tolerance for times that are multiples of a control period
  inkwell_pose now = pose();
  const double end_s = now.time_s + checked_timeout_s(duration_s) - rounding_s;
  while (now.time_s < end_s) {
    const double before_s = now.time_s;
    now = poses_.wait([&](const auto& newest, Loss) { return newest.time_s >= end_s; }, silence_s);
    if (now.time_s == before_s)
      throw TimedOut("No pose arrived for 2 s. Reset the board, or let a paused virtual board run.");
  }
}

control::Pose Arm::forward_kinematics(const control::Triple& joint_rad) const {
  return control::forward_kinematics(joint_rad, connection_.geometry());
}

// ---- force -------------------------------------------------------------------------------------------------

void Arm::enable_force(double timeout_s) {
  const double limit_s = checked_timeout_s(timeout_s);
  clear_inherited_fault();
  refuse_in_fault(pose());
  claim();
  poses_.use_force();
  poses_.forget_lost_force();
  for (double waited_s = 0;;) {
    // The command is repeated, because a board with unreferenced encoders ignores the command.
    device().carry_out(Command::enable_force);
    const double wait_s = std::min(limit_s - waited_s, retry_s);
    const auto now = poses_.wait(
        [](const auto& newest, Loss) { return newest.state == INKWELL_ACTIVE || newest.state == INKWELL_FAULT; },
        wait_s);
    if (now.state == INKWELL_ACTIVE) return;
    refuse_in_fault(now);
    waited_s += wait_s;
    if (waited_s < limit_s) continue;
    if (now.state == INKWELL_UNREFERENCED)
      throw NotNow("The encoders are not referenced. Put the stylus into the inkwell once, then try again.");
    throw TimedOut("The device did not switch the force on in time. Try again.");
  }
}

// A silent board may still receive the command.
void Arm::disable_force() {
  expecting_force_off([this] { linked_device().disable_force(); });
}

void Arm::stop() {
  expecting_force_off([this] { linked_device().stop(); });
}

/// Clears a fault if a previous program or a lost link caused the fault.
void Arm::clear_inherited_fault() {
  const auto now = shown_fault(pose());
  if (now.state == protocol::State::fault && device::is_left_by_a_host(now.fault) && !poses_.had_force()) clear_fault();
}

void Arm::clear_fault() {
  poses_.forget_lost_force();
  inkwell_pose seen = pose();
  device::clear_fault(device(), shown_fault(seen), [&] {
    seen = wait_for_pose(silence_s, seen.sequence);
    return shown_fault(seen);
  });
}

void Arm::claim() {
  const auto is_done = [this] { return connection_.device().drives() && !scene_.lacks_materials(); };
  if (is_done()) return;
  const std::lock_guard lock(claim_mutex_);
  if (is_done()) return;
  if (!connection_.device().drives()) {
    forget_shapes();
    device().claim();
  }
  prepare_scene();
}

void Arm::forget_shapes() {
  scene_.forget_materials();
  const std::lock_guard lock(shapes_mutex_);
  placed_shapes_ = {};
}

void Arm::prepare_scene() {
  if (!scene_.is_used()) return;
  scene_.set_parameters(device().parameters());
  scene_.send_materials();
}

void Arm::release() {
  if (servo_.is_running()) throw NotNow("A servo is running on this arm. Stop the servo, then release the arm.");
  const std::lock_guard lock(claim_mutex_);
  if (!connection_.device().drives()) return;
  expecting_force_off([this] {
    force_.let_go();
    device().place_shapes({});
    device().disable_force();
  });
  forget_shapes();
  poses_.stop_using_force();
  device().release();
}

void Arm::set_thread_priority(int priority) {
  const int highest = sched_get_priority_max(SCHED_FIFO);
  if (priority < 0 || priority > highest)
    throw BadArgument(
        fmt::format("{} is not a thread priority. Give 1 to {}, or 0 for a normal thread.", priority, highest));
  connection_.set_thread_priority(priority);
  force_.set_thread_priority(priority);
  servo_.set_thread_priority(priority);
}

void Arm::take_over() {
  const std::lock_guard lock(claim_mutex_);
  if (!connection_.device().drives()) forget_shapes();
  device().take_over();
  prepare_scene();
}

void Arm::drive(const double (&force_N)[3], std::uint32_t pose_sequence) {
  poses_.require_poses();
  poses_.require_force();
  claim();
  poses_.use_force();
  force_.send(force_N, pose_sequence);
}

void Arm::place_shapes(const device::Shapes& shapes) {
  claim();
  {
    const std::lock_guard lock(shapes_mutex_);
    device().place_shapes(shapes);
    placed_shapes_ = shapes;
    shapes_placed_at_s_ = last().pose.time_s;
  }
  if (scope_.is_recording()) scope_.note(device::events_of_shapes(shapes, periods_of(last().pose)));
}

// ---- scene -------------------------------------------------------------------------------------------------

std::uint32_t Arm::add_object(contact::Object object, const contact::Material& material) {
  if (!scene_.is_used()) scene_.set_parameters(device().parameters());
  return scene_.add(std::move(object), material);
}

bool Arm::place_materials(const contact::Scene& scene) {
  if (!connection_.device().drives()) return false;
  const std::lock_guard lock(shapes_mutex_);
  device::Shapes shapes = living_shapes();
  shapes.materials = feel::device_materials(scene);
  device().place_shapes(shapes);
  return true;
}

device::Shapes Arm::living_shapes() const {
  const auto passed_s = static_cast<float>(last().pose.time_s - shapes_placed_at_s_);
  const auto has_expired = [&](device::Surface& surface) {
    surface.life_s -= passed_s;
    return surface.life_s < protocol::servo_period_s;
  };
  device::Shapes shapes = placed_shapes_;
  for (auto& plane : shapes.planes)
    if (plane && has_expired(plane->surface)) plane.reset();
  if (shapes.sphere && has_expired(shapes.sphere->surface)) shapes.sphere.reset();
  std::erase_if(shapes.solids, [&](device::Solid& solid) { return has_expired(solid.surface); });
  return shapes;
}

void Arm::feel_scene(const device::Pose& report) {
  if (!scene_.is_used()) return;
  scene_.follow(report, connection_.device().drives(), [&](const Scene::Model& model) {
    force_.send_model(model.model, static_cast<std::uint32_t>(report.sequence), model.force_life_s);
  });
}

void Arm::follow_parameters() {
  if (scene_.is_used()) scene_.set_parameters(device().parameters());
}

void Arm::start_servo(Servo::Function function) {
  claim();
  poses_.require_poses();
  poses_.use_force();
  poses_.forget_lost_force();
  servo_.start(std::move(function));
}

// ---- parameters --------------------------------------------------------------------------------------------

template <class Change>
void Arm::note_change(Change change) {
  if (!scope_.is_recording()) {
    change();
    return;
  }
  const auto before = device().parameters();
  if (!poses_.is_stepped())
    scope_.note(device::events_of_change(recorded_parameters_, before, std::nullopt, by_another_program));
  const std::optional<std::int64_t> at_periods = change();
  recorded_parameters_ = device().parameters();
  scope_.note(device::events_of_change(before, recorded_parameters_, at_periods));
}

void Arm::note_foreign_changes() {
  const std::lock_guard lock(parameters_mutex_);
  if (!scope_.is_recording()) return;
  try {
    const auto now = device().parameters();
    scope_.note(device::events_of_change(recorded_parameters_, now, std::nullopt, by_another_program));
    recorded_parameters_ = now;
  } catch (const Error&) {  // the link is lost, or the board is busy
  }
}

void Arm::set_parameters(const std::vector<device::ParameterChange>& changes) {
  const std::lock_guard lock(parameters_mutex_);
  note_change([&] { return device().set_parameters(changes).applied_at_periods; });
  const bool changes_arm =
      std::any_of(changes.begin(), changes.end(), [](const auto& change) { return info(change.first).belongs_to_arm; });
  if (changes_arm) connection_.set_geometry(device().parameters());
  follow_parameters();
}

void Arm::restore_parameters() {
  const std::lock_guard lock(parameters_mutex_);
  note_change([&] { return device().restore_stored_parameters().applied_at_periods; });
  connection_.set_geometry(device().parameters());
  follow_parameters();
}

void Arm::factory_reset() {
  const std::lock_guard lock(parameters_mutex_);
  note_change([&]() -> std::optional<std::int64_t> {
    device::factory_reset(device());
    return std::nullopt;
  });
  connection_.set_geometry(device().parameters());
  follow_parameters();
}

// ---- recordings and losses ---------------------------------------------------------------------------------

void Arm::describe_recordings(std::string name, std::string note) {
  const std::lock_guard lock(texts_mutex_);
  recording_name_ = std::move(name);
  recording_note_ = std::move(note);
}

void Arm::start_recording(const std::string& path) {
  recording::Origin origin{
      .name = {}, .note = {}, .image = connection_.image(), .arm_description = connection_.arm_description()};
  {
    const std::lock_guard lock(texts_mutex_);
    origin.name = recording_name_;
    origin.note = recording_note_;
  }
  const std::lock_guard lock(parameters_mutex_);
  const auto parameters = device().parameters();
  scope_.start_recording(path, parameters, endpoint().is_virtual, origin);
  recorded_parameters_ = parameters;
  if (!poses_.is_stepped()) parameter_watch_.begin();
}

recording::RecorderStatus Arm::stop_recording() {
  parameter_watch_.end();
  if (!poses_.is_stepped()) note_foreign_changes();  // of the last half second
  return scope_.stop_recording();
}

void Arm::send_test_pulse(protocol::Command command, const protocol::TestPulse& pulse) {
  const auto now = pose();
  refuse_in_fault(now);
  if (now.state != INKWELL_READY)
    throw NotNow("Test pulses need the state ready. Put the stylus into the inkwell once, and switch the force off.");
  claim();
  device().carry_out(command, pulse);
}

}  // namespace inkwell::library
