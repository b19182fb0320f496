// A plant with simulated timers. The timers generate PWM edges and decode the encoders.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "boards/omni_driver/facts.hpp"
#include "boards/virtual/plant/plant.hpp"

#include "tests/boards/virtual/plant/arms.hpp"

namespace inkwell::test {

using namespace inkwell::virtual_board;

inline constexpr Ticks servo_period = ticks_per_s / board::servo_rate_Hz;
inline constexpr Ticks pwm_period = ticks_per_s / board::pwm_Hz;

/// Input levels of the chip, with decoded encoder counts.
class DecodedInputs final : public InputPins {
 public:
  explicit DecodedInputs(const board::Facts& board) : facts(board) {}
  void drive(char port, unsigned pin, PinLevel level, Ticks since) override {
    ++calls;
    levels[{port, pin}] = level;
    for (unsigned i = 0; i < 3; ++i) {
      const auto& w = facts.encoders[i];
      const bool a = at(w.a.pin) == PinLevel::high, b = at(w.b.pin) == PinLevel::high;
      const int phase = a ? (b ? 2 : 1) : (b ? 3 : 0);
      const int moved = (phase - phases[i]) & 3;
      if (moved == 2) ++jumps;  // both inputs changed simultaneously: the direction is unknown
      counts[i] += moved == 1 ? 1 : moved == 3 ? -1 : 0;
      if (moved != 0 && since != just_now) {
        if (since < newest_edge[i]) ++out_of_order;
        if (newest_edge[i] != 0 && since >= newest_edge[i])
          shortest_pause = std::min(shortest_pause, since - newest_edge[i]);
        newest_edge[i] = since;
      }
      phases[i] = phase;
    }
  }
  PinLevel at(board::Pin pin) const {
    const auto found = levels.find({pin.port, pin.number});
    return found == levels.end() ? PinLevel::floating : found->second;
  }
  const board::Facts& facts;
  std::map<std::pair<char, unsigned>, PinLevel> levels;
  std::array<int, 3> phases{};
  std::array<std::int64_t, 3> counts{};
  int calls = 0, jumps = 0, out_of_order = 0;
  std::array<Ticks, 3> newest_edge{};  ///< per encoder
  Ticks shortest_pause = just_now;     ///< between two edges of one encoder
};

/// A plant with center-aligned, unipolar PWM.
struct DrivenPlant {
  explicit DrivenPlant(const arms::Description& arm, const PlantOptions& options = {},
                       const board::Facts& board = board::omni_driver)
      : facts(board), inputs(board), plant(arm, board, options) {
    plant.connect(inputs);
    counts_at_start = inputs.counts;
  }

  void enable(bool on) {
    set_enable(on);
    beat();
  }
  void set_enable(bool on) { drive(facts.bridge_enable, on ? PinLevel::high : PinLevel::low); }
  /// Generates the heartbeat of a control interrupt if `is_halted` is false.
  void beat() {
    if (is_halted) return;
    drive(facts.bridge_heartbeat, PinLevel::high);
    drive(facts.bridge_heartbeat, PinLevel::low);
  }
  void drive(board::Pin pin, PinLevel level) { plant.output_changed(pin.port, pin.number, level, now); }
  void legs(PinLevel level) {
    for (const auto& bridge : facts.bridges)
      for (const auto& leg : {bridge.leg_a, bridge.leg_b})
        plant.output_changed(leg.pin.port, leg.pin.number, level, now);
  }
  /// Runs without PWM edges.
  void idle(double time_s) {
    for (const Ticks end = now + ticks(time_s); now < end;) {
      beat();
      plant.advance(now += servo_period);
    }
  }
  void run(double time_s, std::array<double, 3> duty) {
    struct Edge {
      Ticks at;
      board::Pin pin;
      PinLevel level;
    };
    std::array<Edge, 12> edges;
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned leg = 0; leg < 2; ++leg) {
        const double high = (1.0 + (leg == 0 ? duty[i] : -duty[i])) / 2.0;
        const auto half_low = static_cast<Ticks>((1.0 - high) / 2.0 * static_cast<double>(pwm_period));
        const board::Pin pin = leg == 0 ? facts.bridges[i].leg_a.pin : facts.bridges[i].leg_b.pin;
        edges[i * 4 + leg * 2] = {half_low, pin, PinLevel::high};
        edges[i * 4 + leg * 2 + 1] = {pwm_period - half_low, pin, PinLevel::low};
      }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    const Ticks end = now + ticks(time_s);
    for (unsigned period = 0; now < end; ++period) {
      if (period % board::pwm_periods_per_servo_period == 0) beat();
      for (const Edge& edge : edges) plant.output_changed(edge.pin.port, edge.pin.number, edge.level, now + edge.at);
      now += pwm_period;
      if (period % board::pwm_periods_per_servo_period == 2) {
        for (const auto& input : facts.motor_current) plant.analog_V(input.pin.port, input.pin.number, now);
        plant.advance(now);
      }
    }
  }
  double read_V(const board::AnalogInput& input) { return plant.analog_V(input.pin.port, input.pin.number, now); }
  double measured_A(unsigned motor) {
    return (read_V(facts.motor_current[motor]) - static_cast<double>(board::shunt_amplifier_offset_V)) /
           static_cast<double>(facts.shunt_V_per_A());
  }

  const board::Facts& facts;
  DecodedInputs inputs;
  Plant plant;
  std::array<std::int64_t, 3> counts_at_start{};
  Ticks now = 0;
  bool is_halted = false;
};

inline Vector3 free_joints(const arms::Description& arm) {
  using protocol::Parameter;
  return arm.parameters[Parameter::transmission] == 1.0f ? Vector3(0.1, 0.8, 0.4) : Vector3(0.1, 1.0, -1.4);
}

}  // namespace inkwell::test
