// Long trials of contact: random paths at thin walls, and the duration of a contact step.
#include <CLI/CLI.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include "host/contact/step.hpp"
#include "host/geometry/surface.hpp"
#include "tests/bench/sliding.hpp"
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
  CLI::App* const speed = app.add_subcommand("speed", "Measures contact steps on a ball of 327,680 triangles");
  CLI11_PARSE(app, argc, argv);
  if (*speed) measure_speed();
  return *paths && run_paths(options) > 0 ? 1 : 0;
}
