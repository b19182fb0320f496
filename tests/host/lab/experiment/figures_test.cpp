// Tests data and drawing of the paper's figures.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/client/recording/signals.hpp"
#include "host/lab/experiment/figures.hpp"
#include "host/lab/experiment/summary.hpp"

#include "tests/failure.hpp"
#include "tests/system/image.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::experiment;
using inkwell::tests::Colour;
using inkwell::tests::message_of;
using inkwell::tests::read_png;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

constexpr Colour blue{0x00, 0x72, 0xb2}, vermilion{0xd5, 0x5e, 0x00}, green{0x00, 0x9e, 0x73};

/// A push into the upper z wall lasts from 0.3 s to 0.4 s. The unused signals are sine waves.
recording::Recording push() {
  recording::Information about;
  about.signals = recording::signal_path();
  about.parameters = protocol::default_parameters();
  about.arm = "an arm's name with 'quotes'";
  about.simulation = true;
  constexpr std::size_t samples = 14'000;
  device::ScopeSamples scope{.signals = about.signals, .first_period = 100, .count = samples, .values = {}};
  for (std::size_t i = 0; i < samples; ++i)
    for (std::size_t j = 0; j < about.signals.size(); ++j) {
      const bool touches = i >= 6000 && i < 8000;
      const auto wave = static_cast<float>(std::sin(0.001 * static_cast<double>(i) + static_cast<double>(j)));
      const auto signal = about.signals[j];
      const bool is_penetration = signal >= Signal::penetration_x_m && signal <= Signal::penetration_z_m;
      scope.values.push_back(!is_penetration ? wave : touches && signal == Signal::penetration_z_m ? -0.001f : 0.0f);
    }
  auto recording = recording::Recording::without_samples(about);
  recording.append(scope);
  return recording;
}

}  // namespace

TEST_CASE("figures show mean and extremes of each millisecond") {
  auto recording = push();
  auto& force_N = recording.columns[static_cast<std::size_t>(Signal::force_N)];
  for (std::size_t i = 0; i < 60; ++i) force_N[i] = static_cast<float>(i);
  recording.keep(0, 60);
  const auto data = figure_data(recording, {2, 1}, {0, recording.duration_s()});
  REQUIRE(data.rows.size() == 3);
  CHECK(data.names[1] == "force_N");
  CHECK(data.rows[1].time_s == doctest::Approx(1.5e-3));
  CHECK(data.rows[1].bands[1].mean == doctest::Approx(29.5));
  CHECK(data.rows[1].bands[1].minimum == 20);
  CHECK(data.rows[1].bands[1].maximum == 39);
}

TEST_CASE("figures of a long contact have longer points, so that the data stays small") {
  const auto recording = push();
  const auto contact = contact_with(recording, {2, 1});
  REQUIRE(contact);
  CHECK(contact->from_s == doctest::Approx(0.3));
  CHECK(contact->to_s == doctest::Approx(0.39995));
  CHECK(figure_data(recording, {2, 1}, *contact).rows.size() == 100);
  const auto data = figure_data(recording, {2, 1}, {0, 40});
  CHECK(data.rows.size() == 77);  // points of 9 ms
  CHECK(data.rows[1].time_s - data.rows[0].time_s == doctest::Approx(9e-3));
}

TEST_CASE("the first and the last contact are found in a long recording") {
  auto recording = recording::Recording::without_samples({.signals = {Signal::penetration_z_m}});
  constexpr std::size_t count = 300'000;
  for (std::size_t i = 0; i < count; ++i) recording.periods.push_back(static_cast<std::int64_t>(i));
  recording.columns[0].assign(count, 0.0f);
  CHECK_FALSE(contact_with(recording, {2, 1}));
  recording.columns[0][70'000] = -1e-4f;
  recording.columns[0][200'000] = -2e-4f;
  const auto contact = contact_with(recording, {2, 1});
  REQUIRE(contact);
  CHECK(contact->from_s == doctest::Approx(3.5));
  CHECK(contact->to_s == doctest::Approx(10.0));
}

TEST_CASE("the sphere's distance is zero where its surface meets the wall") {
  auto recording = push();
  const auto& parameters = recording.information.parameters;
  auto& position_m = recording.columns[static_cast<std::size_t>(Signal::position_z_m)];
  const float touching_m =
      parameters[protocol::Parameter::box_minimum_z_m] + parameters[protocol::Parameter::sphere_radius_m];
  position_m.assign(position_m.size(), touching_m - 0.002f);
  CHECK(figure_data(recording, {2, -1}, {0, 0.1}).rows[0].bands[0].mean == doctest::Approx(2.0).epsilon(1e-3));
}

TEST_CASE("gnuplot draws the four figures, each line in its colour") {
  const TemporaryDirectory directory;
  const auto pictures = draw_figures(push(), directory / "figures", {});
  REQUIRE(pictures.size() == 4);
  constexpr std::size_t some = 400;
  for (const auto& picture : pictures) {
    CAPTURE(picture);
    const auto image = read_png(picture);
    CHECK(image.width == 1600);
    CHECK(image.count(blue, 20) > some);
    const bool has_three = picture.ends_with("figure-13.png") || picture.ends_with("figure-14.png");
    CHECK((image.count(vermilion, 20) > some) == has_three);
    CHECK((image.count(green, 20) > some) == has_three);
  }
}

TEST_CASE("a recording that cannot be drawn as a paper figure causes an error that states the reason") {
  const TemporaryDirectory directory;
  const auto error_of = [&](const recording::Recording& recording, const PaperFigureOptions& options) {
    return message_of<device::Error>([&] { draw_figures(recording, directory.path(), options); });
  };
  CHECK(error_of(push(), {.wall = BoxWall{0, 1}}).find("wall x+") != std::string::npos);
  CHECK(error_of(push(), {.wall = {}, .from_s = 0.5, .to_s = 0.4}).find("lasts 0.700 s") != std::string::npos);
  auto other = recording::Recording::without_samples({.signals = {Signal::force_N}});
  CHECK(error_of(other, {}).find("does not contain penetration_x_m") != std::string::npos);
}
