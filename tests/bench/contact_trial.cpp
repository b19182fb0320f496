// Long trials of contact: random paths at thin walls, and the duration of a contact step.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "host/contact/step.hpp"
#include "host/geometry/surface.hpp"
#include "tests/bench/sliding.hpp"
#include "tests/contact/board_trial.hpp"
#include "tests/contact/stiffness.hpp"
#include "tests/host/contact/fall_through.hpp"

namespace {

using namespace inkwell;

struct PathOptions {
  std::uint64_t count = 1000000;
  std::uint64_t from = 0;
  unsigned jobs = 1;
};

/// Returns the number of paths that passed a wall.
std::uint64_t run_paths(const PathOptions& options) {
  const auto bodies = contact_trial::hollow_bodies();
  std::atomic<std::uint64_t> next{options.from};
  std::atomic<std::uint64_t> touching{0};
  std::atomic<std::uint64_t> passed{0};
  const auto work = [&] {
    for (std::uint64_t number = next++; number < options.from + options.count; number = next++) {
      const contact_trial::PathResult result = contact_trial::run_path(bodies, number);
      touching += result.touching_steps;
      if (!result.passed) continue;
      ++passed;
      std::printf("Path %llu passed the wall. Repeat the path with --from %llu --count 1\n",
                  static_cast<unsigned long long>(number), static_cast<unsigned long long>(number));
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned job = 0; job < options.jobs; ++job) threads.emplace_back(work);
  threads.clear();
  const double steps = static_cast<double>(options.count) * contact_trial::steps_per_path;
  std::printf("%llu paths of %u steps, %.0f %% of the steps in contact: %llu passed\n",
              static_cast<unsigned long long>(options.count), contact_trial::steps_per_path,
              100 * static_cast<double>(touching) / steps, static_cast<unsigned long long>(passed.load()));
  return passed;
}

struct BoardOptions {
  double board_s = 1200;
  double visit_s = 5;
  std::uint64_t from = 0;
  unsigned jobs = 1;
};

/// Returns the number of visits in which the proxy of the board fell through the wall.
unsigned run_visits(const BoardOptions& options) {
  using closed_loop::Visit;
  const auto bodies = contact_trial::hollow_bodies();
  const auto end = options.from + static_cast<std::uint64_t>(std::ceil(options.board_s / options.visit_s));
  std::array<Visit, closed_loop::wall_kinds> sums{};
  unsigned fallen = 0;
  std::mutex mutex;
  std::atomic<std::uint64_t> next{options.from};
  const auto work = [&] {
    for (std::uint64_t number = next++; number < end; number = next++) {
      const Visit visit = closed_loop::visit(bodies, number, options.visit_s);
      const std::lock_guard lock(mutex);
      Visit& sum = sums[static_cast<std::size_t>(visit.wall)];
      sum.periods += visit.periods;
      sum.touching_periods += visit.touching_periods;
      sum.beyond_periods += visit.beyond_periods;
      sum.longest_beyond_periods = std::max(sum.longest_beyond_periods, visit.longest_beyond_periods);
      sum.deepest_m = std::max(sum.deepest_m, visit.deepest_m);
      sum.largest_rise_N = std::max(sum.largest_rise_N, visit.largest_rise_N);
      sum.rises += visit.rises;
      if (!visit.has_fallen()) continue;
      ++fallen;
      std::printf("The proxy fell through the wall in visit %llu. Repeat the visit with --from %llu --seconds %g\n",
                  static_cast<unsigned long long>(number), static_cast<unsigned long long>(number), options.visit_s);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned job = 0; job < options.jobs; ++job) threads.emplace_back(work);
  threads.clear();
  constexpr double period_ms = 1000.0 / protocol::servo_rate_Hz;
  constexpr std::array names{"frictionless", "friction", "friction and damping"};
  for (std::size_t wall = 0; wall < sums.size(); ++wall) {
    const Visit& sum = sums[wall];
    if (sum.periods == 0) continue;
    std::printf(
        "%-20s %.0f s, %.0f %% in contact; proxy beyond the wall %.3f %%, at most %.0f ms and %.2f mm; "
        "force rise above k dx + b dv: at most %.1f mN, above %.0f mN in %u periods\n",
        names[wall], sum.periods * period_ms / 1000, 100.0 * sum.touching_periods / sum.periods,
        100.0 * sum.beyond_periods / sum.periods, sum.longest_beyond_periods * period_ms, 1000 * sum.deepest_m,
        1000 * sum.largest_rise_N, 1000 * closed_loop::rise_N, sum.rises);
  }
  std::printf("%u visits with a fall-through\n", fallen);
  return fallen;
}

/// Returns false if a stiffness of a mesh is below 90 % of the stiffness of the board's shape.
bool compare_stiffness(bool has_arm_friction, unsigned trials) {
  using namespace closed_loop;
  bool is_met = true;
  for (const HandModel& hand : {light_hand, firm_hand})
    for (const double push_N : {1.0, 2.0})
      for (const Body body : {Body::plane, Body::ball}) {
        const auto stable_N_per_m = [&](Source source) {
          return stable_stiffness_N_per_m({body, source, hand, push_N, has_arm_friction, trials});
        };
        const double board = stable_N_per_m(Source::board), mesh = stable_N_per_m(Source::mesh);
        std::printf("%s, hand %.0f N/m, push %.0f N: board %.0f N/m, mesh %.0f N/m, ratio %.2f\n",
                    body == Body::plane ? "plane" : "ball", hand.stiffness_N_per_m, push_N, board, mesh, mesh / board);
        std::fflush(stdout);
        is_met = is_met && mesh >= 0.9 * board;
      }
  return is_met;
}

void measure_speed() {
  geometry::Mesh mesh = sliding::ball();
  const auto start = std::chrono::steady_clock::now();
  const auto surface = geometry::Surface::build(std::move(mesh));
  const std::chrono::duration<double> build_s = std::chrono::steady_clock::now() - start;
  const auto faces = static_cast<double>(surface->mesh().faces.size());
  std::printf("%.0f triangles, built in %.2f s, %.0f bytes per triangle\n", faces, build_s.count(),
              static_cast<double>(surface->memory_bytes()) / faces);
  contact::Scene scene;
  scene.objects.emplace_back().shape = surface;
  for (const bool free : {false, true}) {
    contact::Tool tool;
    tool.radius_m = sliding::tip_radius_m;
    contact::Pose pose;
    sliding::measure(free ? "Inkwell, free" : "Inkwell, sliding", free, [&](const glm::dvec3& hand_m) {
      pose.velocity_m_per_s = (hand_m - pose.position_m) / 0.001;
      pose.position_m = hand_m;
      return contact::step(scene, tool, pose).contact_count > 0;
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Trials of contact that take too long for the tests."};
  app.require_subcommand(1);
  PathOptions options;
  CLI::App* const paths = app.add_subcommand("paths", "Runs random paths at bodies with thin walls");
  paths->add_option("--count", options.count, "Number of paths")->capture_default_str();
  paths->add_option("--from", options.from, "First path. A path number repeats the same path")->capture_default_str();
  paths->add_option("--jobs", options.jobs, "Number of threads")->capture_default_str()->check(CLI::Range(1, 256));
  BoardOptions board_options;
  CLI::App* const board = app.add_subcommand("board", "Moves a hand at the bodies, with control code and arm");
  board->add_option("--seconds", board_options.board_s, "Board time in seconds")->capture_default_str();
  board->add_option("--from", board_options.from, "First visit. A number repeats the same visit")
      ->capture_default_str();
  board->add_option("--jobs", board_options.jobs, "Number of threads")
      ->capture_default_str()
      ->check(CLI::Range(1, 256));
  bool has_arm_friction = false;
  unsigned trials = 4;
  CLI::App* const stiffness =
      app.add_subcommand("stiffness", "Finds the largest stable stiffness of shapes and meshes");
  stiffness->add_flag("--arm-friction", has_arm_friction, "Simulate the friction of the arm");
  stiffness->add_option("--trials", trials, "Trials per stiffness")->capture_default_str()->check(CLI::Range(1, 100));
  CLI::App* const speed = app.add_subcommand("speed", "Measures contact steps on a ball of 327,680 triangles");
  CLI11_PARSE(app, argc, argv);
  if (*speed) measure_speed();
  if (*stiffness) return compare_stiffness(has_arm_friction, trials) ? 0 : 1;
  if (*board) return run_visits(board_options) > 0 ? 1 : 0;
  return *paths && run_paths(options) > 0 ? 1 : 0;
}
