// Normal use of the arm.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>

#include <unistd.h>

#include <fmt/format.h>

#include "host/client/recording/recorder.hpp"
#include "host/client/recording/recording.hpp"
#include "protocol/scope.hpp"

#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {
namespace {

using namespace std::chrono_literals;
using device::Vector3;
using protocol::ForceMode;
using protocol::Signal;

constexpr double step_s = 0.01;
// These are mean speeds. The peak speed of a minimum-jerk motion is 1.875 times the mean speed.
constexpr double slow_m_per_s = 0.15, fast_m_per_s = 0.8;
/// The probe can move faster than the hand. The lowest random speed limit is 2 m/s.
constexpr double fastest_way_m_per_s = 1.0;

double distance_m(const Vector3& a, const Vector3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Moves the hand from point to point for this time. Calls `each` after every step.
void wander(Bench& bench, double time_s, double speed_m_per_s, const std::function<Vector3()>& next_m,
            const std::function<void()>& each = {}) {
  Vector3 here_m = bench.board.true_position_m();
  double until_next_s = 0;
  for (double passed_s = 0; passed_s < time_s; passed_s += step_s) {
    until_next_s -= step_s;
    if (until_next_s <= 0) {
      const Vector3 to_m = next_m();
      const double fastest_s = 1.875 * distance_m(here_m, to_m) / fastest_way_m_per_s;
      const double way_s =
          std::max({0.03, fastest_s, distance_m(here_m, to_m) / (speed_m_per_s * bench.random.from(0.5, 1.5))});
      bench.move_hand(to_m, way_s);
      until_next_s = way_s + (bench.random.chance(0.3) ? bench.random.from(0.0, 0.5) : 0.0);
      here_m = to_m;
    }
    bench.pass(step_s);
    bench.fidget();
    if (each) each();
  }
}

double limit_N(const Bench& bench) { return static_cast<double>(bench.accepted[protocol::Parameter::force_limit_N]); }

/// Returns a random hand position in free space or inside a wall.
Vector3 anywhere_m(Bench& bench) {
  return bench.random.chance(0.5) ? bench.free_point_m() : bench.wall_point_m(bench.random.from(0.0, limit_N(bench)));
}

// ---- program -------------------------------------------------------------------------------------------------

float some(Random& random, double low, double high) { return static_cast<float>(random.from(low, high)); }

device::Surface random_surface(Random& random) {
  const float friction = some(random, 0.0, 1.0);
  return {some(random, 50, 1500), some(random, 0, 3), friction, friction * some(random, 0, 1), some(random, 0.1, 2)};
}

device::Shapes random_shapes(Bench& bench) {
  Random& random = bench.random;
  const Vector3 probe_m = bench.board.true_position_m();
  const auto near_m = [&](double so_far_m) {
    std::array<float, 3> point_m{};
    for (std::size_t i = 0; i < 3; ++i) point_m[i] = static_cast<float>(probe_m[i] + random.from(-so_far_m, so_far_m));
    return point_m;
  };
  device::Shapes shapes;
  for (auto& plane : shapes.planes)
    if (random.chance(0.2)) {
      std::array<float, 3> normal{some(random, -1, 1), some(random, -1, 1), some(random, 0.1, 1)};
      plane = device::Plane{near_m(0.03), normal, random_surface(random)};
    }
  if (random.chance(0.3))
    shapes.sphere = device::Sphere{near_m(0.04), some(random, 0.002, 0.03), random_surface(random)};
  return shapes;
}

/// Sends the forces of a spring, a push or a vibration.
class Program {
 public:
  explicit Program(Bench& bench) : bench_(bench) {
    choose();
    // The claim may have expired.
    if (!bench.board.device().drives()) bench.board.device().claim();
  }

  /// Sends one force and waits for one interval.
  void step() {
    if (left_s_ <= 0) choose();
    const double interval_s = 1e-3 * interval_ms_;
    device::ForceRequest request{.mode = mode_, .interval_ms = interval_ms_};
    const auto& pose = bench_.board.pose();
    for (std::size_t i = 0; i < 3; ++i) {
      const double away_m = pose ? static_cast<double>(pose->position_m[i]) - point_m_[i] : 0.0;
      request.force_N[i] =
          static_cast<float>(push_N_[i] * std::cos(turns_per_s_ * 6.2832 * left_s_) - stiffness_N_per_m_ * away_m);
    }
    bench_.board.device().send_force(request);
    ++sent_;
    bench_.pass(interval_s, false);  // a force counts as a heartbeat
    left_s_ -= interval_s;
  }
  void end() {
    bench_.board.device().send_force({.mode = ForceMode::none});
    ++sent_;
  }
  unsigned long sent() const { return sent_; }

 private:
  void choose() {
    Random& random = bench_.random;
    left_s_ = random.from(0.1, 0.8);
    mode_ = random.chance(0.6) ? ForceMode::beside_walls : ForceMode::instead_of_walls;
    interval_ms_ = random.chance(0.6) ? 1 : static_cast<int>(1 + random.below(20));
    point_m_ = bench_.free_point_m();
    // With long intervals between forces, the hand cannot damp a stiff spring.
    stiffness_N_per_m_ = random.chance(0.5) ? random.from(0, 200.0 / interval_ms_) : 0.0;
    const double push_N = random.chance(0.1) ? 20.0 : 2.0;
    for (double& along_N : push_N_) along_N = random.from(-push_N, push_N);
    turns_per_s_ = random.chance(0.3) ? random.from(5, 150) : 0.0;
  }

  Bench& bench_;
  double left_s_ = 0;
  ForceMode mode_ = ForceMode::none;
  int interval_ms_ = 1;
  Vector3 point_m_{}, push_N_{};
  double stiffness_N_per_m_ = 0, turns_per_s_ = 0;
  unsigned long sent_ = 0;
};

// ---- scope ---------------------------------------------------------------------------------------------------

std::vector<Signal> random_signals(Random& random) {
  std::vector<Signal> signals;
  for (std::size_t i = 0; i < protocol::known_signals().size(); ++i) signals.push_back(static_cast<Signal>(i));
  random.shuffle(signals);
  signals.resize(1 + random.below(protocol::scope_signals_maximum));
  return signals;
}

bool the_bus_carries(const std::vector<Signal>& signals) {
  protocol::SignalSelection selection{};
  selection.count = static_cast<std::uint8_t>(signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) selection.signals[i] = static_cast<std::uint8_t>(signals[i]);
  return protocol::encoding_for(selection) == protocol::ScopeEncoding::full;
}

/// Numbers of received and lost samples since the last call.
struct ScopeCount {
  unsigned long samples = 0, lost = 0;
};

ScopeCount read_scope(Bench& bench, const std::vector<Signal>& signals,
                      const std::function<void(const device::ScopeSamples&)>& take = {}) {
  ScopeCount count;
  while (const auto frame = bench.board.device().read_scope(0ms)) {
    if (frame->signals != signals) continue;
    count.samples += frame->count;
    count.lost += frame->lost_before;
    if (take) take(*frame);
  }
  return count;
}

void note_lost(Bench& bench, const std::vector<Signal>& signals, unsigned long lost) {
  (the_bus_carries(signals) ? bench.sitting.lost.scope_samples : bench.sitting.lost.wide_scope_samples) += lost;
  if (lost > 0 && the_bus_carries(signals))
    bench.oracle.complain(Complaint::lost_packets, fmt::format("{} samples of {} signals", lost, signals.size()));
}

/// Removes a file at the end of a phase.
struct RemovedAtTheEnd {
  std::filesystem::path file;
  ~RemovedAtTheEnd() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
};

void stop_scope(Bench& bench) {
  bench.board.device().select_signals({});
  bench.pass(step_s);
  while (bench.board.device().read_scope(0ms)) {
  }
  if (const auto malformed = bench.board.device().malformed_scope_frames(); malformed > 0)
    bench.fail(Complaint::lost_packets, fmt::format("{} scope frames are malformed", malformed));
}

}  // namespace

std::string use_docking(Bench& bench) {
  bench.make_ready();
  bench.dock();
  bench.pass(bench.random.from(0.05, 0.3));
  bench.take_out();
  bench.make_active();
  bench.withdraw_force();
  return "";
}

std::string use_free_space(Bench& bench, double time_s) {
  bench.make_active();
  wander(bench, time_s, slow_m_per_s, [&] { return bench.free_point_m(); });
  if (bench.random.chance(0.5)) bench.withdraw_force();
  return "";
}

std::string use_walls(Bench& bench, double time_s) {
  bench.make_active();
  wander(bench, time_s, slow_m_per_s, [&] { return bench.wall_point_m(bench.random.from(0.1, 1.0) * limit_N(bench)); });
  return "";
}

std::string use_fast(Bench& bench, double time_s) {
  bench.make_active();
  wander(bench, time_s, fast_m_per_s, [&] { return anywhere_m(bench); });
  return "";
}

std::string use_program(Bench& bench, double time_s) {
  bench.make_active();
  Program program(bench);
  program.step();
  const auto before = bench.board.device().information().report;
  double until_move_s = 0, until_shapes_s = 0;
  unsigned shapes = 0;
  const double begin_s = bench.oracle.board_time_s();
  for (double last_s = begin_s; last_s - begin_s < time_s;) {
    program.step();
    const double now_s = bench.oracle.board_time_s(), passed_s = now_s - last_s;
    last_s = now_s;
    if ((until_move_s -= passed_s) <= 0) {
      until_move_s = bench.random.from(0.3, 1.0);
      bench.move_hand(bench.free_point_m(), until_move_s);
    }
    if ((until_shapes_s -= passed_s) <= 0) {
      until_shapes_s = bench.random.from(0.05, 0.6);
      bench.board.device().place_shapes(random_shapes(bench));
      ++shapes;
    }
  }
  if (bench.random.chance(0.5)) program.end();
  bench.board.device().place_shapes({});
  bench.pass(0.1);
  const auto after = bench.board.device().information().report;
  const auto lost = after.force_reports_lost - before.force_reports_lost;
  bench.sitting.lost.program_forces += lost;
  if (lost > 0 || after.force_reports_refused != before.force_reports_refused)
    bench.oracle.complain(Complaint::lost_packets,
                          fmt::format("{} program forces were lost, {} refused", lost,
                                      after.force_reports_refused - before.force_reports_refused));
  return fmt::format("{} forces, shapes {} times", program.sent(), shapes);
}

std::string use_scope(Bench& bench, double time_s) {
  bench.make_active();
  std::vector<Signal> signals;
  unsigned long samples = 0;
  unsigned selections = 0;
  double until_change_s = 0;
  wander(
      bench, time_s, slow_m_per_s, [&] { return anywhere_m(bench); },
      [&] {
        if ((until_change_s -= step_s) <= 0) {
          until_change_s = bench.random.from(0.05, 0.7);
          signals = random_signals(bench.random);
          bench.board.device().select_signals(signals);
          ++selections;
        }
        const ScopeCount count = read_scope(bench, signals);
        samples += count.samples;
        note_lost(bench, signals, count.lost);
      });
  stop_scope(bench);
  if (samples == 0) bench.fail(Complaint::no_answer, "the scope returned no samples");
  return fmt::format("{} selections, {} samples", selections, samples);
}

std::string use_recording(Bench& bench, double time_s) {
  bench.make_active();
  std::vector<Signal> signals = random_signals(bench.random);
  if (signals.size() > 10) signals.resize(10);
  const auto file =
      std::filesystem::temp_directory_path() /
      fmt::format("inkwell-soak-{}-{}.{}", ::getpid(), bench.sitting.number, bench.random.chance(0.5) ? "h5" : "csv");
  const RemovedAtTheEnd removed{file};
  unsigned long samples = 0, lost = 0;
  bench.board.device().select_signals(signals);
  recording::RecorderStatus status;
  {
    recording::Recorder recorder(
        file, recording::describe(bench.board.device().information(), bench.accepted, signals, "", true));
    wander(
        bench, time_s, slow_m_per_s, [&] { return anywhere_m(bench); },
        [&] {
          const ScopeCount count = read_scope(bench, signals, [&](const auto& frame) { recorder.push(frame); });
          samples += count.samples;
          lost += count.lost;
          if (bench.random.chance(0.01)) recorder.mark("soak");
        });
    status = recorder.stop();
  }
  note_lost(bench, signals, lost);
  stop_scope(bench);
  // The recorder's error explains a later error of the reader.
  if (!status.error.empty()) bench.fail(Complaint::lost_packets, status.error);
  const auto read_back = recording::read(file);
  bench.sitting.lost.recorded_samples += samples - read_back.size();
  if (read_back.size() != samples || (!read_back.complete && status.lost == 0))
    bench.oracle.complain(Complaint::lost_packets,
                          fmt::format("of {} samples, {} are in the recording.", samples, read_back.size()));
  return fmt::format("{} samples of {} signals", samples, signals.size());
}

std::string live_storm(Bench& bench, double time_s) {
  bench.make_active();
  unsigned changes = 0, illegal = 0;
  double until_change_s = 0;
  wander(
      bench, time_s, slow_m_per_s, [&] { return anywhere_m(bench); },
      [&] {
        if ((until_change_s -= step_s) > 0) return;
        until_change_s = bench.random.chance(0.2) ? bench.random.from(0.0, 0.5) : bench.random.from(0.0, 0.05);
        if (bench.random.chance(0.2)) {
          bench.try_illegal();
          ++illegal;
          return;
        }
        const std::size_t count = bench.random.chance(0.1) ? protocol::parameter_count : 1 + bench.random.below(5);
        bench.set(legal_changes(bench.random, bench.accepted, Reach::careful, count));
        ++changes;
      });
  bench.restore_defaults();
  return fmt::format("{} transactions with the force on, {} of them illegal", changes, illegal);
}

}  // namespace inkwell::soak
