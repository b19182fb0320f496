// Tests that the signal path is not affected when the count of control periods wraps after 59 hours.
#include <doctest/doctest.h>

#include "tests/firmware/control/near_wall.hpp"

namespace {

using namespace inkwell;
using control::Controller;
using protocol::Signal;

constexpr std::uint32_t periods_before_wrap = 500;

/// Returns a plane that touches the probe and expires 20 ms after the wrap.
control::Shapes plane_over_the_wrap(const control::Vector3& probe_m) {
  control::Shapes shapes;
  shapes.planes[0] = {.normal = {0.0f, 0.0f, 1.0f}, .offset_m = probe_m.z + 0.002f};
  shapes.surfaces[0] = {.stiffness_N_per_m = 200.0f, .m_per_N = 0.005f, .damping_Ns_per_m = 1.0f};
  shapes.life_periods[0] = periods_before_wrap + control::periods_in(0.02f);
  find_tangents(shapes, probe_m);
  return shapes;
}

TEST_CASE("the signal path is not affected by the wrap of the period counter") {
  const control::Settings settings = tests::settings_near_wall();
  Controller sooner = tests::active_controller(settings);
  Controller wraps = tests::active_controller(settings, {}, 0u - sooner.periods() - periods_before_wrap);
  REQUIRE(wraps.periods() == 0u - periods_before_wrap);
  control::Samples samples = tests::samples_at_rest();
  const protocol::SignalValues begin = sooner.signals();
  control::Shapes shapes = plane_over_the_wrap({.z = begin[Signal::position_z_m]});
  sooner.replace_shapes(shapes);
  wraps.replace_shapes(shapes);

  int differing = 0;
  for (std::uint32_t i = 0; i < 2 * periods_before_wrap; ++i) {
    if (i % 20 == 0) {  // also in the period of the wrap
      --samples.encoder_counts[1];
      ++samples.encoder_counts[2];
    }
    for (Controller* each : {&sooner, &wraps}) {
      each->host_alive();
      if (i % 20 == 0)
        each->drive({.force_N = {0.5f, 0.0f, 0.0f},
                     .mode = protocol::ForceMode::beside_walls,
                     .interval_periods = 20,
                     .per_interval = 0.05f},
                    settings);
      tests::run(*each, samples, settings, 1);
    }
    const protocol::SignalValues expected = sooner.signals(), found = wraps.signals();
    for (std::size_t k = 0; k < protocol::signal_count; ++k) differing += found.values[k] != expected.values[k];
    differing += wraps.state() != sooner.state();
  }
  CHECK(wraps.periods() == periods_before_wrap);
  CHECK(differing == 0);
  CHECK(protocol::force_is_on(wraps.state()));
  CHECK(wraps.signals()[Signal::force_N] > 0.1f);
  CHECK((wraps.force_sources() & static_cast<unsigned>(protocol::ForceSource::program)) != 0);
  CHECK((wraps.force_sources() & static_cast<unsigned>(protocol::ForceSource::shapes)) == 0);  // its life has expired
}

}  // namespace
