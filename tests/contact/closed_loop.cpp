#include "tests/contact/closed_loop.hpp"

#include <bit>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include "tests/firmware/control/simulated_arm.hpp"

namespace inkwell::closed_loop {
namespace {

using protocol::Parameter;
using protocol::Signal;

/// Time from the bus frame to the control period that uses a report: the main loop checks the report.
constexpr unsigned check_periods = 2;

arms::Description arm_with_hand(const LoopOptions& options) {
  arms::Description arm = options.has_arm_friction ? test::omni() : test::frictionless(test::omni());
  arm.simulation.probe_mass_kg += options.hand.mass_kg;
  arm.simulation.gravity_m_per_s2 = 0;
  return arm;
}

/// The force is on immediately, and the walls of the box are out of reach.
protocol::ParameterSet parameters_of(const arms::Description& arm, double tip_radius_m) {
  using enum protocol::Parameter;
  protocol::ParameterSet set = arm.parameters;
  set[sphere_radius_m] = static_cast<float>(tip_radius_m);
  set[force_ramp_s] = 0;
  set[host_timeout_s] = 2;
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = -0.5f;
  set[box_maximum_x_m] = set[box_maximum_y_m] = set[box_maximum_z_m] = 0.5f;
  return set;
}

/// Reading of the converter.
float digitized_V(double volts) {
  const auto step_V = static_cast<double>(board::adc_step_V);
  return static_cast<float>(std::floor(volts / step_V) * step_V);
}

test::Vector3 eigen(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

template <class Report>
std::span<const std::byte> bytes_of(const Report& report) {
  return std::as_bytes(std::span(&report, 1));
}

}  // namespace

ClosedLoop::ClosedLoop(const LoopOptions& options)
    : options_(options),
      arm_(arm_with_hand(options)),
      plant_(arm_, {.seed = options.seed}),
      parameters_(parameters_of(arm_, options.tip_radius_m)),
      settings_(control::prepare(parameters_)),
      controller_(tests::board_limits),
      random_(options.seed) {
  // The board measures the sensors' offsets and finds the inkwell.
  run(0.15);
  controller_.pass_self_test({});
  run(0.2);
  plant_.plant.hold(plant_.plant.arm().dynamics().position_m(plant_.plant.arm().joints_rad()), 800, 8);
  plant_.plant.dock(false);
  move_hand(options.start_m, 0.3);
  run(0.4);
  plant_.plant.hold(eigen(options.start_m), options.hand.stiffness_N_per_m, options.hand.damping_Ns_per_m);
  controller_.carry_out(tests::command(protocol::Command::enable_force));
  run(0.05);
  has_hand_ = true;
}

void ClosedLoop::place_shapes(const device::Shapes& shapes) {
  const protocol::ShapesReport report = device::shapes_report(shapes);
  if (requests_.accept_shapes(bytes_of(report)) != protocol::RequestResult::accepted)
    throw std::runtime_error("The board refused the shapes. Run at least one period between two calls.");
}

void ClosedLoop::publish(const std::shared_ptr<const contact::Scene>& scene) { publication_.publish(scene); }

void ClosedLoop::move_hand(const glm::dvec3& target_m, double duration_s) {
  plant_.plant.follow({{duration_s, eigen(target_m)}});
}

void ClosedLoop::run(double time_s) {
  for (auto left = std::lround(time_s * protocol::servo_rate_Hz); left > 0; --left) run_period();
}

void ClosedLoop::run_period() {
  received_model_ = false;
  const auto in_frame = static_cast<unsigned>(periods_ % periods_per_frame);
  if (in_frame == check_periods) pass_frame();
  step_board();
  if (in_frame == periods_per_frame - 1) record_pose();
  if (has_hand_ && !protocol::force_is_on(controller_.state()))
    throw std::runtime_error(
        "The board switched the force off: " + std::string(protocol::info(controller_.fault()).name) + ".");
}

control::Samples ClosedLoop::read_samples() {
  const auto& facts = plant_.facts;
  const auto is_closed = [&](board::Pin pin, protocol::Switch which) {
    return plant_.inputs.at(pin) == test::PinLevel::low ? static_cast<unsigned>(which) : 0u;
  };
  control::Samples samples = tests::samples_at_rest();
  for (unsigned motor = 0; motor < 3; ++motor) {
    samples.encoder_counts[motor] =
        static_cast<std::int32_t>(plant_.inputs.counts[motor] - plant_.counts_at_start[motor]);
    samples.current_A[motor] =
        (digitized_V(plant_.read_V(facts.motor_current[motor])) - board::shunt_amplifier_offset_V) /
        facts.shunt_V_per_A();
  }
  samples.supply_V = digitized_V(plant_.read_V(facts.supply)) * facts.supply_divider();
  samples.switches = static_cast<std::uint8_t>(is_closed(facts.inkwell_switch, protocol::Switch::inkwell));
  return samples;
}

// The duty cycles act one period after their computation.
void ClosedLoop::step_board() {
  if (auto* shapes = requests_.take_shapes()) controller_.replace_shapes(*shapes);
  if (auto* model = requests_.take_local_model()) {
    controller_.follow(*model);
    ++models_received_;
    received_model_ = true;
  }
  const control::Triple acting = drive_.duty;
  tests::FakeClock clock;
  drive_ = controller_.step(read_samples(), settings_, clock);
  controller_.finish(clock);
  requests_.note_proxy(controller_.proxy_m(), controller_.depth_m());
  controller_.write_signals(signals_);
  plant_.set_enable(drive_.enabled);
  constexpr double period_s = 1.0 / protocol::servo_rate_Hz;
  if (drive_.enabled)
    plant_.run(period_s,
               {static_cast<double>(acting[0]), static_cast<double>(acting[1]), static_cast<double>(acting[2])});
  else
    plant_.idle(period_s);
  ++periods_;
}

/// A bus frame delivers the report that the PC sent in the previous frame. The PC answers the poses of this frame.
void ClosedLoop::pass_frame() {
  ++frame_;
  controller_.host_alive();
  if (busy_frames_ > 0) {
    --busy_frames_;
    return;
  }
  deliver_model();
  answer_poses();
}

void ClosedLoop::deliver_model() {
  if (!sent_) return;
  const protocol::LocalModelReport report = *sent_;
  sent_.reset();
  if (happens(options_.lost_part)) return;
  if (!requests_.accept_local_model(bytes_of(report), true, frame_))
    throw std::runtime_error("The board refused a local model.");
}

/// The report of the next bus frame has this pose.
void ClosedLoop::record_pose() {
  if (happens(options_.lost_part)) return;
  device::Pose& pose = poses_.emplace_back();
  pose.state = controller_.state();
  pose.limits = controller_.limits();
  pose.is_referenced = controller_.is_referenced();
  pose.sequence = frame_ + 1;
  pose.time_periods = static_cast<std::int64_t>(periods_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = [&](Signal first) { return signals_.values[static_cast<std::size_t>(first) + axis]; };
    pose.position_m[axis] = value(Signal::position_x_m);
    pose.force_N[axis] = value(Signal::force_x_N);
    pose.gimbal_rad[axis] = value(Signal::gimbal_1_rad);
    pose.joint_rad[axis] = value(Signal::joint_1_rad);
  }
}

/// The PC answers the newest pose. It is busy until it sends the answer.
void ClosedLoop::answer_poses() {
  for (std::size_t number = 0; number < poses_.size(); ++number) {
    const device::Pose& pose = poses_[number];
    const bool is_first = std::exchange(is_first_pose_, false);
    const auto model = servo_.step({pose, parameters_, 1, is_first, number + 1 == poses_.size()});
    if (!model) continue;
    const auto pose_sequence = static_cast<std::uint32_t>(pose.sequence);
    sent_ = device::local_model_report(*model, {.mode = protocol::ForceMode::none, .pose_sequence = pose_sequence});
    sent_->sequence = sequence_++;
    sent_->pose_sequence = static_cast<std::uint16_t>(pose_sequence);
  }
  poses_.clear();
  busy_frames_ = static_cast<unsigned>(random_() % (options_.longest_answer_ms + 1));
  if (happens(options_.gaps_per_s * (busy_frames_ + 1) / 1000)) busy_frames_ = options_.gap_ms;
}

glm::dvec3 ClosedLoop::vector(Signal first) const {
  const auto at = [&](std::size_t axis) {
    return static_cast<double>(signals_.values[static_cast<std::size_t>(first) + axis]);
  };
  return {at(0), at(1), at(2)};
}

glm::dvec3 ClosedLoop::proxy_m() const {
  const control::Vector3& proxy_m = controller_.proxy_m();
  return {static_cast<double>(proxy_m.x), static_cast<double>(proxy_m.y), static_cast<double>(proxy_m.z)};
}

double ClosedLoop::speed_m_per_s() const {
  const auto& arm = plant_.plant.arm();
  return (arm.dynamics().jacobian_m(arm.joints_rad()) * arm.joint_speeds_rad_s()).norm();
}

}  // namespace inkwell::closed_loop
