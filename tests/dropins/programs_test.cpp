// Starts programs that behave like CHAI3D or HDAPI programs, alone, in parallel and through `inkwell run`.
#include <doctest/doctest.h>

#include <signal.h>

#include <cmath>
#include <sstream>

#include "host/client/device/device.hpp"
#include "tests/system/program.hpp"

#include "tests/dropins/board.hpp"
#include "tests/dropins/hdapi.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;

std::string program(const std::string& name) { return build_directory() + "/" + name; }

/// Returns the text between this word and the end of the line.
std::string value_of(const std::string& text, const std::string& word) {
  const auto begin = text.find(word + " ");
  return begin == std::string::npos
             ? ""
             : text.substr(begin + word.size() + 1, text.find('\n', begin) - begin - word.size() - 1);
}

struct ReportedVector {
  int result = -7;
  double x = 0, y = 0, z = 0;
  explicit ReportedVector(const std::string& line) { std::istringstream(line) >> result >> x >> y >> z; }
};

TEST_CASE("a program in CHAI3D's manner gets an Omni in its own axes, paced and with force") {
  Board board;
  board.hold();
  const auto held = run_program("inkwell", {"run", "--usbip", board.address.substr(6), program("drop-in-as-chai3d")});
  INFO(held.out, held.err);
  REQUIRE(held.exit_code == 0);
  CHECK(value_of(held.out, "devices") == "1");
  CHECK(value_of(held.out, "early") == "-1");
  CHECK(value_of(held.out, "radius") == "0 0.1368");  // of a box of 160, 180 and 130 mm
  CHECK(value_of(held.out, "type") == "0 PHANTOM Omni");
  CHECK(value_of(held.out, "open") == "-1 0");
  CHECK(value_of(held.out, "refused") == "0");
  CHECK(value_of(held.out, "buttons") == "0");
  CHECK(value_of(held.out, "error") == "0x104 77");  // libhdPhantom must not consume this error
  CHECK(value_of(held.out, "close") == "0");
  CHECK(value_of(held.out, "late") == "-1");
  const ReportedVector position(value_of(held.out, "position")), turn(value_of(held.out, "rotation"));
  CHECK(position.result == 0);
  CHECK(std::abs(position.x - held_point_m[2]) < 0.005);
  CHECK(std::abs(position.y - held_point_m[0]) < 0.005);
  CHECK(std::abs(position.z - held_point_m[1]) < 0.005);
  CHECK(turn.result == 0);
  CHECK(turn.x > 0.5);  // the back of the stylus points toward the user, along CHAI3D's x
  const auto pulled =
      run_program("inkwell", {"run", "--usbip", board.address.substr(6), program("drop-in-as-chai3d"), "1.0"});
  INFO(pulled.out, pulled.err);
  CHECK(ReportedVector(value_of(pulled.out, "position")).y - position.y ==
        doctest::Approx(1.0 / hand_N_per_m).scale(0).epsilon(0.2));
}

TEST_CASE(
    "`inkwell run` starts a virtual board for the program, reports the arm, and exits with the code of the program") {
  const auto run = run_program("inkwell", {"run", "--virtual", program("drop-in-as-chai3d")});
  INFO(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK(value_of(run.out, "position").substr(0, 2) == "0 ");
  CHECK(run.err.find("the program uses the arm") != std::string::npos);
  CHECK(run.err.find("a simulation") != std::string::npos);
  CHECK(run_program("inkwell", {"run", "--virtual", "sh", "-c", "exit 7"}).exit_code == 7);
  CHECK(run_program("inkwell", {"run", "--virtual", "sh", "-c", "kill -9 $$"}).exit_code == 137);
  CHECK(run_program("inkwell", {"--virtual", "run", "sh", "-c", "test \"$1\" = --help", "sh", "--help"}).exit_code ==
        0);
  CHECK(run_program("inkwell", {"run", "--virtual", "--", "sh", "-c", "test \"$1\" = --help", "sh", "--help"})
            .exit_code == 0);
  CHECK(run_program("inkwell", {"run", "--virtual", "--"}).exit_code == 2);
  CHECK(run_program("inkwell", {"run", "--virtaul", "true"}).exit_code == 2);
  const auto missing = run_program("inkwell", {"run", "--virtual", "/no/such/program"});
  CHECK(missing.exit_code == 1);
  CHECK(missing.err.find("/no/such/program cannot be started") != std::string::npos);
  CHECK(run_program("inkwell", {"run", "--virtual"}).exit_code == 2);
  CHECK(run_program("inkwell", {"run", "--usbip", "127.0.0.1:1", "true"}).exit_code == 1);
}

TEST_CASE("`inkwell run` reports a program that loads another library or needs a library of the vendor's driver") {
  Board board;
  const std::string server = board.address.substr(6);
  const auto other = run_program("inkwell", {"run", "--usbip", server, program("drop-in-uses-other-hd")});
  INFO(other.err);
  CHECK(other.exit_code == 3);
  CHECK(other.err.find("other/libHD.so, not the library of this arm") != std::string::npos);
  // The shell is the parent of the program.
  const auto child =
      run_program("inkwell", {"run", "--usbip", server, "sh", "-c", program("drop-in-uses-other-hd") + "; true"});
  CHECK(child.err.find("other/libHD.so, not the library of this arm") != std::string::npos);
  const auto own = run_program("inkwell", {"run", "--usbip", server, program("drop-in-as-chai3d")});
  CHECK(own.exit_code == 0);
  CHECK(own.err.find("not the library") == std::string::npos);
  const auto driver = run_program("inkwell", {"run", "--usbip", server, program("drop-in-uses-vendor-driver")});
  CHECK(driver.exit_code == 127);
  CHECK(driver.err.find("needs libPhantomIOLib42.so, a library of the vendor's driver") != std::string::npos);
}

TEST_CASE("`inkwell run` passes signals on") {
  Board board;
  RunningProgram run({program("inkwell"), "run", "--usbip", board.address.substr(6), "sh", "-c",
                      "trap 'exit 9' TERM; echo ready; while :; do sleep 0.01; done"});
  CHECK(run.read_line() == "ready");
  kill(run.process(), SIGTERM);
  CHECK(run.wait() == 9);
}

TEST_CASE("both sonames lead to the one library") {
  const auto libraries = build_directory() + "/dropins/";
  CHECK(std::filesystem::canonical(libraries + "libHD.so.3.0") ==
        std::filesystem::canonical(libraries + "libHD.so.3.4"));
  CHECK(std::filesystem::canonical(libraries + "libHD.so") == std::filesystem::canonical(libraries + "libHD.so.3.4"));
}

TEST_CASE(
    "the second of two driving programs gets an error that names the first program, and can drive after the first "
    "exits") {
  Board board;
  board.hold();
  const HHD before = hdInitDevice(nullptr);  // waits until the encoders are referenced
  REQUIRE(before == 0);
  while (hdCheckCalibration() != HD_CALIBRATION_OK) {
  }
  hdDisableDevice(before);
  {
    RunningProgram first({program("drop-in-as-hdapi")});
    CHECK(first.read_line() == "drives");
    CHECK(hdInitDevice(nullptr) == HD_INVALID_HANDLE);
    CHECK(hdGetError().errorCode == HD_DEVICE_FAULT);
    const std::string text = hdGetErrorString(HD_DEVICE_FAULT);
    INFO(text);
    CHECK(text.find("process " + std::to_string(first.process())) != std::string::npos);
    const double asked_s = board.time_s();
    while (board.pulled_m(0) < 0.0025 && board.time_s() < asked_s + 2.0) {
    }
    CHECK(board.pulled_m(0) > 0.0025);
    kill(first.process(), SIGKILL);
    CHECK(!first.wait());
  }
  const HHD device = hdInitDevice(nullptr);
  CHECK_MESSAGE(device == 0, std::string(hdGetErrorString(HD_DEVICE_FAULT)));
  hdDisableDevice(device);
}

TEST_CASE("a stopped program loses its force after the expiry in board time, and other programs are not delayed") {
  Board board;
  const auto watcher = device::Device::open(*board.board.find());
  const auto next_pose = [&] {
    const auto pose = watcher->read_pose(60s);
    REQUIRE_MESSAGE(pose.has_value(), "board time stands");
    return *pose;
  };
  while (next_pose().state != protocol::State::ready) continue;
  board.hold();
  const double expiry_s = watcher->parameters()[protocol::Parameter::program_force_expiry_s];
  RunningProgram hanging({program("drop-in-as-hdapi")});
  CHECK(hanging.read_line() == "drives");
  while (next_pose().force_N[0] < 0.9f) continue;
  kill(hanging.process(), SIGSTOP);
  const double stopped_s = board.time_s();  // the board has received everything that the program sent
  CHECK(board.control.status().all["usb"]["waits_for"].empty());
  double time_s = 0;
  do {
    const auto pose = next_pose();
    time_s = pose.time_periods / double{protocol::servo_rate_Hz};
    if (pose.force_N[0] == 0.0f) break;
  } while (time_s < stopped_s + 1.0);
  CHECK(time_s < stopped_s + expiry_s + 0.010);
  const auto information = run_program("inkwell", {"info", "--usbip", board.address.substr(6)});
  CHECK_MESSAGE(information.exit_code == 0, information.err);
  kill(hanging.process(), SIGCONT);
  hanging.write_line("");
  CHECK(hanging.wait() == 0);
}

TEST_CASE("the page's program pulls the hand to the middle of the box until Enter") {
  Board board;
  board.hold();
  RunningProgram well({program("inkwell"), "run", "--usbip", board.address.substr(6), program("drop-in-well")});
  CHECK(well.read_line() == "Press Enter to end.");
  // The springs of 300 and 100 N/m have rest positions 20 mm apart.
  const double asked_s = board.time_s();
  while (board.pulled_m(0) > -0.004 && board.time_s() < asked_s + 5.0) {
  }
  CHECK(board.pulled_m(0) < -0.004);
  well.write_line("");
  CHECK(well.wait() == 0);
}

TEST_CASE("a program that leaves main() with a scheduled callback exits normally, although its destructors are slow") {
  Board board;
  board.hold();
  RunningProgram leaving({program("drop-in-leaves")});
  CHECK(leaving.read_line() == "called");
  CHECK(leaving.wait() == 0);
}

TEST_CASE("a program whose callback ends it ends well, too, and its arm is free") {
  Board board;
  board.hold();
  for (int times = 0; times < 2; ++times) {
    RunningProgram leaving({program("drop-in-leaves"), "exits-in-callback"});
    CHECK(leaving.wait() == 3);
  }
}

TEST_CASE("forked children neither use nor disturb their parent's device, and none of them hangs") {
  Board board;
  for (const char* const interface : {"hdapi", "hdphantom"}) {
    CAPTURE(interface);
    const auto run = run_program("drop-in-forks", {interface});
    CHECK(run.exit_code == 0);
    CHECK_MESSAGE(run.out == "goes on\n", run.out, run.err);
  }
}

TEST_CASE("a program that ends between the beginning and the end of a frame: its force fades") {
  Board board;
  board.hold();
  {
    RunningProgram program_in_a_frame({program("drop-in-as-hdapi"), "ends-in-a-frame"});
    CHECK(program_in_a_frame.read_line() == "drives");
    CHECK(program_in_a_frame.wait() == 3);
  }
  const double end_s = board.time_s();
  while (board.time_s() < end_s + 0.5) {
  }
  CHECK(std::abs(board.pulled_m(0)) < 0.0015);
}

}  // namespace
}  // namespace inkwell::tests
