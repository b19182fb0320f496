// Arm object for the Python interpreter. Calls release the interpreter's lock while they wait, and react to Ctrl-C.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/client/process/fork.hpp"

#include "host/bindings/python/failure.hpp"

namespace inkwell::python {

class Arm {
 public:
  /// Without a time-out, the library's time-out applies.
  explicit Arm(const std::string& address, std::optional<double> timeout_s = std::nullopt);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  void close();
  bool is_closed() const;

  Pose pose();
  Pose wait_for_pose(double timeout_s);
  void sleep(double duration_s);
  inkwell_information information();
  std::string board_name();
  bool is_referenced();

  inkwell_arm_state state();
  inkwell_abilities abilities();
  /// (position_m, Jacobian in row-major order)
  std::pair<Vector, std::array<double, 9>> forward_kinematics(const Vector& joint_rad);
  Vector force_of_torques(const Vector& joint_rad, const Vector& torque_Nm);
  void set_joint_torques(const Vector& torque_Nm);
  void claim();
  void release();
  void set_thread_priority(int priority);

  void enable_force(double timeout_s);
  void disable_force();
  void stop();
  void take_over();
  inkwell_driver driver();
  void clear_fault();
  void set_force_mode(inkwell_force_mode mode);
  void set_force(const std::array<double, 3>& force_N);
  void place_shapes(const inkwell_shapes& shapes);
  /// Calls a function of the library with the arm.
  template <class Call>
  void use(Call library_call) {
    const Use arm(*this);
    call([&] { return library_call(arm); });
  }

  void start_servo(py::function servo);
  /// Raises the servo's exception, or another error that has ended the servo.
  void stop_servo();
  bool servo_is_running();
  /// Raises the error that has ended the servo. Each error is raised only once.
  void check_servo();

  double parameter(const std::string& name);
  void set_parameters(const std::vector<std::pair<std::string, double>>& changes);
  double stored_parameter(const std::string& name);
  void store_parameters();
  void restore_parameters();
  void factory_reset();
  inkwell_store store();
  std::vector<inkwell_test_item> self_test();
  std::vector<inkwell_test_item> last_self_test();

  void move_virtual_hand(const std::array<double, 3>& target_m, double stiffness_N_per_m);
  void release_virtual_hand();
  void press_virtual_buttons(bool button_1, bool button_2);

  void connect_virtual_hand(const std::string& control);
  void hold_virtual_hand(const std::array<double, 3>& target_m, double stiffness_N_per_m, double damping_Ns_per_m);
  void move_virtual_hand_along(const std::vector<std::pair<double, std::array<double, 3>>>& path);
  std::string virtual_truth();

  void select_signals(const std::vector<std::string>& names);
  /// Returns (values, periods, lost) with at most `rows` rows, and one column of values for each signal. Returns no
  /// rows after a time-out. With `fill`, the function returns exactly `rows` rows, and raises TimedOut if no row
  /// arrives within `timeout_s`.
  py::tuple read_scope(std::size_t rows, double timeout_s, bool fill);
  void start_recording(const std::string& path);
  /// (samples, lost, complete)
  std::tuple<std::uint64_t, std::uint64_t, bool> finish_recording();
  void describe_recordings(const std::string& name, const std::string& note);
  void mark(const std::string& text);
  inkwell_losses losses();
  /// The unit is "V" or "A".
  void send_test_pulse(int motor, const std::string& unit, double amplitude, double duration_s);

 private:
  std::vector<inkwell_test_item> test_items(decltype(&inkwell_self_test) test);

  /// The arm stays open while a Use object exists. The constructor raises Refused if the arm is closed or belongs to
  /// the parent process.
  class Use {
   public:
    explicit Use(Arm& arm);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    operator inkwell_arm*() const { return arm_.arm_; }

   private:
    Arm& arm_;
  };
  struct Servo {
    py::function function;
    std::exception_ptr raised;
    bool is_told = false;  ///< true once another reason for the end was raised
  };
  /// Reason why a servo has ended.
  struct Ending {
    std::exception_ptr raised;
    inkwell_result result = INKWELL_OK;
    std::string sentence;
    Pose last_pose{};
    void raise_it() const;
  };

  static int call_servo(inkwell_arm* arm, const inkwell_pose* pose, double force_N[3], void* user) noexcept;
  /// Returns and clears the reason why the servo has ended.
  Ending take_ending();
  /// Calls the library without the interpreter's lock and raises its errors.
  template <class Call>
  void call(Call library_call);
  /// Repeats short calls of `attempt(arm, time)` while `goes_on` returns true, so that Ctrl-C and close() take effect.
  template <class Attempt, class GoesOn>
  void call_patiently(double timeout_s, Attempt attempt, GoesOn goes_on);
  template <class Attempt>
  void call_patiently(double timeout_s, Attempt attempt) {
    call_patiently(timeout_s, attempt, [](inkwell_result result) { return result == INKWELL_TIMED_OUT; });
  }

  inkwell_arm* arm_ = nullptr;
  mutable std::mutex mutex_;
  std::condition_variable unused_;
  int uses_ = 0;
  std::atomic<bool> closed_ = false;
  const process::Origin origin_;
  std::mutex servo_mutex_;
  std::unique_ptr<Servo> servo_;  ///< guarded by servo_mutex_; its content by the interpreter's lock

  std::mutex scope_mutex_;  ///< the signals do not change while samples are read
  std::size_t signal_count_ = 0;
};

template <class Call>
void Arm::call(Call library_call) {
  inkwell_result result;
  std::string sentence;
  Pose last_pose{};
  {
    const process::CancellationGuard guard;
    const py::gil_scoped_release unlocked;
    result = library_call();
    if (result != INKWELL_OK) sentence = inkwell_error_text();
    if (result == INKWELL_DISCONNECTED && arm_ != nullptr) inkwell_get_pose(arm_, &last_pose);
  }
  if (result != INKWELL_OK) raise(result, sentence, result == INKWELL_DISCONNECTED ? &last_pose : nullptr);
}

template <class Attempt, class GoesOn>
void Arm::call_patiently(double timeout_s, Attempt attempt, GoesOn goes_on) {
  constexpr double attempt_s = 0.05;
  if (!(timeout_s >= 0)) raise(INKWELL_BAD_ARGUMENT, "The time-out is no time. Give seconds, from 0 on.");
  // The loop counts attempts instead of wall time, because the library waits in board time.
  for (double left_s = timeout_s;; left_s -= attempt_s) {
    const bool is_last = left_s <= attempt_s;
    inkwell_result result;
    std::string sentence;
    Pose last_pose{};
    {
      const Use arm(*this);
      const process::CancellationGuard guard;
      const py::gil_scoped_release unlocked;
      result = attempt(static_cast<inkwell_arm*>(arm), is_last ? left_s : attempt_s);
      if (result != INKWELL_OK) sentence = inkwell_error_text();
      if (result == INKWELL_DISCONNECTED) inkwell_get_pose(arm, &last_pose);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (result == INKWELL_OK) return;
    if (is_last || !goes_on(result)) raise(result, sentence, result == INKWELL_DISCONNECTED ? &last_pose : nullptr);
  }
}

}  // namespace inkwell::python
