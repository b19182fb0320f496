#include "host/bindings/python/arm.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <pybind11/stl.h>

namespace inkwell::python {
namespace {

/// This flag is true in the thread that calls a servo.
thread_local bool in_servo = false;

/// None means zero force. Any value other than three finite numbers throws an exception, which stops the servo.
Vector force_of(const py::object& answer) {
  if (answer.is_none()) return {};
  Vector force_N;
  try {
    force_N = answer.cast<Vector>();
  } catch (const py::cast_error&) {
    throw py::type_error("The servo returned " + std::string(py::repr(answer)) +
                         ". Return three numbers, the force in N, or None.");
  }
  for (const double value : force_N)
    if (!std::isfinite(value))
      throw py::value_error(
          "The servo returned a force that is not a finite number on one axis. Return finite numbers.");
  return force_N;
}

}  // namespace

void raise(inkwell_result result, const std::string& sentence, const Pose* last_pose) {
  const py::object classes = py::module_::import("inkwell.errors").attr("BY_RESULT");
  const py::object type = classes[py::int_(static_cast<int>(result))];
  const py::object error = type(sentence);
  if (last_pose != nullptr) error.attr("last_pose") = *last_pose;
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

Arm::Use::Use(Arm& arm) : arm_(arm) {
  if (!arm.origin_.is_here()) {  // after fork(), copied locks may be locked by threads that do not exist here
    int is_referenced = 0;
    const auto result = inkwell_is_referenced(arm.arm_, &is_referenced);
    raise(result, inkwell_error_text());
  }
  bool closed;
  {
    const std::lock_guard lock(arm.mutex_);
    closed = arm.closed_;
    if (!closed) ++arm.uses_;
  }
  if (closed) raise(INKWELL_REFUSED, "The arm is closed. Open it again.");
}

Arm::Use::~Use() {
  const std::lock_guard lock(arm_.mutex_);
  if (--arm_.uses_ == 0) arm_.unused_.notify_all();
}

Arm::Arm(const std::string& address, std::optional<double> timeout_s) {
  call([&] {
    return timeout_s ? inkwell_open_with_timeout(address.c_str(), *timeout_s, &arm_)
                     : inkwell_open(address.c_str(), &arm_);
  });
}

Arm::~Arm() {
  const py::error_scope keeps_what_is_being_raised;
  try {
    close();
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("an arm that was not closed");
  } catch (const py::builtin_exception&) {  // the exception can no longer be raised
  }
}

bool Arm::is_closed() const { return closed_; }

void Arm::close() {
  if (!origin_.is_here()) closed_ = true;  // only the parent process can close the arm
  if (is_closed()) return;
  if (in_servo)
    raise(INKWELL_REFUSED, "A servo cannot close its own arm. Stop the servo, and close the arm in another thread.");
  Ending ending;
  {
    const Use arm(*this);
    call([&] { return inkwell_stop_servo(arm); });
    ending = take_ending();
  }
  {
    const process::CancellationGuard guard;
    const py::gil_scoped_release unlocked;
    std::unique_lock lock(mutex_);
    if (closed_) return;
    closed_ = true;
    unused_.wait(lock, [&] { return uses_ == 0; });
    lock.unlock();
    inkwell_close(arm_);
  }
  ending.raise_it();
}

// ---- pose --------------------------------------------------------------------------------------------------

Pose Arm::pose() {
  const Use arm(*this);
  Pose pose;
  call([&] { return inkwell_get_pose(arm, &pose); });
  return pose;
}

Pose Arm::wait_for_pose(double timeout_s) {
  check_servo();
  Pose pose;
  call_patiently(timeout_s, [&](inkwell_arm* arm, double time_s) { return inkwell_wait_for_pose(arm, time_s, &pose); });
  return pose;
}

void Arm::sleep(double duration_s) {
  if (!(duration_s >= 0)) raise(INKWELL_BAD_ARGUMENT, "The duration is not valid. Give a time of 0 s or more.");
  constexpr double attempt_s = 0.05;   // short, so that Ctrl-C is handled soon
  constexpr double rounding_s = 1e-6;  // inkwell_sleep() does not wait for a shorter time
  const double end_s = pose().time_s + duration_s;
  for (double left_s = duration_s; left_s > rounding_s; left_s = end_s - pose().time_s) {
    const Use arm(*this);
    call([&] { return inkwell_sleep(arm, std::min(left_s, attempt_s)); });
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

bool Arm::is_referenced() {
  const Use arm(*this);
  int is_referenced = 0;
  call([&] { return inkwell_is_referenced(arm, &is_referenced); });
  return is_referenced != 0;
}

inkwell_information Arm::information() {
  const Use arm(*this);
  inkwell_information information;
  call([&] { return inkwell_get_information(arm, &information); });
  return information;
}

std::string Arm::board_name() {
  const Use arm(*this);
  char name[INKWELL_BOARD_NAME_SIZE];
  call([&] { return inkwell_get_board_name(arm, name); });
  return name;
}

// ---- force -------------------------------------------------------------------------------------------------

void Arm::enable_force(double timeout_s) {
  call_patiently(
      timeout_s, [](inkwell_arm* arm, double time_s) { return inkwell_enable_force(arm, time_s); },
      [this](inkwell_result result) {
        // The call is repeated after a time-out or a temporary refusal.
        return result == INKWELL_TIMED_OUT || (result == INKWELL_REFUSED && pose().state != INKWELL_FAULT);
      });
}

void Arm::disable_force() {
  const Use arm(*this);
  call([&] { return inkwell_disable_force(arm); });
}

void Arm::stop() {
  const Use arm(*this);
  call([&] { return inkwell_stop(arm); });
}

void Arm::take_over() {
  const Use arm(*this);
  call([&] { return inkwell_take_over(arm); });
}

inkwell_driver Arm::driver() {
  const Use arm(*this);
  inkwell_driver driver;
  call([&] { return inkwell_get_driver(arm, &driver); });
  return driver;
}

void Arm::clear_fault() {
  const Use arm(*this);
  call([&] { return inkwell_clear_fault(arm); });
}

void Arm::set_force_mode(inkwell_force_mode mode) {
  const Use arm(*this);
  call([&] { return inkwell_set_force_mode(arm, mode); });
}

void Arm::set_force(const std::array<double, 3>& force_N) {
  const Use arm(*this);
  call([&] { return inkwell_set_force(arm, force_N.data()); });
}

void Arm::place_shapes(const inkwell_shapes& shapes) {
  const Use arm(*this);
  call([&] { return inkwell_place_all_shapes(arm, &shapes, sizeof shapes); });
}

// ---- the servo ---------------------------------------------------------------------------------------------

int Arm::call_servo(inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) noexcept {
  auto& servo = *static_cast<Servo*>(user);
  const py::gil_scoped_acquire locked;
  in_servo = true;
  try {
    const Vector wanted_N = force_of(servo.function(*pose));
    for (std::size_t i = 0; i < 3; ++i) force_N[i] = wanted_N[i];
    return 0;
  } catch (...) {
    servo.raised = std::current_exception();
    return 1;
  }
}

void Arm::start_servo(py::function servo) {
  const Use arm(*this);
  if (!servo_is_running()) take_ending().raise_it();
  auto next = std::make_unique<Servo>(Servo{std::move(servo), nullptr});
  call([&] {
    // Without the lock, two concurrent calls could store the wrong servo.
    const std::lock_guard lock(servo_mutex_);
    const auto result = inkwell_start_servo(arm, &Arm::call_servo, next.get());
    if (result == INKWELL_OK) servo_.swap(next);  // the previous servo is destroyed with the interpreter's lock
    return result;
  });
}

void Arm::stop_servo() {
  const Use arm(*this);
  call([&] { return inkwell_stop_servo(arm); });
  if (!in_servo) take_ending().raise_it();
}

bool Arm::servo_is_running() {
  const Use arm(*this);
  const process::CancellationGuard guard;
  const py::gil_scoped_release unlocked;
  return inkwell_servo_is_running(arm) != 0;
}

void Arm::check_servo() {
  const Use arm(*this);
  bool has_raised = true;
  {
    const std::lock_guard lock(servo_mutex_);
    if (servo_) has_raised = servo_->raised != nullptr;
  }
  if (!has_raised && !servo_is_running()) take_ending().raise_it();
}

Arm::Ending Arm::take_ending() {
  Ending ending;
  {
    const std::lock_guard lock(servo_mutex_);
    if (!servo_) return ending;
    ending.raised = std::exchange(servo_->raised, nullptr);
    if (ending.raised || std::exchange(servo_->is_told, true)) return ending;
  }
  const process::CancellationGuard guard;
  const py::gil_scoped_release unlocked;
  ending.result = inkwell_servo_result(arm_);
  if (ending.result == INKWELL_OK) return ending;
  ending.sentence = inkwell_error_text();
  inkwell_get_pose(arm_, &ending.last_pose);
  return ending;
}

void Arm::Ending::raise_it() const {
  if (raised) std::rethrow_exception(raised);
  if (result != INKWELL_OK) raise(result, sentence, result == INKWELL_DISCONNECTED ? &last_pose : nullptr);
}

// ---- parameters --------------------------------------------------------------------------------------------

double Arm::parameter(const std::string& name) {
  const Use arm(*this);
  double value = 0;
  call([&] { return inkwell_get_parameter(arm, name.c_str(), &value); });
  return value;
}

void Arm::set_parameters(const std::vector<std::pair<std::string, double>>& changes) {
  const Use arm(*this);
  std::vector<const char*> names;
  std::vector<double> values;
  for (const auto& [name, value] : changes) {
    names.push_back(name.c_str());
    values.push_back(value);
  }
  call([&] { return inkwell_set_parameters(arm, names.data(), values.data(), names.size()); });
}

double Arm::stored_parameter(const std::string& name) {
  const Use arm(*this);
  double value = 0;
  call([&] { return inkwell_get_stored_parameter(arm, name.c_str(), &value); });
  return value;
}

void Arm::store_parameters() {
  const Use arm(*this);
  call([&] { return inkwell_store_parameters(arm); });
}

void Arm::restore_parameters() {
  const Use arm(*this);
  call([&] { return inkwell_restore_parameters(arm); });
}

void Arm::factory_reset() {
  const Use arm(*this);
  call([&] { return inkwell_factory_reset(arm); });
}

inkwell_store Arm::store() {
  const Use arm(*this);
  inkwell_store store;
  call([&] { return inkwell_get_store(arm, &store); });
  return store;
}

// ---- self-test ---------------------------------------------------------------------------------------------

std::vector<inkwell_test_item> Arm::self_test() { return test_items(inkwell_self_test); }

std::vector<inkwell_test_item> Arm::last_self_test() { return test_items(inkwell_get_self_test); }

std::vector<inkwell_test_item> Arm::test_items(decltype(&inkwell_self_test) test) {
  const Use arm(*this);
  std::vector<inkwell_test_item> items;
  std::size_t count = 0;
  call([&] { return inkwell_get_self_test(arm, nullptr, 0, &count); });
  items.resize(count);
  call([&] { return test(arm, items.data(), items.size(), &count); });
  return items;
}

// ---- virtual hand ------------------------------------------------------------------------------------------

void Arm::move_virtual_hand(const std::array<double, 3>& target_m, double stiffness_N_per_m) {
  const Use arm(*this);
  call([&] { return inkwell_move_virtual_hand(arm, target_m.data(), stiffness_N_per_m); });
}

void Arm::release_virtual_hand() {
  const Use arm(*this);
  call([&] { return inkwell_release_virtual_hand(arm); });
}

void Arm::connect_virtual_hand(const std::string& control) {
  const Use arm(*this);
  call([&] { return inkwell_connect_virtual_hand(arm, control.c_str()); });
}

void Arm::hold_virtual_hand(const std::array<double, 3>& target_m, double stiffness_N_per_m, double damping_Ns_per_m) {
  const Use arm(*this);
  call([&] { return inkwell_hold_virtual_hand(arm, target_m.data(), stiffness_N_per_m, damping_Ns_per_m); });
}

void Arm::move_virtual_hand_along(const std::vector<std::pair<double, std::array<double, 3>>>& path) {
  const Use arm(*this);
  std::vector<inkwell_waypoint> points;
  for (const auto& [after_s, target_m] : path) points.push_back({after_s, {target_m[0], target_m[1], target_m[2]}});
  call([&] { return inkwell_move_virtual_hand_along(arm, points.data(), points.size()); });
}

std::string Arm::virtual_truth() {
  const Use arm(*this);
  std::size_t size = 0;
  call([&] { return inkwell_read_virtual_truth(arm, nullptr, 0, &size); });
  std::string json(size + 1024, '\0');  // the next text may be longer
  call([&] { return inkwell_read_virtual_truth(arm, json.data(), json.size(), nullptr); });
  json.resize(json.find('\0'));
  return json;
}

void Arm::press_virtual_buttons(bool button_1, bool button_2) {
  const Use arm(*this);
  call([&] { return inkwell_press_virtual_buttons(arm, button_1, button_2); });
}

}  // namespace inkwell::python
