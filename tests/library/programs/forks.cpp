// Forks many times in the main thread and then in the servo, while the library's threads run. A child calls every
// function on its parent's arm, closes this arm, opens another arm, and exits with all destructors. Prints each
// unexpected result, and then the state of the parent.
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <inkwell/inkwell.hpp>

namespace {

/// The destructor of a global object closes the arm in each process.
struct LateArm {
  inkwell_arm* arm = nullptr;
  ~LateArm() { inkwell_close(arm); }
} late;

std::string expected;

void check(const char* what, inkwell_result result) {
  if (result == INKWELL_REFUSED && inkwell_error_text() == expected) return;
  std::printf("%s gives %d in a child: %s\n", what, result, inkwell_error_text());
}

void call_everything() {
  inkwell_arm* const arm = late.arm;
  inkwell_pose pose;
  inkwell_information information;
  inkwell_store store;
  inkwell_driver driver;
  inkwell_test_item item;
  char board[INKWELL_BOARD_NAME_SIZE];
  float sample = 0;
  double value = 1;
  std::size_t count = 0;
  int flag = 0;
  const double vector[3]{}, joint_rad[3]{};
  const char* const name = "supply_V";
  const char* const parameter = "wall_stiffness_N_per_m";
  const auto servo = [](inkwell_arm*, const inkwell_pose*, double*, void*) { return 0; };
  check("get_information", inkwell_get_information(arm, &information));
  check("get_board_name", inkwell_get_board_name(arm, board));
  check("get_pose", inkwell_get_pose(arm, &pose));
  check("wait_for_pose", inkwell_wait_for_pose(arm, 1000, &pose));
  check("is_referenced", inkwell_is_referenced(arm, &flag));
  check("forward_kinematics", inkwell_forward_kinematics(arm, joint_rad, nullptr, nullptr));
  check("enable_force", inkwell_enable_force(arm, 1000));
  check("disable_force", inkwell_disable_force(arm));
  check("stop", inkwell_stop(arm));
  check("take_over", inkwell_take_over(arm));
  check("get_driver", inkwell_get_driver(arm, &driver));
  check("clear_fault", inkwell_clear_fault(arm));
  check("set_force_mode", inkwell_set_force_mode(arm, INKWELL_BESIDE_WALLS));
  check("set_force", inkwell_set_force(arm, vector));
  check("start_servo", inkwell_start_servo(arm, servo, nullptr));
  check("stop_servo", inkwell_stop_servo(arm));
  check("servo_result", inkwell_servo_result(arm));
  if (inkwell_servo_is_running(arm) != 0) std::puts("a servo runs in a child");
  check("place_shapes", inkwell_place_shapes(arm, nullptr, 0, nullptr));
  check("get_parameter", inkwell_get_parameter(arm, parameter, &value));
  check("set_parameters", inkwell_set_parameters(arm, &parameter, &value, 1));
  check("store_parameters", inkwell_store_parameters(arm));
  check("restore_parameters", inkwell_restore_parameters(arm));
  check("factory_reset", inkwell_factory_reset(arm));
  check("get_stored_parameter", inkwell_get_stored_parameter(arm, parameter, &value));
  check("get_store", inkwell_get_store(arm, &store));
  check("self_test", inkwell_self_test(arm, &item, 1, &count));
  check("get_self_test", inkwell_get_self_test(arm, &item, 1, &count));
  check("move_virtual_hand", inkwell_move_virtual_hand(arm, vector, 300));
  check("release_virtual_hand", inkwell_release_virtual_hand(arm));
  check("press_virtual_buttons", inkwell_press_virtual_buttons(arm, 1, 0));
  check("select_signals", inkwell_select_signals(arm, &name, 1));
  check("read_scope", inkwell_read_scope(arm, 1000, &sample, nullptr, 1, &count, nullptr));
  check("start_recording", inkwell_start_recording(arm, "child.csv"));
  check("stop_recording", inkwell_stop_recording(arm, nullptr, nullptr));
  inkwell_parameter_at(0);
  inkwell_signal_at(0);
  if (inkwell_close(arm) != INKWELL_OK) std::puts("close does not end well in a child");
  late.arm = nullptr;
}

void open_another() {
  try {
    inkwell::Arm own("virtual");
    own.wait_for_pose(60);
  } catch (const inkwell::Failure& failure) {
    std::printf("a child cannot open an arm: %s\n", failure.what());
  }
}

/// Returns the exit code, or 99 if a signal ended the child.
int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
}

void fork_and_wait(int round) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    if (round % 2 == 0) call_everything();  // odd rounds: destructors only
    if (round == 0) open_another();
    std::exit(0);
  }
  if (const int code = wait_for(child); code != 0) std::printf("the child of round %d ends with %d\n", round, code);
}

struct Servo {
  std::atomic<int> calls = 0;
  std::atomic<bool> forks = false;
  std::atomic<pid_t> child = 0;
};

int call_servo(inkwell_arm*, const inkwell_pose*, double*, void* user) {
  auto& servo = *static_cast<Servo*>(user);
  if (servo.forks.exchange(false)) {
    const pid_t child = fork();
    if (child == 0)
      alarm(120);
    else
      servo.child = child;
  }
  ++servo.calls;
  return 0;
}

void require(inkwell_result result) {
  if (result == INKWELL_OK) return;
  std::printf("a call of the parent fails: %s\n", inkwell_error_text());
  std::fflush(stdout);
  std::_Exit(1);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  expected = "The arm was opened by process " + std::to_string(getpid()) + ". Open the arm again in this process.";
  require(inkwell_open("virtual", &late.arm));
  static Servo servo;
  const char* const names[]{"supply_V", "position_x_m"};
  require(inkwell_start_servo(late.arm, call_servo, &servo));
  require(inkwell_select_signals(late.arm, names, 2));
  require(inkwell_start_recording(late.arm, arguments[1]));
  for (int round = 0; round < 40; ++round) fork_and_wait(round);
  servo.forks = true;
  while (servo.child == 0) usleep(1000);
  if (const int code = wait_for(servo.child); code != 0) std::printf("the child of the servo ends with %d\n", code);

  inkwell_pose pose;
  const int calls = servo.calls;
  for (int i = 0; i < 100; ++i) require(inkwell_wait_for_pose(late.arm, 60, &pose));
  require(inkwell_press_virtual_buttons(late.arm, 1, 0));
  uint64_t samples = 0, lost = 0;
  require(inkwell_stop_recording(late.arm, &samples, &lost));
  std::printf("servo %s\n", inkwell_servo_is_running(late.arm) != 0 && servo.calls > calls ? "runs" : "has ended");
  inkwell_driver driver;
  require(inkwell_get_driver(late.arm, &driver));
  if (driver.is_this_arm == 0) std::puts("the parent has lost its claim");
  std::printf("samples %llu lost %llu\n", static_cast<unsigned long long>(samples),
              static_cast<unsigned long long>(lost));
  return 0;
}
