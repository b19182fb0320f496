// C++ interface of libinkwell with RAII and exceptions.
//
// Example:
//   inkwell::Arm arm;                                  // the only arm on USB, or the arm that INKWELL_DEVICE names
//   arm.enable_force();
//   arm.start_servo([](const inkwell::Pose& pose) {    // 1000 times per second
//     return inkwell::Vector{-200.0 * pose.position_m[0], 0.0, 0.0};
//   });
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <inkwell/inkwell.h>

namespace inkwell {

using Pose = inkwell_pose;
using Plane = inkwell_plane;
using Sphere = inkwell_sphere;
using Vector = std::array<double, 3>;  ///< in the workspace axes

/// Thrown if a library function does not return INKWELL_OK. The function what() returns the error text.
class Failure : public std::runtime_error {
 public:
  explicit Failure(inkwell_result failed) : std::runtime_error(inkwell_error_text()), result(failed) {}
  inkwell_result result;
};

/// Thrown if no poses arrive, because the link to the arm is lost or the arm is silent. The library reconnects
/// automatically; see INKWELL_DISCONNECTED.
class Disconnected : public Failure {
 public:
  Disconnected() : Failure(INKWELL_DISCONNECTED) {}
  Pose last_pose{};  ///< the last known pose
};

/// Throws Failure unless the result is INKWELL_OK.
inline void require(inkwell_result result) {
  if (result != INKWELL_OK) throw Failure(result);
}

/// See inkwell_list_devices().
inline std::vector<inkwell_device> devices() {
  std::size_t count = 0;
  require(inkwell_list_devices(nullptr, 0, &count));
  std::vector<inkwell_device> list(count);
  require(inkwell_list_devices(list.data(), list.size(), &count));
  if (count < list.size()) list.resize(count);  // an arm was unplugged in between
  return list;
}

/// An open arm. The destructor closes the arm. Each function calls the C function of the same name. Each C++ function
/// throws Failure if its C function does not return INKWELL_OK, and Disconnected while no poses arrive. Moving an Arm
/// object also moves its running servo. All functions of a moved-from arm throw Failure with INKWELL_BAD_ARGUMENT. A
/// servo function must not destroy its arm.
class Arm {
 public:
  /// Returns the force on the hand. An exception of the function stops the servo, and stop_servo() throws this
  /// exception. The next stop_servo(), start_servo() or wait_for_pose() throws any other error that stopped the servo.
  using Servo = std::function<Vector(const Pose&)>;

  /// Accepts the addresses of inkwell_open().
  explicit Arm(const std::string& address = "") : opened_(new Opened) {
    require(inkwell_open(address.c_str(), &opened_->arm));
  }

  /// Returns the arm for the C interface, or null for a moved-from arm. Do not call inkwell_close() for this arm.
  inkwell_arm* get() const { return opened_ ? opened_->arm : nullptr; }

  Pose pose() const {
    Pose pose;
    require(inkwell_get_pose(get(), &pose));
    return pose;
  }
  Pose wait_for_pose(double timeout_s = 2.0) const {
    throw_what_ended_servo();
    Pose pose;
    require(inkwell_wait_for_pose(get(), timeout_s, &pose));
    return pose;
  }
  void sleep(double duration_s) const { require(inkwell_sleep(get(), duration_s)); }
  inkwell_information information() const {
    inkwell_information information;
    require(inkwell_get_information(get(), &information));
    return information;
  }
  bool is_referenced() const {
    int is_referenced = 0;
    require(inkwell_is_referenced(get(), &is_referenced));
    return is_referenced != 0;
  }
  std::string board_name() const {
    char name[INKWELL_BOARD_NAME_SIZE];
    require(inkwell_get_board_name(get(), name));
    return name;
  }

  void enable_force(double timeout_s = 5.0) { require(inkwell_enable_force(get(), timeout_s)); }
  void disable_force() { require(inkwell_disable_force(get())); }
  void stop() { require(inkwell_stop(get())); }
  void take_over() { require(inkwell_take_over(get())); }
  inkwell_driver driver() {
    inkwell_driver driver{};
    require(inkwell_get_driver(get(), &driver));
    return driver;
  }
  /// Throws Failure with INKWELL_REFUSED if the fault recurs.
  void clear_fault() { require(inkwell_clear_fault(get())); }
  void set_force_mode(inkwell_force_mode mode) { require(inkwell_set_force_mode(get(), mode)); }
  void set_force(const Vector& force_N) { require(inkwell_set_force(get(), force_N.data())); }
  void place_shapes(const std::vector<Plane>& planes, const Sphere* sphere = nullptr) {
    require(inkwell_place_shapes(get(), planes.data(), planes.size(), sphere));
  }

  void start_servo(Servo servo) {
    throw_what_ended_servo();
    if (!opened_) return require(inkwell_start_servo(nullptr, &Arm::call_servo, nullptr));
    std::unique_ptr<ServoState> state(new ServoState(std::move(servo)));
    // If another thread stops the new servo, stop_servo() must find the new state.
    const std::lock_guard<std::mutex> lock(opened_->mutex);
    require(inkwell_start_servo(get(), &Arm::call_servo, state.get()));
    opened_->servo.swap(state);
  }
  /// Throws the exception or the error that stopped the servo.
  void stop_servo() {
    require(inkwell_stop_servo(get()));
    std::exception_ptr thrown;
    {
      const std::lock_guard<std::mutex> lock(opened_->mutex);
      if (opened_->servo) thrown = opened_->servo->take_thrown();
    }
    if (thrown) std::rethrow_exception(thrown);
    throw_what_ended_servo();
  }
  bool servo_is_running() const { return inkwell_servo_is_running(get()) != 0; }

  double parameter(const std::string& name) const {
    double value = 0;
    require(inkwell_get_parameter(get(), name.c_str(), &value));
    return value;
  }
  void set_parameter(const std::string& name, double value) {
    const char* names[] = {name.c_str()};
    require(inkwell_set_parameters(get(), names, &value, 1));
  }
  void store_parameters() { require(inkwell_store_parameters(get())); }
  void restore_parameters() { require(inkwell_restore_parameters(get())); }
  void factory_reset() { require(inkwell_factory_reset(get())); }
  double stored_parameter(const std::string& name) const {
    double value = 0;
    require(inkwell_get_stored_parameter(get(), name.c_str(), &value));
    return value;
  }
  /// Runs a self-test and returns its items. With `only_last`, returns the items of the last self-test.
  std::vector<inkwell_test_item> self_test(bool only_last = false) {
    const auto test = only_last ? inkwell_get_self_test : inkwell_self_test;
    std::vector<inkwell_test_item> items(64);
    std::size_t count = 0;
    require(test(get(), items.data(), items.size(), &count));
    items.resize(std::min(count, items.size()));
    return items;
  }
  inkwell_store store() const {
    inkwell_store store;
    require(inkwell_get_store(get(), &store));
    return store;
  }

 private:
  /// Throws Disconnected for INKWELL_DISCONNECTED, and Failure for other errors.
  void require(inkwell_result result) const {
    if (result != INKWELL_DISCONNECTED) return inkwell::require(result);
    Disconnected lost;
    inkwell_get_pose(get(), &lost.last_pose);
    throw lost;
  }
  void throw_what_ended_servo() const {
    if (!opened_ || servo_is_running()) return;
    const auto result = inkwell_servo_result(get());
    {
      const std::lock_guard<std::mutex> lock(opened_->mutex);
      if (!opened_->servo || opened_->servo->is_reported) return;
      opened_->servo->is_reported = result != INKWELL_OK;
    }
    require(result);
  }
  class ServoState {
   public:
    explicit ServoState(Servo servo) : servo_(std::move(servo)) {}

    /// Returns false if the servo function throws an exception.
    bool call(const Pose& pose, double force_N[3]) noexcept {
      try {
        const Vector wanted_N = servo_(pose);
        std::copy(wanted_N.begin(), wanted_N.end(), force_N);
        return true;
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        thrown_ = std::current_exception();
        return false;
      }
    }
    std::exception_ptr take_thrown() {
      const std::lock_guard<std::mutex> lock(mutex_);
      return std::exchange(thrown_, nullptr);
    }

    bool is_reported = false;  ///< the stop cause was thrown, or is the program; guarded by the mutex of Opened

   private:
    const Servo servo_;
    std::mutex mutex_;
    std::exception_ptr thrown_;
  };

  /// The C arm and the state of its servo. A move of Arm does not change the address of this object.
  struct Opened {
    Opened() = default;
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;
    ~Opened() {
      // inkwell_close() fails in a servo, and the running servo still needs its state.
      if (inkwell_close(arm) != INKWELL_OK) static_cast<void>(servo.release());
    }

    inkwell_arm* arm = nullptr;
    std::mutex mutex;  ///< guards `servo`
    std::unique_ptr<ServoState> servo;
  };

  static int call_servo(inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) noexcept {
    return static_cast<ServoState*>(user)->call(*pose, force_N) ? 0 : 1;
  }

  std::unique_ptr<Opened> opened_;
};

}  // namespace inkwell
