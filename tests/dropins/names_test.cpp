// Programs for two hands open their arms by name.
#include <doctest/doctest.h>

#include <dlfcn.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/bindings/dropins/device_names.hpp"
#include "host/client/device/arm_names.hpp"
#include "host/client/device/device.hpp"
#include "tests/environment.hpp"
#include "tests/failure.hpp"
#include "tests/system/program.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/dropins/board.hpp"
#include "tests/dropins/held.hpp"

namespace inkwell::tests {
namespace {

std::string program(const std::string& name) { return build_directory() + "/" + name; }

/// The hand of a named virtual board.
struct NamedHand {
  device::ControlClient control;
  explicit NamedHand(const device::NamedArm& arm) : control(device::parse_socket(arm.control)) {
    control.hand({.holds = true, .target_m = held_point_m, .stiffness_N_per_m = hand_N_per_m, .damping_Ns_per_m = 8});
    control.dock(false);
  }
  double displacement_m() { return control.truth().at("true_position_x_m").get<double>() - held_point_m[0]; }
  double time_s() { return control.status().board_time_s; }
};

TEST_CASE("a two-handed HDAPI program feels a different force on each of two virtual arms") {
  RunningProgram run({program("inkwell"), "run", "--virtual", "--arms", "2", program("drop-in-two-hands")});
  const auto arms = device::read_arm_names(run.read_line());
  REQUIRE(device::names_of(arms) == "left, right");
  CHECK(run.read_line() == "drives");
  NamedHand left(arms[0]), right(arms[1]);
  const double end_s = left.time_s() + 20;
  // A force of 1 N displaces a hand of 300 N/m by 3.3 mm.
  while ((left.displacement_m() < 0.002 || right.displacement_m() > -0.002) && left.time_s() < end_s) continue;
  CHECK(left.displacement_m() > 0.002);
  CHECK(right.displacement_m() < -0.002);
  run.write_line("");
  CHECK(run.wait() == 0);
}

TEST_CASE("an HDAPI program gets an error that lists the names, and one arm has one device") {
  const auto run =
      run_program("inkwell", {"run", "--virtual", "--arms", "left,right", program("drop-in-two-hands"), "wrong-name"});
  INFO(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK(contains(run.out, "There is no arm with the name Middle. Known names: left, right."));
  CHECK(contains(run.out, "300 "));
  CHECK(run.out.find("\n301 ") != std::string::npos);  // "Left" and "left device" are the same arm
  CHECK(run.err.find("the program uses the arm left, ") != std::string::npos);
  CHECK(run.err.find("its window and hand: inkwell --usbip unix:") != std::string::npos);
}

TEST_CASE("the words of HDAPI device names are optional") {
  std::vector<inkwell_named_arm> names{{"left", "1"}, {"Right", "2"}, {"Phantom2", "3"}, {"my touch", "4"}};
  for (const auto name : {"left", "Left PHANToM", "PHANToM Left", "Left Device", "LEFT OMNI", "Left Touch Device"})
    CHECK(dropins::bound_address(names, name) == "1");
  CHECK(dropins::bound_address(names, "right phantom") == "2");
  CHECK(dropins::bound_address(names, "PHANToM2") == "3");
  CHECK(dropins::bound_address(names, "My Touch") == "4");
  CHECK(dropins::bound_address({}, "left").empty());
  for (const auto name : {"PHANToM", "Leftmost", "PHANToM 1"})
    CHECK_THROWS_AS(dropins::bound_address(names, name), std::runtime_error);
}

TEST_CASE("INKWELL_DEVICE without a name selects its arm for all names of an HDAPI program") {
  Board board;
  const TemporaryDirectory directory;
  std::ofstream(directory / "arms.toml") << "[[arm]]\nname = \"left\"\naddress = \"2A\"\n";
  const Environment names("INKWELL_ARMS", directory.file("arms.toml"));
  HHD device = hdInitDevice("Left PHANToM");
  CHECK_MESSAGE(device != HD_INVALID_HANDLE, std::string(hdGetErrorString(HD_DEVICE_FAULT)));
  hdDisableDevice(device);
  const Environment by_name("INKWELL_DEVICE", "left");
  CHECK(hdInitDevice("Left PHANToM") == HD_INVALID_HANDLE);
  CHECK(only_error() == HD_DEVICE_FAULT);
  CHECK(says(HD_DEVICE_FAULT, "No arm with the serial number 2A"));
  setenv("INKWELL_DEVICE", board.address.c_str(), 1);
}

TEST_CASE("numbers of libhdPhantom follow the order of the names, and the arm of INKWELL_DEVICE has the number 0") {
  void* const library = dlopen((build_directory() + "/dropins/libhdPhantom.so").c_str(), RTLD_NOW);
  REQUIRE_MESSAGE(library != nullptr, std::string(dlerror()));
  const auto count = reinterpret_cast<int (*)()>(dlsym(library, "hdPhantomGetNumDevices"));
  const auto open = reinterpret_cast<int (*)(int)>(dlsym(library, "hdPhantomOpen"));
  const auto close = reinterpret_cast<int (*)(int)>(dlsym(library, "hdPhantomClose"));
  const Board left({.seed = 1}), right({.seed = 2});
  const TemporaryDirectory directory;
  std::ofstream(directory / "arms.toml") << "[[arm]]\nname = \"right\"\naddress = \"" << right.address
                                         << "\"\n[[arm]]\nname = \"left\"\naddress = \"" << left.address << "\"\n";
  const Environment names("INKWELL_ARMS", directory.file("arms.toml"));
  const auto serial_number_of = [&](int number) -> std::string {
    if (open(number) != number) return hdGetErrorString(HD_DEVICE_FAULT);
    std::string serial_number = hdGetString(HD_DEVICE_SERIAL_NUMBER);
    CHECK(close(number) == 0);
    return serial_number;
  };
  unsetenv("INKWELL_DEVICE");
  REQUIRE(count() >= 2);
  const std::string first = serial_number_of(0), second = serial_number_of(1);
  CHECK(first == device::Device::open(*right.board.find())->information().serial_number);
  CHECK(second == device::Device::open(*left.board.find())->information().serial_number);
  const Environment configured("INKWELL_DEVICE", "left");
  REQUIRE(count() >= 2);
  CHECK(serial_number_of(0) == second);
  CHECK(serial_number_of(1) == first);
  forget_errors();
}

TEST_CASE("a program in simulation cannot open a real arm by name") {
  const Environment names("INKWELL_ARMS", "/home/arms.toml");
  CHECK(run_program("inkwell", {"run", "--virtual", "sh", "-c", "exit ${#INKWELL_ARMS}"}).exit_code == 0);
}

TEST_CASE("--arms with wrong names is refused before the program starts") {
  const TemporaryDirectory directory;
  const Environment file("INKWELL_ARMS", directory.file("arms.toml"));
  const auto refusal = [](const std::vector<std::string>& options, int exit_code) {
    std::vector<std::string> words{"run"};
    words.insert(words.end(), options.begin(), options.end());
    words.emplace_back("true");
    const auto run = run_program("inkwell", words);
    CHECK_MESSAGE(run.exit_code == exit_code, run.err);
    return run.err;
  };
  CHECK(contains(refusal({"--arms", "left,right"}, 1), "no arm with the name left. No names are known. Bind"));
  CHECK(contains(refusal({"--arms", "2"}, 2), "requires --virtual"));
  CHECK(contains(refusal({"--virtual", "--arms", "0"}, 2), "Give 1 to 4"));
  CHECK(contains(refusal({"--virtual", "--arms", "left,Left"}, 2), "the name Left twice"));
  CHECK(contains(refusal({"--virtual", "--arms", "left,"}, 0), "arm left"));
  CHECK(contains(refusal({"--virtual", "--arms", ",left"}, 2), "not a name"));
  CHECK(contains(refusal({"--virtual", "--arms", "2", "--flash", "f.bin"}, 2), "memory of one board"));
  CHECK(contains(refusal({"--serial", "2A", "--arms", "left"}, 2), "Omit --serial"));
  Board board;
  std::ofstream(directory / "arms.toml") << "[[arm]]\nname = \"left\"\naddress = \"" << board.address
                                         << "\"\n[[arm]]\nname = \"right\"\naddress = \"" << board.address << "\"\n";
  CHECK(contains(refusal({"--arms", "left,right"}, 1), "right is a second name of the arm"));
  CHECK(contains(refusal({"--arms", "left,middle"}, 1), "Known names: left, right. Bind the name"));
}

TEST_CASE("`inkwell arms` binds, lists and removes names") {
  Board board;
  const TemporaryDirectory directory;
  const Environment file("INKWELL_ARMS", directory.file("new/arms.toml"));
  const auto arms = [](const std::vector<std::string>& options, int exit_code = 0) {
    std::vector<std::string> words{"arms"};
    words.insert(words.end(), options.begin(), options.end());
    const auto run = run_program("inkwell", words);
    CHECK_MESSAGE(run.exit_code == exit_code, run.err);
    return run.out + run.err;
  };
  CHECK(contains(arms({}), "No arm has a name"));
  CHECK(contains(arms({"bind", "left", board.address}), "now has the name left"));
  CHECK(contains(arms({"bind", "Left", "2A"}, 1), "already bound to " + board.address));
  CHECK(contains(arms({"bind", "right", "2A", "--control-socket", "unix:/run/c"}), "The arm 2A now has"));
  CHECK(contains(arms({}), board.address));
  CHECK(contains(arms({"--json"}), "\"control\": \"unix:/run/c\""));
  CHECK(contains(run_program("inkwell", {"info", "--serial", "LEFT"}).out, "omni_driver"));
  CHECK(contains(run_program("inkwell", {"devices", "--usbip", board.address, "--json"}).out, "\"name\": \"left\""));
  CHECK(contains(arms({"bind", "left", "2B", "--replace"}), "2B"));
  CHECK(contains(run_program("inkwell", {"info", "--serial", "left"}).err, "The arm left is not plugged in"));
  CHECK(contains(arms({"unbind", "middle"}, 1), "Known names: left, right."));
  CHECK(contains(arms({"unbind", "left"}), "removed"));
  CHECK_FALSE(contains(arms({}), "left"));
  CHECK(contains(arms({"bind", "a,b"}, 2), "not a name"));
  CHECK(contains(arms({"bind", "left", "right"}, 2), "`right` is not an address"));
  CHECK(contains(arms({"bind", "left", "usbip:"}, 2), "127.0.0.1:3240"));
}

}  // namespace
}  // namespace inkwell::tests
