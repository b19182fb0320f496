// The self-test, from the first look at the memory to the verdict: the main loop leads it, the control interrupt sends
// the pulses, and both stay in the state `testing` meanwhile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <control/controller.hpp>
#include <link/pulse_judgement.hpp>
#include <link/sample_ring.hpp>
#include <link/shared.hpp>
#include <protocol/self_test.hpp>

namespace inkwell::link {

class SelfTest {
 public:
  using Item = protocol::SelfTestItem;
  using Result = protocol::SelfTestResult;

  /// A line that follows its pulls so often in a row is driven by nobody. One that an encoder moves does so by chance.
  static constexpr std::uint32_t wire_looks = 8;
  /// A failure counts once it was seen so often with the arm at rest.
  static constexpr std::uint32_t failures_to_believe = 2;
  /// An arm that moves all the time is given up. Before each round it may take so long to come to rest.
  static constexpr std::uint32_t rounds_maximum = 8;
  static constexpr std::uint32_t rest_patience_periods = control::periods_in(0.02f);
  /// With a larger back EMF no round begins: bridges that are on brake the arm, and the hand would feel it.
  static constexpr float rest_V = 0.3f;
  /// Of a potentiometer's track at each end: its wiper never gets there.
  static constexpr float gimbal_rail_part = 0.01f;
  /// The current sensors are looked at once a current that a pulse left has ended: twelve time constants of a motor.
  static constexpr std::uint32_t off_periods = control::periods_in(0.0012f), offset_readings = 16;

  explicit SelfTest(const SampleRing& samples) : samples_(samples) {}

  // ---- main loop ----

  /// What start-up has found.
  void note(Item item, bool is_sound, float figure = 0.0f) { note(item, sound(is_sound), figure); }

  /// The wire that is to be looked at now, if any: the bridges are off.
  std::optional<Item> wanted_wire() const;
  /// Whether that wire's level followed the pulls of its pin.
  void note_wire(bool follows);

  /// Whether there is a test that wants follow(). Ask every time that the main loop comes round.
  bool goes_on() const { return phase_ != Phase::idle || begun_.load() != test_; }

  /// What the converters read as the test begins.
  struct Readings {
    control::Triple gimbal_ratio;  ///< voltage of each potentiometer as a part of its supply
    float analog_supply_V;
    bool analog_supply_is_right;
  };

  /// Goes on with it.
  void follow(const control::Controller& controller, const control::Settings& settings, const Readings& readings);

  protocol::SelfTestReport report() const;

  // ---- control interrupt ----

  /// While the state is `testing`, after the controller's step.
  void exchange(control::Controller& controller);

 private:
  enum class Phase : std::uint8_t { idle, wires, rest, pulses, verdict };
  enum class Order : std::uint8_t { none, pulses, pass, fail };

  static Result sound(bool is_sound) { return is_sound ? Result::passed : Result::failed; }
  protocol::SelfTestEntry& entry(Item item) { return entries_[static_cast<std::size_t>(item)]; }
  void note(Item item, Result result, float figure);
  void begin(const Readings& readings, const control::Triple& offset_A);
  void note_offsets();
  void break_off();
  void wait_for_rest(const protocol::SignalValues& signals, const control::MotorModel& model);
  void begin_round();
  void end_round(const PulseJudgement& judgement, const protocol::SignalValues& signals);
  void note_pulses(const PulseJudgement& judgement);
  void keep(const PulseJudgement& judgement, const protocol::SignalValues& signals);
  void give(Order order);
  void give_verdict();

  const SampleRing& samples_;
  std::array<protocol::SelfTestEntry, protocol::self_test_item_count> entries_{};
  Phase phase_ = Phase::idle;
  std::uint32_t test_ = 0;  ///< that the main loop leads: the controller counts them
  std::uint32_t tests_ended_ = 0;
  std::size_t wire_ = 0;
  std::uint32_t looks_ = 0;  ///< in which that wire followed
  std::uint32_t rounds_ = 0, failures_ = 0;
  std::uint32_t test_since_ = 0, waits_since_ = 0;  ///< samples recorded by then
  control::Triple offset_A_{};                      ///< of the sensors, as they were measured at the start
  control::MeasuredMotors measured_{};              ///< by the rounds; the interrupt's once it is to pass

  /// Number of the test, and what the interrupt is to do in it; 0 once that is done.
  Shared<std::uint32_t> order_{0};
  Shared<std::uint32_t> begun_{0};     ///< number of the test that the interrupt is in, or was in
  Shared<bool> round_is_over_{false};  ///< its figures are the main loop's until the next order
  bool pulses_run_ = false;            ///< the interrupt's own
};

}  // namespace inkwell::link
