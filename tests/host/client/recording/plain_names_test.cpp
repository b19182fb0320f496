// Tests the replacement of unprintable characters in the names and texts of a file.
#include <doctest/doctest.h>

#include <fstream>

#include "host/client/device/force_law.hpp"
#include "host/client/recording/recorder.hpp"
#include "host/client/recording/recording.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::contains;
using inkwell::tests::message_of;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

namespace fs = std::filesystem;

const std::string hostile = "a\x1B[2J\nb`touch x`\x07\xC2\x9B\xE2\x80\xAE\xFF";
const std::string harmless = "a?[2J b`touch x`???\?\?\?\?";

Recording named(const std::string& name) {
  auto recording = Recording::without_samples({.created_utc = name,
                                               .firmware_version = name,
                                               .serial_number = name,
                                               .arm = name,
                                               .parameters = protocol::default_parameters(),
                                               .signals = {Signal::force_N}});
  for (std::uint32_t i = 0; i < 100; ++i) {
    recording.periods.push_back(i);
    recording.columns[0].push_back(static_cast<float>(i));
  }
  recording.marks = {{3, name, device::EventKind::force, name}};
  return recording;
}

void check_is_plain(const fs::path& file) {
  const Recording recording = read(file);
  const auto& about = recording.information;
  for (const std::string& text :
       {about.created_utc, about.firmware_version, about.serial_number, about.arm, recording.marks.at(0).text})
    CHECK(text == harmless);
}

}  // namespace

TEST_CASE("the texts of a recording contain no control characters after reading") {
  const TemporaryDirectory directory;
  save(named(hostile), directory / "a.h5");
  check_is_plain(directory / "a.h5");
  // A CSV file stores its texts in comment lines.
  std::string one_line = hostile;
  std::replace(one_line.begin(), one_line.end(), '\n', '\r');
  std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n# created_utc = " << one_line
                                     << "\n# firmware_version = " << one_line << "\n# serial_number = " << one_line
                                     << "\n# arm = " << one_line << "\n# parameter " << one_line
                                     << " = 1\n# mark 3 = " << one_line << "\ntime_s,force_N,\x1B[1m\n0.0,1,2\n";
  check_is_plain(directory / "a.csv");
  const auto remarks = read(directory / "a.csv").remarks;
  REQUIRE(remarks.size() == 2);
  CHECK(contains(remarks[0], "The parameter " + harmless + " of "));
  CHECK(contains(remarks[1], "The signal ?[1m of "));
  std::ofstream(directory / "b.csv") << "# inkwell recording = 1\ntime_s,force_N\n0.0,\x1B]0;title\x07\n";
  CHECK(contains(message_of<device::Error>([&] { read(directory / "b.csv"); }), "\"?]0;title?\""));
  // Control characters in a file name are replaced.
  fs::rename(directory / "a.h5", directory / "\x1B[5m.h5");
  CHECK(read(directory / "\x1B[5m.h5").name == "?[5m");
}

TEST_CASE("a force law of a recording cannot name a signal with anything but letters, digits and _") {
  for (const char* name : {"ok_1_m", "x'y", "x,y", "x y", "", "x\"", "x`y", "\xC3\xA4"}) {
    CAPTURE(name);
    std::string report{'\x15', '\0', '\1', '\0', '\0', '\0'};
    for (const std::string& text : {std::string("law"), std::string("help\x1B\n"), std::string(name), std::string("m"),
                                    std::string("what it is")})
      report += text + '\0';
    report[4] = static_cast<char>(report.size());
    std::string digits;
    for (const char c : report) {
      constexpr char hex[] = "0123456789abcdef";
      digits += {hex[static_cast<unsigned char>(c) >> 4], hex[c & 15]};
    }
    const TemporaryDirectory directory;
    std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n# force_law = " << digits << "\ntime_s," << name
                                       << "\n";
    const Recording read_back = read(directory / "a.csv");
    const bool is_known = std::string(name) == "ok_1_m";
    CHECK(read_back.information.signals.size() == (is_known ? 1 : 0));
    CHECK((read_back.information.force_law != nullptr) == is_known);
    if (is_known) CHECK(std::to_integer<char>((*read_back.information.force_law)[14]) == '?');
  }
  device::join_tables({});  // removes the force law's rows
}

TEST_CASE("a new recording's arm and marks have one line each") {
  CHECK(describe({}, protocol::default_parameters(), {}, hostile, true).arm == harmless);
  const TemporaryDirectory directory;
  {
    Recorder recorder(directory / "a.csv", named("arm").information);
    recorder.push({.signals = {Signal::force_N}, .first_period = 0, .count = 1, .values = {1.0f}});
    recorder.mark("two\nlines\x1B");
  }
  CHECK(read(directory / "a.csv").marks.at(0).text == "two lines?");
}
