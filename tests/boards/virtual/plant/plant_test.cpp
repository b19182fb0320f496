#include <plant/plant.hpp>

#include <array>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <board/omni_driver.hpp>
#include <doctest/doctest.h>

#include "arms.hpp"

namespace {

using namespace inkwell;
using namespace inkwell::virtual_board;

constexpr Ticks servo_period = ticks_per_s / board::servo_rate_Hz;
constexpr Ticks pwm_period = ticks_per_s / board::pwm_Hz;

/// Levels of the chip's inputs, with a quadrature decoder as the timers have one.
class Pins final : public InputPins {
 public:
  void drive(char port, unsigned pin, PinLevel level) override {
    ++calls;
    levels[{port, pin}] = level;
    for (unsigned i = 0; i < 3; ++i) {
      const auto& w = board::encoders[i];
      const bool a = at(w.a.pin) == PinLevel::high, b = at(w.b.pin) == PinLevel::high;
      const int phase = a ? (b ? 2 : 1) : (b ? 3 : 0);
      const int moved = (phase - phases[i]) & 3;
      if (moved == 2) ++jumps;  // both pins at once: the direction is lost
      counts[i] += moved == 1 ? 1 : moved == 3 ? -1 : 0;
      phases[i] = phase;
    }
  }
  PinLevel at(board::Pin pin) const {
    const auto found = levels.find({pin.port, pin.number});
    return found == levels.end() ? PinLevel::floating : found->second;
  }
  std::map<std::pair<char, unsigned>, PinLevel> levels;
  std::array<int, 3> phases{};
  std::array<std::int64_t, 3> counts{};
  int calls = 0, jumps = 0;
};

/// A plant with the edges that timers would give it: centre-aligned, unipolar, as the board's facts say.
struct Bench {
  explicit Bench(const arms::Description& arm, const PlantOptions& options = {}) : plant(arm, options) {
    plant.connect(pins);
    counts_at_start = pins.counts;
  }

  void enable(bool on) {
    plant.output_changed(board::bridge_enable.port, board::bridge_enable.number, on ? PinLevel::high : PinLevel::low, now);
  }
  void legs(PinLevel level) {
    for (const auto& bridge : board::bridges)
      for (const auto& leg : {bridge.leg_a, bridge.leg_b}) plant.output_changed(leg.pin.port, leg.pin.number, level, now);
  }
  /// Runs without any edge.
  void idle(double time_s) {
    for (const Ticks end = now + ticks(time_s); now < end;) plant.advance(now += servo_period);
  }
  /// Runs with PWM at these duties.
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
        const board::Pin pin = leg == 0 ? board::bridges[i].leg_a.pin : board::bridges[i].leg_b.pin;
        edges[i * 4 + leg * 2] = {half_low, pin, PinLevel::high};
        edges[i * 4 + leg * 2 + 1] = {pwm_period - half_low, pin, PinLevel::low};
      }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at < b.at; });
    const Ticks end = now + ticks(time_s);
    for (unsigned period = 0; now < end; ++period) {
      for (const Edge& edge : edges) plant.output_changed(edge.pin.port, edge.pin.number, edge.level, now + edge.at);
      now += pwm_period;
      if (period % board::pwm_periods_per_servo_period == 2) {
        for (const auto& input : board::motor_current) plant.analog_V(input.pin.port, input.pin.number, now);
        plant.advance(now);
      }
    }
  }
  double read_V(const board::AnalogInput& input) { return plant.analog_V(input.pin.port, input.pin.number, now); }
  double measured_A(unsigned motor) {
    return (read_V(board::motor_current[motor]) - static_cast<double>(board::shunt_amplifier_offset_V)) /
           static_cast<double>(board::shunt_ohm * board::shunt_amplifier_gain);
  }

  Pins pins;
  Plant plant;
  std::array<std::int64_t, 3> counts_at_start{};
  Ticks now = 0;
};

Vector3 free_joints(const arms::Description& arm) {
  using protocol::Parameter;
  return arm.parameters[Parameter::transmission] == 1.0f ? Vector3(0.1, 0.8, 0.4) : Vector3(0.1, 1.0, -1.4);
}

}  // namespace

TEST_CASE("the arm starts docked, at rest and with its switch closed") {
  for (const auto& arm : {test::omni(), test::paper()}) {
    Bench bench(arm);
    bench.idle(0.5);
    const Truth t = bench.plant.truth(bench.now);
    CHECK(t.docked);
    CHECK(t.inkwell_switch);
    CHECK(bench.pins.at(board::inkwell_switch) == PinLevel::low);
    CHECK((t.position_m - bench.plant.inkwell().position_m()).norm() < 30e-6);
    CHECK(t.velocity_m_s.norm() < 1e-9);
    CHECK(t.supply_V == doctest::Approx(18.0).epsilon(0.01));
    CHECK(bench.pins.at(board::bridge_fault_tim1.pin) == PinLevel::high);
  }
}

TEST_CASE("a current turns its joint forward and the encoder up, by gear and torque constant") {
  using protocol::Parameter;
  for (const bool reversed : {false, true})
    for (unsigned i = 0; i < 3; ++i) {
      auto arm = test::omni();
      arm.simulation.gravity_m_per_s2 = 0.0;
      for (unsigned j = 0; j < 3; ++j) {
        arm.parameters[static_cast<Parameter>(static_cast<unsigned>(Parameter::motor_1_reversed) + j)] = reversed;
        arm.parameters[static_cast<Parameter>(static_cast<unsigned>(Parameter::encoder_1_reversed) + j)] = reversed;
      }
      Bench bench(arm);
      bench.plant.place(free_joints(arm), Vector3::Zero());
      bench.idle(0.001);
      const auto counts = bench.pins.counts;
      const Vector3 before = bench.plant.truth(bench.now).joints_rad;
      bench.enable(true);
      std::array<double, 3> duty{};
      duty[i] = 0.3;
      bench.run(0.02, duty);
      const Truth t = bench.plant.truth(bench.now);
      CAPTURE(i);
      const double turned_rad = t.joints_rad[i] - before[i];
      CHECK((reversed ? -1 : 1) * turned_rad > 0.02);
      const double counts_per_rad = (i == 0 ? 13.3 : 11.2) * 1440.0 / (2.0 * 3.14159265358979);
      CHECK(std::abs((reversed ? -1 : 1) * turned_rad * counts_per_rad -
                     static_cast<double>(bench.pins.counts[i] - counts[i])) <= 1.0);
      CHECK(bench.pins.jumps == 0);
      CHECK(t.torque_Nm[i] == doctest::Approx((reversed ? -1 : 1) * (i == 0 ? 13.3 : 11.2) * 0.0234 * t.current_A[i]));
    }
}

TEST_CASE("encoders count through fast motion without a lost edge") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  Bench bench(arm);
  bench.plant.place({-0.9, 0.8, 0.4}, {40.0, 0.0, 0.0});
  bench.plant.advance(0);
  const auto before = bench.pins.counts;
  const auto encoder_before = bench.plant.truth(0).encoder_counts;
  bench.idle(0.2);
  const auto encoder_after = bench.plant.truth(bench.now).encoder_counts;
  CHECK(std::abs(encoder_after[0] - encoder_before[0]) > 500);
  for (unsigned i = 0; i < 3; ++i)
    CHECK(bench.pins.counts[i] - before[i] == encoder_after[i] - encoder_before[i]);
  CHECK(bench.pins.jumps == 0);
}

TEST_CASE("shunt amplifiers read the current within their imperfections") {
  Bench bench(test::omni());
  bench.enable(true);
  bench.run(0.005, {0.2, -0.3, 0.0});
  const Truth t = bench.plant.truth(bench.now);
  CHECK(std::abs(t.current_A[0]) > 0.5);
  CHECK(std::abs(t.current_A[1]) > 0.5);
  const Imperfections imperfections;
  for (unsigned i = 0; i < 3; ++i) {
    double sum_A = 0.0, squares_A = 0.0;
    for (int n = 0; n < 1000; ++n) {
      const double read_A = bench.measured_A(i);
      sum_A += read_A;
      squares_A += read_A * read_A;
    }
    const double mean_A = sum_A / 1000.0;
    // Between the pulses the current falls with R / L, and the amplifier is late by its time constant.
    const double late_A = t.current_A[i] * (2.26 / 0.238e-3) / (2.0 * 3.14159265358979 * imperfections.amplifier_bandwidth_Hz);
    const double expected_A = (t.current_A[i] + late_A) * (1.0 + imperfections.amplifier_gain_error[i]) +
                              imperfections.amplifier_offset_V[i] / 0.4;
    CHECK(std::abs(mean_A - expected_A) < 0.001);
    const double noise_A = std::sqrt(squares_A / 1000.0 - mean_A * mean_A);
    CHECK(noise_A == doctest::Approx(imperfections.amplifier_noise_V / 0.4).epsilon(0.15));
  }
}

TEST_CASE("the amplifier clips at its rails") {
  auto arm = test::omni();
  Bench bench(arm);
  bench.enable(true);
  bench.run(0.003, {0.95, -0.95, 0.0});
  CHECK(bench.plant.truth(bench.now).current_A[0] > 5.0);
  CHECK(bench.read_V(board::motor_current[0]) == 3.3f);
  CHECK(bench.read_V(board::motor_current[1]) == 0.0);
}

TEST_CASE("the enable pin and the bridges' fault take the current away at once, floating pins brake") {
  for (const int how : {0, 1, 2}) {
    CAPTURE(how);
    Bench bench(test::omni());
    bench.enable(true);
    bench.run(0.003, {0.3, 0.3, -0.3});
    CHECK(std::abs(bench.plant.truth(bench.now).current_A[2]) > 1.0);
    if (how == 0) bench.enable(false);
    if (how == 1) bench.legs(PinLevel::floating);
    if (how == 2) bench.plant.set_bridge_fault(true);
    bench.idle(0.0005);
    const Truth t = bench.plant.truth(bench.now);
    if (how == 1) {  // low through their pull-downs: each motor is shorted and its back-EMF drives what is left
      const double back_emf_V = 11.2 * 0.0234 * t.joint_speeds_rad_s[2];
      CHECK(std::abs(t.current_A[2] + back_emf_V / 2.26) < 0.03);
    } else {
      CHECK(t.current_A.norm() == 0.0);
    }
    CHECK((bench.pins.at(board::bridge_fault_tim1.pin) == PinLevel::low) == (how == 2));
    CHECK((bench.pins.at(board::bridge_fault_tim8.pin) == PinLevel::low) == (how == 2));
    if (how == 2) {
      bench.plant.set_bridge_fault(false);
      bench.run(0.001, {0.3, 0.3, -0.3});
      CHECK(std::abs(bench.plant.truth(bench.now).current_A[2]) > 1.0);
    }
  }
}

TEST_CASE("bridges without their enable pin never switch") {
  Bench bench(test::omni());
  bench.run(0.002, {0.5, 0.5, 0.5});
  CHECK(bench.plant.truth(bench.now).current_A.norm() == 0.0);
}

TEST_CASE("the supply sags under load, rises while the arm is braked, and is measured") {
  auto arm = test::frictionless(test::omni());
  arm.simulation.gravity_m_per_s2 = 0.0;
  Bench bench(arm);
  bench.enable(true);
  bench.plant.place({0.0, 0.8, 0.4}, Vector3::Zero());
  bench.run(0.01, {0.9, 0.0, 0.0});
  const Truth loaded = bench.plant.truth(bench.now);
  CHECK(loaded.supply_V < 17.5);
  CHECK(std::abs(bench.read_V(board::supply) * 11.0 - loaded.supply_V) < 0.05);

  bench.plant.place({-0.9, 0.8, 0.4}, {30.0, 0.0, 0.0});  // back-EMF 9.3 V against half the supply
  double highest_V = 0.0;
  for (int i = 0; i < 40; ++i) {
    bench.run(0.0005, {0.2, 0.0, 0.0});
    highest_V = std::max(highest_V, bench.plant.truth(bench.now).supply_V);
  }
  CHECK(highest_V > 18.1);

  bench.enable(false);
  bench.plant.set_supply_V(0.0);
  bench.idle(0.6);
  CHECK(bench.plant.truth(bench.now).supply_V < 12.0);
}

TEST_CASE("potentiometers invert the gimbal's characteristic, with wiper noise") {
  using protocol::Parameter;
  auto arm = test::omni();
  arm.parameters[Parameter::gimbal_2_square_rad] = 0.4f;
  Bench bench(arm);
  const Vector3 angles(0.7, 0.9, -1.1);
  bench.plant.turn_gimbal(angles);
  for (unsigned i = 0; i < 3; ++i) {
    double ratio = 0.0, lowest = 1.0, highest = 0.0;
    for (int n = 0; n < 400; ++n) {
      const double read = bench.read_V(board::gimbal[i]) / 3.3;
      ratio += read / 400.0;
      lowest = std::min(lowest, read);
      highest = std::max(highest, read);
    }
    const auto first = static_cast<unsigned>(Parameter::gimbal_1_square_rad) + 3 * i;
    const double square = arm.parameters[static_cast<Parameter>(first)];
    const double slope = arm.parameters[static_cast<Parameter>(first + 1)];
    const double offset = arm.parameters[static_cast<Parameter>(first + 2)];
    CHECK(std::abs(square * ratio * ratio + slope * ratio + offset - angles[i]) < 0.002);
    CHECK(highest - lowest > 0.0005);
    CHECK(highest - lowest < 0.01);
  }
}

TEST_CASE("switches close to ground") {
  Bench bench(test::omni());
  CHECK(bench.pins.at(board::button_1) == PinLevel::floating);
  bench.plant.press_buttons(true, false);
  bench.idle(0.0001);
  CHECK(bench.pins.at(board::button_1) == PinLevel::low);
  CHECK(bench.pins.at(board::button_2) == PinLevel::floating);
  bench.plant.press_buttons(false, true);
  bench.idle(0.0001);
  CHECK(bench.pins.at(board::button_1) == PinLevel::floating);
  CHECK(bench.pins.at(board::button_2) == PinLevel::low);
}

TEST_CASE("the hand takes the stylus out, moves it with minimum jerk, holds it still, and docks it again") {
  for (const auto& arm : {test::omni(), test::paper()}) {
    CAPTURE(arm.name);
    Bench bench(arm);
    bench.idle(0.05);
    const Vector3 goal = bench.plant.arm().dynamics().position_m(free_joints(arm));
    const Vector3 start = bench.plant.truth(bench.now).position_m;
    bench.plant.hold(start, 1500.0, 15.0);
    bench.plant.dock(false);
    bench.plant.follow({{0.0, start}, {0.5, goal}});
    double fastest_m_s = 0.0;
    for (int i = 0; i < 600; ++i) {
      bench.idle(0.001);
      fastest_m_s = std::max(fastest_m_s, bench.plant.truth(bench.now).velocity_m_s.norm());
    }
    // A minimum-jerk movement is fastest in its middle, at 15/8 of its mean speed.
    CHECK(fastest_m_s == doctest::Approx(1.875 * (goal - start).norm() / 0.5).epsilon(0.1));
    Truth t = bench.plant.truth(bench.now);
    CHECK((t.position_m - goal).norm() < 0.002);
    CHECK_FALSE(t.docked);
    CHECK(bench.pins.at(board::inkwell_switch) == PinLevel::floating);
    // A steady hand: the arm rests, and so do the encoders.
    bench.idle(0.5);
    const auto counts = bench.pins.counts;
    bench.idle(0.5);
    CHECK(bench.pins.counts == counts);

    bench.plant.dock(true);
    bench.plant.let_go();
    bench.idle(2.0);
    t = bench.plant.truth(bench.now);
    CHECK(t.docked);
    CHECK(t.inkwell_switch);
    CHECK_FALSE(t.hand_holds);
    CHECK((t.position_m - bench.plant.inkwell().position_m()).norm() < 30e-6);
  }
}

TEST_CASE("a firm pull takes the stylus out of the inkwell, a slight one does not") {
  Bench bench(test::omni());
  const Vector3 home = bench.plant.truth(0).position_m;
  bench.plant.hold(home + Vector3(0.0, 0.01, 0.0), 300.0, 3.0);
  bench.idle(0.2);
  CHECK(bench.plant.truth(bench.now).docked);
  bench.plant.hold(home + Vector3(0.0, 0.04, 0.0), 300.0, 3.0);
  bench.idle(0.3);
  CHECK_FALSE(bench.plant.truth(bench.now).docked);
  CHECK((bench.plant.truth(bench.now).position_m - home).norm() > 0.03);
}

TEST_CASE("an arm that is let go falls onto its stops and rests") {
  Bench bench(test::omni());
  bench.plant.dock(false);
  bench.idle(2.0);
  const Truth t = bench.plant.truth(bench.now);
  CHECK(t.velocity_m_s.norm() < 1e-9);
  CHECK(t.position_m.y() < bench.plant.inkwell().position_m().y());
}

TEST_CASE("a wall made by the motors is stable against a stiff hand and keeps still") {
  // Proportional-derivative force in the workspace at 20 kHz, turned into duty without a current loop: a crude
  // device, but with the true plant between duty and position.
  const auto arm = test::omni();
  Bench bench(arm);
  bench.enable(true);
  const Vector3 centre = bench.plant.arm().dynamics().position_m(free_joints(arm));
  bench.plant.place(free_joints(arm), Vector3::Zero());
  bench.plant.hold(centre + Vector3(0.0, -0.003, 0.0), 5000.0, 5.0);
  Vector3 lowest = Vector3::Constant(1.0), highest = Vector3::Constant(-1.0);
  for (int period = 0; period < 20'000; ++period) {
    const Truth t = bench.plant.truth(bench.now);
    const auto terms = bench.plant.arm().dynamics().terms(t.joints_rad, t.joint_speeds_rad_s);
    Vector3 force_N = Vector3::Zero();
    if (t.position_m.y() < centre.y()) force_N.y() = 1000.0 * (centre.y() - t.position_m.y()) - 2.0 * t.velocity_m_s.y();
    const Vector3 torque_Nm = terms.jacobian_m.transpose() * force_N;
    std::array<double, 3> duty;
    for (int i = 0; i < 3; ++i) {
      const double current_A = torque_Nm[i] / ((i == 0 ? 13.3 : 11.2) * 0.0234);
      const double back_emf_V = (i == 0 ? 13.3 : 11.2) * 0.0234 * t.joint_speeds_rad_s[i];
      duty[static_cast<std::size_t>(i)] = std::clamp((2.26 * current_A + back_emf_V) / t.supply_V, -0.95, 0.95);
    }
    bench.run(50e-6, duty);
    if (period < 10'000) continue;
    lowest = lowest.cwiseMin(t.joints_rad);
    highest = highest.cwiseMax(t.joints_rad);
  }
  const Truth t = bench.plant.truth(bench.now);
  CHECK(t.position_m.y() < centre.y() - 0.001);  // the hand is in the wall
  CHECK(std::abs(t.current_A[1]) > 0.3);
  for (int i = 0; i < 3; ++i) CHECK(highest[i] - lowest[i] < 2.0 * 0.4e-3);  // two encoder counts
}

TEST_CASE("the same seed gives the same run, another seed other noise") {
  const auto run = [](std::uint64_t seed) {
    Bench bench(test::omni(), {.seed = seed});
    bench.enable(true);
    bench.plant.dock(false);
    bench.run(0.05, {0.1, 0.2, -0.1});
    return std::pair{bench.measured_A(1), bench.plant.truth(bench.now).joints_rad};
  };
  CHECK(run(3) == run(3));
  CHECK(run(3).first != run(4).first);
}

TEST_CASE("a trace holds its rows in order, gives them once and counts what it drops") {
  Trace trace;
  Truth truth{};
  trace.record(0, truth);
  CHECK(trace.read(10).empty());  // not started
  trace.start();
  for (std::uint64_t period = 0; period < 10; ++period) {
    truth.at = period * servo_period;
    truth.position_m = Vector3(0.001 * static_cast<double>(period), 0.0, 0.0);
    truth.supply_V = 17.5;
    trace.record(period, truth);
  }
  trace.stop();
  trace.record(10, truth);
  const auto first = trace.read(4);
  const auto rest = trace.read(100);
  CHECK(first.size() == 4);
  CHECK(rest.size() == 6);
  CHECK(rest.front().period == 4);
  CHECK(rest.front().values.front() == doctest::Approx(0.004));
  CHECK(rest.front().values.back() == 17.5);
  CHECK(trace.read(100).empty());
  CHECK(trace.dropped() == 0);
}
