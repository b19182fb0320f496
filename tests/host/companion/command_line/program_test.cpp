// Tests every command's messages about the connected arms.
#include <doctest/doctest.h>

#include <unistd.h>
#include <atomic>

#include <cstring>
#include <fstream>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "host/companion/command_line/program.hpp"
#include "protocol/reports.hpp"
#include "tests/failure.hpp"
#include "tests/host/client/device/fake_usb.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

struct Ended {
  int exit_code;
  std::string complaint;
};

/// Runs the program in this process, with a fake USB.
Ended run_here(std::vector<std::string> words) {
  const TemporaryDirectory directory;
  const std::string file = directory.file("stderr");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  const int kept = dup(STDERR_FILENO);
  fflush(stderr);
  REQUIRE(freopen(file.c_str(), "w", stderr) != nullptr);
  const int exit_code = command_line::run(static_cast<int>(pointers.size()), pointers.data());
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  std::ifstream said(file);
  return {exit_code, {std::istreambuf_iterator<char>(said), {}}};
}

}  // namespace

TEST_CASE("the list of devices continues after an arm that does not report its board name") {
  FakeUsb usb;
  usb.add_arm("0011");
  usb.add_arm("0022");
  const auto [exit_code, complaint] = run_here({"inkwell", "devices"});
  CHECK(exit_code == 0);
  CHECK(contains(complaint, "The board name of arm 0011 cannot be read"));
  CHECK(contains(complaint, "The board name of arm 0022 cannot be read"));
}

TEST_CASE("a recording whose last samples do not arrive fails with a message") {
  FakeUsb usb;
  FakeUsbDevice& arm = usb.add_arm("0011");
  answer_as_inkwell(arm);
  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  arm.repeats_reports = true;
  usb.send_report(arm, bytes_of(pose));
  const auto selection_token = [&] {
    for (;;) {
      const std::lock_guard lock(usb.mutex);
      for (const Bytes& written : arm.written) {
        protocol::CommandReport report{};
        if (written.size() < sizeof report) continue;
        std::memcpy(&report, written.data(), sizeof report);
        if (report.report_id == protocol::ReportId::command && report.command == protocol::Command::select_signals)
          return report.token;
      }
    }
  };
  std::function<void()> end;
  std::string said;
  SUBCASE("the scope stream breaks off, and the poses continue") {
    end = [&] { usb.set_bulk_fails(arm, true); };
    said = "The recording contains all samples up to that time";
  }
  SUBCASE("the scope stream is silent, and the poses continue") {
    end = [] {};
    said = "sends poses but no samples";
  }
  SUBCASE("the next samples are after the end of the recording") {
    end = [&] {
      const auto token = selection_token();
      usb.send_bulk(arm, scope_frame(token, 1000, 0.5f));
      usb.send_bulk(arm, scope_frame(token, 1500, 0.5f));
    };
    said = "were lost between board and PC";
  }
  std::atomic<bool> has_ended = false;
  std::thread cable([&] {
    while (usb.endpoints_under_way(arm).empty() && !has_ended) std::this_thread::yield();
    if (!has_ended) end();
  });
  const TemporaryDirectory directory;
  const auto [exit_code, complaint] =
      run_here({"inkwell", "record", directory.file("push.csv"), "--signals", "force_N", "--seconds", "0.01"});
  has_ended = true;
  cable.join();
  CAPTURE(complaint);
  CHECK(exit_code == 1);
  CHECK(contains(complaint, said));
}

TEST_CASE("with several arms, a command without a serial number fails and requests the number") {
  FakeUsb usb;
  usb.add_arm("0011");
  usb.add_arm("0022");
  for (const auto& command : std::vector<std::vector<std::string>>{{"info"},
                                                                   {"force", "on"},
                                                                   {"parameters", "set", "wall_stiffness_N_per_m=600"},
                                                                   {"check", "directions", "--yes"},
                                                                   {"flash"}}) {
    auto words = command;
    words.insert(words.begin(), "inkwell");
    const Ended ended = run_here(words);
    CAPTURE(ended.complaint);
    CHECK(ended.exit_code == 1);
    CHECK(contains(ended.complaint, " 0011"));
    CHECK(contains(ended.complaint, " 0022"));
    CHECK(contains(ended.complaint, "--serial NUMBER"));
  }
}
