// The closed loop of contact in one process: arm and hand of the virtual board, the control code of the firmware, and
// the servo of the PC. USB is replaced by a delay. Reports are encoded and decoded as on USB.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>

#include <glm/vec3.hpp>

#include "firmware/control/controller.hpp"
#include "firmware/link/program_requests.hpp"
#include "host/client/device/program_force.hpp"
#include "host/contact/publication.hpp"
#include "host/feel/servo.hpp"
#include "tests/boards/virtual/plant/driven_plant.hpp"

namespace inkwell::closed_loop {

/// Impedance of a hand. The mass moves with the tip.
struct HandModel {
  double stiffness_N_per_m, damping_Ns_per_m, mass_kg;
};
inline constexpr HandModel light_hand{30, 0.3, 0};
inline constexpr HandModel firm_hand{600, 8, 0.1};

inline constexpr unsigned periods_per_frame = protocol::servo_rate_Hz / 1000;

struct LoopOptions {
  HandModel hand = light_hand;
  bool has_arm_friction = true;
  double tip_radius_m = 0.005;
  glm::dvec3 start_m{0, 0, -0.03};
  /// The PC computes a model for 0 to this time. A model acts 1.15 ms after its pose, or later by this time.
  unsigned longest_answer_ms = 2;
  double lost_part = 0;   ///< of the reports in each direction
  double gaps_per_s = 0;  ///< rate of the times in which the PC does not answer
  unsigned gap_ms = 10;
  std::uint64_t seed = 1;
};

/// The force is on, and the hand holds the tip at `start_m`. The arm has no weight, because the hand carries it.
class ClosedLoop {
 public:
  explicit ClosedLoop(const LoopOptions& options);

  /// Shapes that the board renders without the PC.
  void place_shapes(const device::Shapes& shapes);
  /// Scene of the servo.
  void publish(const std::shared_ptr<const contact::Scene>& scene);
  /// Moves the target of the hand with minimum jerk.
  void move_hand(const glm::dvec3& target_m, double duration_s);
  /// Throws std::runtime_error if the board switches the force off.
  void run_period();
  void run(double time_s);

  std::uint64_t periods() const { return periods_; }
  const control::Controller& controller() const { return controller_; }
  /// Results of the last period on the board.
  glm::dvec3 probe_m() const { return vector(protocol::Signal::position_x_m); }
  glm::dvec3 velocity_m_per_s() const { return vector(protocol::Signal::velocity_x_m_s); }
  glm::dvec3 force_N() const { return vector(protocol::Signal::force_x_N); }
  glm::dvec3 proxy_m() const;
  /// True speed of the tip.
  double speed_m_per_s() const;
  std::uint64_t models_received() const { return models_received_; }
  bool received_model() const { return received_model_; }  ///< in the last period

 private:
  control::Samples read_samples();
  void step_board();
  void pass_frame();
  void deliver_model();
  void record_pose();
  void answer_poses();
  glm::dvec3 vector(protocol::Signal first) const;
  bool happens(double part) { return static_cast<double>(random_() >> 11) * 0x1p-53 < part; }

  LoopOptions options_;
  arms::Description arm_;
  test::DrivenPlant plant_;
  protocol::ParameterSet parameters_;
  control::Settings settings_;
  control::Controller controller_;
  control::Drive drive_;
  protocol::SignalValues signals_;
  link::ProgramRequests requests_;
  std::uint64_t periods_ = 0;
  std::uint32_t frame_ = 0;
  bool has_hand_ = false;

  contact::Publication publication_;
  feel::Servo servo_{publication_};
  std::vector<device::Pose> poses_;  ///< received by the PC, not answered
  unsigned busy_frames_ = 0;         ///< until the PC has computed its model
  std::optional<protocol::LocalModelReport> sent_;
  std::uint16_t sequence_ = 0;
  bool is_first_pose_ = true;
  std::uint64_t models_received_ = 0;
  bool received_model_ = false;
  std::mt19937_64 random_;
};

}  // namespace inkwell::closed_loop
