// Tests the panes and lines in figures of recordings.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include "host/client/device/error.hpp"
#include "host/client/recording/figure.hpp"
#include "host/client/recording/gnuplot.hpp"

#include "tests/failure.hpp"
#include "tests/system/image.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::Colour;
using inkwell::tests::Image;
using inkwell::tests::message_of;
using inkwell::tests::read_png;
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

Recording constant(const std::vector<std::pair<Quantity, float>>& values, std::uint32_t samples) {
  Recording recording;
  recording.information.parameters = protocol::default_parameters();
  for (std::uint32_t i = 0; i < samples; ++i) recording.periods.push_back(i);
  for (const auto& [quantity, value] : values) {
    const std::vector<float> column(samples, value);
    if (const auto* signal = std::get_if<Signal>(&quantity)) {
      recording.information.signals.push_back(*signal);
      recording.columns.push_back(column);
    } else {
      recording.information.simulated.push_back(std::get<protocol::SimulatedQuantity>(quantity));
      recording.simulated_columns.push_back(column);
    }
  }
  return recording;
}

// Line colors, and positions of the panes in the picture.
constexpr Colour blue{0x00, 0x72, 0xb2}, vermilion{0xd5, 0x5e, 0x00}, green{0x00, 0x9e, 0x73}, purple{0xcc, 0x79, 0xa7};
constexpr std::size_t first_pane = 120, pane_height = 320, pane_step = 360, plot_left = 190, plot_right = 1225;

/// Returns the middle row of a horizontal line with this color, or nothing if the line is missing.
std::optional<double> line_at(const Image& image, std::size_t pane, Colour colour) {
  double sum = 0;
  int rows = 0;
  for (std::size_t y = first_pane + pane * pane_step; y < first_pane + pane * pane_step + pane_height; ++y) {
    std::size_t found = 0;
    for (std::size_t x = plot_left; x < plot_right; ++x) {
      const Colour at = image.at(x, y);
      found += std::abs(at.red - colour.red) < 30 && std::abs(at.green - colour.green) < 30 &&
               std::abs(at.blue - colour.blue) < 30;
    }
    if (found < (plot_right - plot_left) * 9 / 10) continue;
    sum += static_cast<double>(y);
    ++rows;
  }
  if (rows == 0) return std::nullopt;
  return sum / rows;
}

/// Returns the number of names next to a pane. Some empty rows can separate a name's letters from its underscores.
int names_beside(const Image& image, std::size_t pane) {
  constexpr std::size_t names_left = 1330, gap_between_names = 6;
  int names = 0;
  std::size_t empty_rows = gap_between_names;
  for (std::size_t y = first_pane + pane * pane_step; y < first_pane + (pane + 1) * pane_step; ++y) {
    bool is_empty = true;
    for (std::size_t x = names_left; x < image.width; ++x) is_empty &= image.at(x, y).red > 128;
    names += !is_empty && empty_rows >= gap_between_names;
    empty_rows = is_empty ? empty_rows + 1 : 0;
  }
  return names;
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
  return message_of<device::Error>([&] { draw_figure(recording, options, picture); });
}

}  // namespace

TEST_CASE("samples that are far apart are drawn at their own times") {
  auto recording = constant({{Signal::force_N, 1.0f}}, 5);
  recording.information.step_periods = 200;
  recording.periods = {0, 10, 20, 30, 400};
  recording.columns[0][0] = recording.columns[0][1] = 0.0f;
  const TemporaryDirectory directory;
  draw_figure(recording, {}, directory / "a.png");
  // The line rises during the first 5 % of the time and then is level.
  CHECK(line_at(read_png(directory.file("a.png")), 0, blue));
}

TEST_CASE("a figure has one pane per unit, and the axis label contains quantity and unit") {
  const auto panes = figure_panes({Signal::position_x_m, Signal::force_N, Signal::penetration_x_m, Signal::duty_1,
                                   Signal::force_x_N, Signal::duty_2});
  REQUIRE(panes.size() == 3);
  CHECK(panes[0].label == "position, penetration  /  m");
  CHECK(panes[0].quantities == std::vector<Quantity>{Signal::position_x_m, Signal::penetration_x_m});
  CHECK(panes[1].label == "force  /  N");
  CHECK(panes[1].quantities == std::vector<Quantity>{Signal::force_N, Signal::force_x_N});
  CHECK(panes[2].label == "duty");
  const auto cycles = figure_panes({Signal::servo_cycles, Signal::stage_pose_cycles, Signal::stage_contact_cycles});
  REQUIRE(cycles.size() == 1);
  CHECK(cycles[0].label == "cycles");  // three quantity names do not fit next to the axis
}

TEST_CASE("a figure is higher with more panes, and shows only the selected signals and time") {
  const TemporaryDirectory directory;
  const auto recording = wave(30'000);
  draw_figure(recording, {}, directory / "all.png");
  draw_figure(recording, {.quantities = {Signal::force_N}, .from_s = 0.1, .to_s = 0.11}, directory / "one.png");
  CHECK(png_size(directory / "all.png", 16) == 1600);
  CHECK(png_size(directory / "all.png", 20) == png_size(directory / "one.png", 20) + 2 * 360);
  CHECK(std::filesystem::file_size(directory / "all.png") > 20'000);
  CHECK(std::filesystem::file_size(directory / "one.png") > 8'000);
}

TEST_CASE("every line is drawn in its colour, at the height of its value, in the pane of its unit") {
  const TemporaryDirectory directory;
  using protocol::SimulatedQuantity;
  const auto recording = constant({{Signal::current_1_A, 1.0f},
                                   {Signal::current_2_A, 2.0f},
                                   {Signal::current_3_A, 4.0f},
                                   {Signal::duty_1, 0.25f},
                                   {SimulatedQuantity::true_current_1_A, 3.0f}},
                                  3000);
  draw_figure(recording, {}, directory / "a.png");
  const auto image = read_png((directory / "a.png").string());
  const auto one_A = line_at(image, 0, blue), two_A = line_at(image, 0, vermilion), four_A = line_at(image, 0, green),
             three_A = line_at(image, 0, purple);
  REQUIRE(one_A);
  REQUIRE(two_A);
  REQUIRE(three_A);
  REQUIRE(four_A);
  const double ampere = *one_A - *two_A;
  CHECK(ampere > 20);
  CHECK(*two_A - *three_A == doctest::Approx(ampere).epsilon(0.03));
  CHECK(*three_A - *four_A == doctest::Approx(ampere).epsilon(0.03));
  CHECK(line_at(image, 1, blue));
  CHECK_FALSE(line_at(image, 1, vermilion));
}

TEST_CASE("every line of a full pane has a label next to the pane") {
  const TemporaryDirectory directory;
  std::vector<std::pair<Quantity, float>> currents;
  for (int i = 0; i < 3; ++i) {
    currents.emplace_back(static_cast<Signal>(static_cast<int>(Signal::current_reference_1_A) + i),
                          0.1f * static_cast<float>(i));
    currents.emplace_back(static_cast<Signal>(static_cast<int>(Signal::current_1_A) + i), 0.2f * static_cast<float>(i));
    currents.emplace_back(
        static_cast<protocol::SimulatedQuantity>(static_cast<int>(protocol::SimulatedQuantity::true_current_1_A) + i),
        0.3f);
  }
  draw_figure(constant(currents, 100), {}, directory / "a.png");
  const auto image = read_png((directory / "a.png").string());
  CHECK(names_beside(image, 0) == 9);
  // No text is cut at the picture's edge.
  for (std::size_t y = 0; y < image.height; ++y) REQUIRE(image.at(image.width - 2, y).red == 255);
}

TEST_CASE("a figure that cannot be drawn causes an error that states the reason") {
  const TemporaryDirectory directory;
  const auto recording = wave(3000);
  CHECK(error_of(recording, {.quantities = {Signal::torque_1_Nm}}, directory / "a.png")
            .find("position_x_m, force_N, duty_1") != std::string::npos);
  CHECK(error_of(recording, {.quantities = {}, .from_s = 5}, directory / "a.png").find("lasts 0.150 s") !=
        std::string::npos);
  CHECK(error_of(recording, {.quantities = {}, .from_s = 0.1, .to_s = 0.05}, directory / "a.png").find("no samples") !=
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
