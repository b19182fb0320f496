// Tests that gnuplot draws names from a file and never executes them.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "host/client/recording/figure.hpp"
#include "host/client/recording/gnuplot.hpp"
#include "host/client/recording/overlay.hpp"

#include "tests/system/image.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

namespace fs = std::filesystem;

Recording named(const std::string& name) {
  auto recording = Recording::without_samples(
      {.arm = name, .parameters = protocol::default_parameters(), .signals = {Signal::force_N}});
  for (std::uint32_t i = 0; i < 100; ++i) {
    recording.periods.push_back(i);
    recording.columns[0].push_back(static_cast<float>(i));
  }
  recording.marks = {{3, name}};
  return recording;
}

/// Output of gnuplot for a quoted text.
std::string printed_by_gnuplot(const std::string& text) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.gnuplot") << "set print 'printed'\nprint " << gnuplot_text(text) << "\n";
  run_gnuplot(directory / "a.gnuplot");
  std::ifstream stream(directory / "printed");
  std::string printed{std::istreambuf_iterator<char>(stream), {}};
  REQUIRE(printed.ends_with("\n"));
  printed.pop_back();
  return printed;
}

}  // namespace

TEST_CASE("gnuplot prints quoted printable text unchanged") {
  std::string all;
  for (char c = ' '; c <= '~'; ++c) all += {c, '7'};
  for (const std::string& text : {all, std::string("Ärm “腕” it's \"here\""), std::string("'"), std::string("\\"),
                                  std::string("a\\\\"), std::string("@term %d {/Bold x} $0 `echo no`")})
    CHECK(printed_by_gnuplot(text) == text);
  CHECK(printed_by_gnuplot("two\nlines\x1B and\0 more") == "two lines? and");
}

TEST_CASE("no name in a figure runs a command") {
  const TemporaryDirectory directory;
  const std::string marker = directory.file("marker"), command = "`touch " + marker + "`";
  // A backslash at the end of a line makes gnuplot append the next line. gnuplot treats a zero byte as the end of a
  // line.
  Recording base = named("arm"), over = named("arm");
  base.information.arm = std::string("joined\\\0", 8);
  over.name = command;
  SUBCASE("with lines joined") {}
  SUBCASE("with quotes") {
    base.information.arm = "'." + command + ".'";
    base.name = "\"." + command + ".\"";
    base.marks[0].text = command;
  }
  SUBCASE("with lines ended") {
    base.information.arm = "x'\nprint " + command + "\n";
    base.name = "x\"\rprint " + command;
  }
  const Overlay overlay(over, base);
  draw_figure(base, {.over = &overlay}, directory / "a.png");
  CHECK(fs::exists(directory / "a.png"));
  CHECK_FALSE(fs::exists(marker));
}

TEST_CASE("a name with quotes and letters of any script is drawn like others") {
  const TemporaryDirectory directory;
  const auto ink_of_title = [&](const std::string& name) {
    Recording recording = named("arm");
    recording.name = name;
    draw_figure(recording, {}, directory / "a.png");
    const auto image = tests::read_png(directory.file("a.png"));
    std::size_t ink = 0;
    for (std::size_t y = 0; y < 60; ++y)
      for (std::size_t x = 0; x < image.width; ++x) ink += image.at(x, y).red < 128;
    return ink;
  };
  const std::size_t plain = ink_of_title("wave");
  CHECK(plain > 100);
  CHECK(ink_of_title("'wave") > plain);
  CHECK(ink_of_title("\"wäve\"") > plain + 20);
  CHECK(ink_of_title("wave' “腕”") > plain + 50);
}
