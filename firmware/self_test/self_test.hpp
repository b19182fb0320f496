// Sequence of the self-test. The main loop controls the self-test, and the control interrupt sends the pulses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/control/controller.hpp"
#include "firmware/exchange/shared.hpp"
#include "firmware/record/sample_ring.hpp"
#include "firmware/self_test/pulse_judgement.hpp"
#include "protocol/self_test.hpp"

namespace inkwell::link {

class SelfTest {
 public:
  using Item = protocol::SelfTestItem;
  using Result = protocol::SelfTestResult;

  /// Number of consecutive checks in which an undriven wire must follow its pull resistor. With fewer checks, a moving
  /// encoder could match the pull resistor by chance.
  static constexpr std::uint32_t wire_readings = 8;
  /// An item has failed, and a motor is missing or unknown, after this number of such rounds with the arm at rest.
  static constexpr std::uint32_t failures_to_believe = 2;
  /// Part of the estimated resistance for the following pulses. The estimate may be too large by a fifth.
  static constexpr float estimated_part = 0.8f;
  /// Largest number of pulse rounds for a moving arm.
  static constexpr std::uint32_t rounds_maximum = 8;
  static constexpr std::uint32_t rest_patience_periods = control::periods_in(0.02f);
  /// Largest back EMF at the start of a round. At a higher speed the bridges would brake the arm perceptibly.
  static constexpr float rest_V = 0.3f;
  /// Largest joint speed at the start of a round for motors that are not confirmed, because their torque constants are
  /// not known either. The smaller speed is for the first, small pulses.
  static constexpr float rest_rad_per_s = 1.0f, rest_for_estimate_rad_per_s = 0.15f;
  /// Invalid range at each end of a potentiometer track, relative to the track length. A healthy wiper never enters
  /// this range.
  static constexpr float gimbal_rail_part = 0.01f;
  /// After this time (12 motor time constants), the current of an earlier pulse has decayed.
  static constexpr std::uint32_t off_periods = control::periods_in(0.0012f), offset_readings = 16;

  explicit SelfTest(const SampleRing& samples) : samples_(samples) {}

  // ---- main loop ----

  /// Records the result of a start-up test.
  void note(Item item, bool has_passed, float figure = 0.0f) { note(item, result_of(has_passed), figure); }

  /// Returns the wire for the next test, if any. The bridges are off during this test.
  std::optional<Item> wanted_wire() const;
  /// Records whether the level of the wire followed the pull resistors of its pin.
  void note_wire(bool follows);

  /// Returns true while follow() must be called. Call this function in every pass of the main loop.
  bool goes_on() const { return phase_ != Phase::idle || begun_.load() != test_; }

  /// Converter readings at the start of the self-test.
  struct Readings {
    control::Triple gimbal_ratio;  ///< voltage of each potentiometer relative to its supply
    float analog_supply_V;
    bool analog_supply_is_right;
  };

  /// Continues the self-test.
  void follow(const control::Controller& controller, const control::Settings& settings, const Readings& readings);

  protocol::SelfTestReport report() const;

  // ---- control interrupt ----

  /// Call this function after the controller's step while the state is `testing`.
  void exchange(control::Controller& controller);

 private:
  enum class Phase : std::uint8_t { idle, wires, rest, pulses, verdict };
  enum class Order : std::uint8_t { none, pulses, pass, fail };

  static Result result_of(bool has_passed) { return has_passed ? Result::passed : Result::failed; }
  protocol::SelfTestEntry& entry(Item item) { return entries_[static_cast<std::size_t>(item)]; }
  void note(Item item, Result result, float figure);
  void begin(const Readings& readings, const control::Settings& settings, const control::Triple& offset_A);
  void note_offsets();
  void break_off();
  bool rests(const protocol::SignalValues& signals, const control::MotorModel& model) const;
  void wait_for_rest(const protocol::SignalValues& signals, const control::MotorModel& model);
  void begin_round();
  void end_round(const PulseJudgement& judgement, const protocol::SignalValues& signals);
  void note_pulses(const PulseJudgement& judgement);
  void store_measurements(const PulseJudgement& judgement, const protocol::SignalValues& signals);
  void send_order(Order order);
  void finish_test();

  const SampleRing& samples_;
  std::array<protocol::SelfTestEntry, protocol::self_test_item_count> entries_{};
  Phase phase_ = Phase::idle;
  std::uint32_t test_ = 0;  ///< number of the current self-test, as counted by the controller
  std::uint32_t tests_ended_ = 0;
  std::size_t wire_ = 0;
  std::uint32_t following_readings_ = 0;  ///< checks in which the wire followed its pull resistors
  std::uint32_t rounds_ = 0, failures_ = 0;
  std::uint32_t test_since_ = 0, waits_since_ = 0;  ///< sample numbers
  control::Triple offset_A_{};                      ///< sensor offsets measured at start-up
  /// True until a first round with small pulses has estimated the resistance of motors that are not confirmed.
  bool sizes_pulses_ = false;
  control::PulseSize pulse_size_{};     ///< read by the interrupt after the order `pulses`
  control::MeasuredMotors measured_{};  ///< results of the rounds; read by the interrupt after the order `pass`

  /// Request to the interrupt, with the self-test number. The interrupt resets the request to 0.
  Shared<std::uint32_t> order_{0};
  Shared<std::uint32_t> begun_{0};     ///< number of the current or last self-test of the interrupt
  Shared<bool> round_is_over_{false};  ///< the main loop may read the results until the next order
  bool pulses_run_ = false;            ///< control interrupt only
};

}  // namespace inkwell::link
