// C++14 interface of libinkwell with RAII and exceptions.
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
#include <type_traits>
#include <utility>
#include <vector>

#include <inkwell/inkwell.h>

namespace inkwell {

using Pose = inkwell_pose;
using Plane = inkwell_plane;
using Sphere = inkwell_sphere;
using State = inkwell_arm_state;
using Abilities = inkwell_abilities;
using Solid = inkwell_solid;
using Material = inkwell_material;
using Placement = inkwell_placement;
using Object = inkwell_object;
using Contact = inkwell_contact;
using Event = inkwell_event;
using Vector = std::array<double, 3>;  ///< in the workspace axes, or one value for each joint

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

/// Returns all entries of a list function of the library.
template <class Entry>
std::vector<Entry> all_entries(inkwell_result (*list_entries)(Entry*, std::size_t, std::size_t*)) {
  std::size_t count = 0;
  require(list_entries(nullptr, 0, &count));
  std::vector<Entry> list(count);
  require(list_entries(list.data(), list.size(), &count));
  if (count < list.size()) list.resize(count);  // an entry was removed in between
  return list;
}

/// See inkwell_list_devices().
inline std::vector<inkwell_device> devices() { return all_entries(inkwell_list_devices); }

/// See inkwell_list_names().
inline std::vector<inkwell_named_arm> names() { return all_entries(inkwell_list_names); }

/// See inkwell_wait_for_devices(). Returns false, and leaves the list unchanged, after the time-out.
inline bool wait_for_devices(std::vector<inkwell_device>& known, double timeout_s) {
  std::size_t count = known.size();
  std::vector<inkwell_device> list = known;
  list.resize(count + 16);
  const inkwell_result result = inkwell_wait_for_devices(timeout_s, list.data(), list.size(), &count);
  if (result == INKWELL_TIMED_OUT) return false;
  require(result);
  list.resize(std::min(count, list.size()));
  known.swap(list);
  return true;
}

/// See inkwell_kind_of_address().
inline inkwell_address_kind kind_of_address(const std::string& address) {
  inkwell_address_kind kind = INKWELL_ON_USB;
  require(inkwell_kind_of_address(address.c_str(), &kind));
  return kind;
}

/// Cause and remedy of a fault code, such as Pose::fault.
inline std::string fault_text(int fault) { return inkwell_fault_text(fault); }
/// Name of a fault code, such as "over_speed"; empty for a code without a name.
inline std::string fault_name(int fault) {
  const char* const name = inkwell_fault_name(fault);
  return name == nullptr ? std::string() : name;
}

/// Samples of the selected signals.
struct Samples {
  std::vector<float> values;          ///< rows with one value for each selected signal
  std::vector<std::int64_t> periods;  ///< control period of each row
  std::uint64_t lost = 0;             ///< samples that were lost before the first row
};

/// Number of samples of a recording.
struct Recorded {
  std::uint64_t samples = 0, lost = 0;
};

/// Result of forward kinematics.
struct Kinematics {
  Vector position_m{};
  std::array<double, 9> jacobian{};  ///< in m/rad, row by row
};

/// See inkwell_find_material().
inline Material find_material(const std::string& name) {
  Material material{};
  require(inkwell_find_material(name.c_str(), &material));
  return material;
}

/// Codes of inkwell_number for the numbers of C++.
template <class Number>
constexpr inkwell_number number_type() {
  static_assert(std::is_floating_point<Number>::value ? sizeof(Number) <= 8
                                                      : std::is_integral<Number>::value && sizeof(Number) >= 4,
                "The library accepts float, double and integers of 32 and 64 bits.");
  return std::is_floating_point<Number>::value ? (sizeof(Number) == 4 ? INKWELL_FLOAT32 : INKWELL_FLOAT64)
         : std::is_signed<Number>::value       ? (sizeof(Number) == 4 ? INKWELL_INT32 : INKWELL_INT64)
         : sizeof(Number) == 4                 ? INKWELL_UINT32
                                               : INKWELL_UINT64;
}

/// Sphere, capsule, cylinder, box or half-space at the origin; see inkwell_shape.
inline Object make_object(inkwell_shape shape, const Vector& size_m = {}) {
  Object object{};
  object.shape = shape;
  std::copy(size_m.begin(), size_m.end(), object.size_m);
  return object;
}

/// Mesh for Arm::scene_add(). The arrays must exist until then.
template <class Number, class Index>
Object make_mesh(const std::vector<std::array<Number, 3>>& vertices_m,
                 const std::vector<std::array<Index, 3>>& triangles) {
  Object object = make_object(INKWELL_SHAPE_MESH);
  object.mesh = {vertices_m.data(), number_type<Number>(), vertices_m.size(),
                 triangles.data(),  number_type<Index>(),  triangles.size()};
  return object;
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
  /// Throws Failure with INKWELL_TIMED_OUT if no pose arrives within this time of the host's clock.
  Arm(const std::string& address, double timeout_s) : opened_(new Opened) {
    require(inkwell_open_with_timeout(address.c_str(), timeout_s, &opened_->arm));
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

  State state() const {
    State state;
    require(inkwell_get_state(get(), &state, sizeof state));
    return state;
  }
  Abilities abilities() const {
    Abilities abilities;
    require(inkwell_get_abilities(get(), &abilities, sizeof abilities));
    return abilities;
  }
  Kinematics forward_kinematics(const Vector& joint_rad) const {
    Kinematics result;
    require(inkwell_forward_kinematics(get(), joint_rad.data(), result.position_m.data(), result.jacobian.data()));
    return result;
  }
  Vector force_of_torques(const Vector& joint_rad, const Vector& torque_Nm) const {
    Vector force_N{};
    require(inkwell_force_of_torques(get(), joint_rad.data(), torque_Nm.data(), force_N.data()));
    return force_N;
  }

  void claim() { require(inkwell_claim(get())); }
  void release() { require(inkwell_release(get())); }
  void set_joint_torques(const Vector& torque_Nm) { require(inkwell_set_joint_torques(get(), torque_Nm.data())); }
  void set_thread_priority(int priority) { require(inkwell_set_thread_priority(get(), priority)); }

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
  void place_all_shapes(const std::vector<Plane>& planes, const std::vector<Solid>& solids,
                        const std::vector<double>& plane_viscosity_Ns_per_m = {}) {
    std::vector<double> viscosities = plane_viscosity_Ns_per_m;
    viscosities.resize(planes.size());
    const inkwell_shapes shapes{planes.data(), planes.size(), viscosities.data(),
                                solids.data(), solids.size(), sizeof(Solid)};
    require(inkwell_place_all_shapes(get(), &shapes, sizeof shapes));
  }

  // ---- scene ----
  /// Returns the number of the object.
  std::uint32_t scene_add(const Object& object) {
    std::uint32_t number = 0;
    require(inkwell_scene_add(get(), &object, sizeof object, &number));
    return number;
  }
  void scene_move(std::uint32_t number, const Placement& placement) {
    require(inkwell_scene_move(get(), number, &placement));
  }
  void scene_set_material(std::uint32_t number, const Material& material) {
    require(inkwell_scene_set_material(get(), number, &material));
  }
  void scene_remove(std::uint32_t number) { require(inkwell_scene_remove(get(), number)); }
  void scene_clear() { require(inkwell_scene_clear(get())); }
  std::vector<Contact> scene_contacts() const {
    std::vector<Contact> contacts(INKWELL_CONTACTS_MAXIMUM);
    std::size_t count = 0;
    require(inkwell_scene_get_contacts(get(), contacts.data(), sizeof(Contact), contacts.size(), &count));
    contacts.resize(std::min(count, contacts.size()));
    return contacts;
  }
  /// Returns at most `capacity` events. Adds the number of lost events to `lost`, which may be null.
  std::vector<Event> scene_read_events(std::size_t capacity = 1024, std::uint64_t* lost = nullptr) {
    std::vector<Event> events(capacity);
    std::size_t count = 0;
    std::uint64_t now_lost = 0;
    require(inkwell_scene_read_events(get(), events.data(), sizeof(Event), events.size(), &count, &now_lost));
    if (lost != nullptr) *lost += now_lost;
    events.resize(count);
    return events;
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
  /// Changes all parameters in one control period.
  void set_parameters(const std::vector<std::pair<std::string, double>>& changes) {
    std::vector<const char*> names;
    std::vector<double> values;
    for (const auto& change : changes) {
      names.push_back(change.first.c_str());
      values.push_back(change.second);
    }
    require(inkwell_set_parameters(get(), names.data(), values.data(), names.size()));
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
  // ---- the hand of a running virtual board ----
  void connect_virtual_hand(const std::string& control) {
    require(inkwell_connect_virtual_hand(get(), control.c_str()));
  }
  void hold_virtual_hand(const Vector& target_m, double stiffness_N_per_m, double damping_Ns_per_m) {
    require(inkwell_hold_virtual_hand(get(), target_m.data(), stiffness_N_per_m, damping_Ns_per_m));
  }
  void move_virtual_hand_along(const std::vector<inkwell_waypoint>& path) {
    require(inkwell_move_virtual_hand_along(get(), path.data(), path.size()));
  }
  std::string virtual_truth() const {
    std::size_t size = 0;
    require(inkwell_read_virtual_truth(get(), nullptr, 0, &size));
    std::string json(size + 1024, '\0');  // the next text may be longer
    require(inkwell_read_virtual_truth(get(), &json[0], json.size(), nullptr));
    json.resize(json.find('\0'));
    return json;
  }

  // ---- contents of a recording, losses, test pulses ----
  void describe_recordings(const std::string& name, const std::string& note = "") {
    require(inkwell_describe_recordings(get(), name.c_str(), note.c_str()));
  }
  void mark(const std::string& text) { require(inkwell_mark(get(), text.c_str())); }
  inkwell_losses losses() const {
    inkwell_losses losses{};
    require(inkwell_get_losses(get(), &losses));
    return losses;
  }
  void send_test_pulse(int motor, inkwell_pulse unit, double amplitude, double duration_s) {
    require(inkwell_send_test_pulse(get(), motor, unit, amplitude, duration_s));
  }

  inkwell_store store() const {
    inkwell_store store;
    require(inkwell_get_store(get(), &store));
    return store;
  }

  /// The simulated hand of an arm that was opened as "virtual".
  void move_virtual_hand(const Vector& target_m, double stiffness_N_per_m = 300.0) {
    require(inkwell_move_virtual_hand(get(), target_m.data(), stiffness_N_per_m));
  }
  void release_virtual_hand() { require(inkwell_release_virtual_hand(get())); }
  void press_virtual_buttons(bool button_1, bool button_2) {
    require(inkwell_press_virtual_buttons(get(), button_1 ? 1 : 0, button_2 ? 1 : 0));
  }

  /// Without names, it stops the stream.
  void select_signals(const std::vector<std::string>& names) {
    if (!opened_) return require(inkwell_select_signals(nullptr, nullptr, 0));
    std::vector<const char*> texts;
    for (const auto& name : names) texts.push_back(name.c_str());
    const std::lock_guard<std::mutex> lock(opened_->scope_mutex);
    require(inkwell_select_signals(get(), texts.data(), texts.size()));
    opened_->signals = names.size();
  }
  /// Returns at most `rows` samples of the signals that select_signals() has selected, or none after the time-out.
  Samples read_scope(std::size_t rows = 4096, double timeout_s = 1.0) {
    Samples samples;
    std::size_t count = 0;
    if (!opened_) require(inkwell_read_samples(nullptr, timeout_s, nullptr, nullptr, 0, &count, nullptr));
    const std::lock_guard<std::mutex> lock(opened_->scope_mutex);  // the signals do not change meanwhile
    samples.values.resize(rows * opened_->signals);
    samples.periods.resize(rows);
    require(inkwell_read_samples(get(), timeout_s, samples.values.data(), samples.periods.data(),
                                 opened_->signals > 0 ? rows : 0, &count, &samples.lost));
    samples.values.resize(count * opened_->signals);
    samples.periods.resize(count);
    return samples;
  }
  /// Records the selected signals. The extension selects HDF5 or CSV.
  void start_recording(const std::string& path) { require(inkwell_start_recording(get(), path.c_str())); }
  Recorded stop_recording() {
    Recorded recorded;
    require(inkwell_stop_recording(get(), &recorded.samples, &recorded.lost));
    return recorded;
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
    std::mutex scope_mutex;   ///< guards `signals`
    std::size_t signals = 0;  ///< number of selected signals
  };

  static int call_servo(inkwell_arm*, const inkwell_pose* pose, double force_N[3], void* user) noexcept {
    return static_cast<ServoState*>(user)->call(*pose, force_N) ? 0 : 1;
  }

  std::unique_ptr<Opened> opened_;
};

}  // namespace inkwell
