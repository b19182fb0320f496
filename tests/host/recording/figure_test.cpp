// Figures of recordings: panes by unit, and a picture with something on it.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <fstream>

#include <device/error.hpp>
#include <recording/figure.hpp>
#include <recording/gnuplot.hpp>

#include <temporary_directory.hpp>

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

Recording wave(std::uint32_t samples) {
  Recording recording;
  recording.name = "it's a wave";
  recording.information.arm = "an arm's name with 'quotes'";
  recording.information.simulation = true;
  recording.information.parameters = protocol::default_parameters();
  recording.information.signals = {Signal::position_x_m, Signal::force_N, Signal::duty_1};
  recording.columns.resize(3);
  for (std::uint32_t i = 0; i < samples; ++i) {
    if (i > samples / 3 && i < samples / 2) continue;  // a gap
    recording.periods.push_back(700 + i);
    for (std::size_t j = 0; j < 3; ++j)
      recording.columns[j].push_back(std::sin(0.002f * static_cast<float>(i) + static_cast<float>(j)));
  }
  recording.marks = {{700 + samples / 4, "it's here"}};
  return recording;
}

std::uint32_t png_size(const std::filesystem::path& file, std::size_t at) {
  std::ifstream stream(file, std::ios::binary);
  std::array<unsigned char, 24> head{};
  stream.read(reinterpret_cast<char*>(head.data()), head.size());
  REQUIRE(head[1] == 'P');
  return (std::uint32_t{head[at]} << 24) | (std::uint32_t{head[at + 1]} << 16) | (std::uint32_t{head[at + 2]} << 8) |
         head[at + 3];
}

std::string error_of(const Recording& recording, const FigureOptions& options, const std::filesystem::path& picture) {
  try {
    draw_figure(recording, options, picture);
  } catch (const device::Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("there is one pane for each unit, and its axis says quantity and unit") {
  const auto panes = figure_panes({Signal::position_x_m, Signal::force_N, Signal::penetration_x_m, Signal::duty_1,
                                   Signal::force_x_N, Signal::duty_2});
  REQUIRE(panes.size() == 3);
  CHECK(panes[0].label == "position, penetration  /  m");
  CHECK(panes[0].signals == std::vector{Signal::position_x_m, Signal::penetration_x_m});
  CHECK(panes[1].label == "force  /  N");
  CHECK(panes[1].signals == std::vector{Signal::force_N, Signal::force_x_N});
  CHECK(panes[2].label == "duty");
  const auto cycles = figure_panes({Signal::servo_cycles, Signal::stage_pose_cycles, Signal::stage_contact_cycles});
  REQUIRE(cycles.size() == 1);
  CHECK(cycles[0].label == "cycles");  // three quantities have no room beside the axis
}

TEST_CASE("a figure grows with its panes and shows what is asked for") {
  const TemporaryDirectory directory;
  const auto recording = wave(30'000);
  draw_figure(recording, {}, directory / "all.png");
  draw_figure(recording, {.signals = {Signal::force_N}, .from_s = 0.1, .to_s = 0.11}, directory / "one.png");
  CHECK(png_size(directory / "all.png", 16) == 1600);
  CHECK(png_size(directory / "all.png", 20) == png_size(directory / "one.png", 20) + 2 * 360);
  CHECK(std::filesystem::file_size(directory / "all.png") > 20'000);
  CHECK(std::filesystem::file_size(directory / "one.png") > 8'000);
}

TEST_CASE("what cannot be drawn is said in a sentence") {
  const TemporaryDirectory directory;
  const auto recording = wave(3000);
  CHECK(error_of(recording, {.signals = {Signal::torque_1_Nm}}, directory / "a.png")
            .find("position_x_m, force_N, duty_1") != std::string::npos);
  CHECK(error_of(recording, {.signals = {}, .from_s = 5}, directory / "a.png").find("takes 0.150 s") !=
        std::string::npos);
  CHECK(error_of(recording, {.signals = {}, .from_s = 0.1, .to_s = 0.05}, directory / "a.png").find("no samples") !=
        std::string::npos);
  CHECK(error_of(recording, {}, directory / "nowhere" / "a.png").find("--out") != std::string::npos);
  CHECK(error_of(wave(0), {}, directory / "a.png").find("no samples") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(directory / "a.png"));
}

TEST_CASE("a band holds mean and extremes, and nothing where there are no samples") {
  const std::array values{3.0, -1.0, 4.0};
  const auto band = band_of(values.size(), [&](std::size_t i) { return values[i]; });
  CHECK(band.mean == 2.0);
  CHECK(band.minimum == -1.0);
  CHECK(band.maximum == 4.0);
  CHECK(std::isnan(band_of(0, [](std::size_t) { return 1.0; }).mean));
}

TEST_CASE("gnuplot's own words come back when it fails") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "wrong.gnuplot") << "plot nonsense(\n";
  try {
    run_gnuplot(directory / "wrong.gnuplot");
    FAIL("a wrong script was drawn");
  } catch (const device::Error& error) {
    CHECK(std::string(error.what()).find("nonsense") != std::string::npos);
  }
}
