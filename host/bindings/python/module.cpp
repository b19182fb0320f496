// Native module of the Python package.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "host/bindings/python/arm.hpp"
#include "host/bindings/python/record.hpp"
#include "host/bindings/python/scene.hpp"
#include "host/bindings/python/value.hpp"

namespace inkwell::python {
namespace {

template <inkwell_force_source source>
bool feels(const inkwell_pose& pose) {
  return (pose.force_sources & source) != 0;
}

template <inkwell_limit limit>
bool is_limited(const inkwell_pose& pose) {
  return (pose.limits & limit) != 0;
}

std::string describe(const inkwell_pose& pose) {
  return py::str("<inkwell.Pose {:.3f} s, {}: probe at {:.4f} {:.4f} {:.4f} m>")
      .format(pose.time_s, py::cast(pose.state).attr("name"), pose.position_m[0], pose.position_m[1],
              pose.position_m[2]);
}

std::vector<inkwell_device> list_devices() {
  std::vector<inkwell_device> devices;
  std::size_t count = 0;
  do {  // repeats if a device was plugged in between the calls
    devices.resize(count);
    call([&] { return inkwell_list_devices(devices.data(), devices.size(), &count); });
  } while (count > devices.size());
  devices.resize(count);
  return devices;
}

/// Returns a dictionary with the address of each name. The order is that of the file.
py::dict list_names() {
  std::vector<inkwell_named_arm> names;
  std::size_t count = 0;
  do {
    names.resize(count);
    call([&] { return inkwell_list_names(names.data(), names.size(), &count); });
  } while (count > names.size());
  py::dict addresses;
  for (std::size_t i = 0; i < count; ++i) addresses[names[i].name] = names[i].address;
  return addresses;
}

/// Returns the new list, or None if the list has not changed within the time-out.
std::optional<std::vector<inkwell_device>> wait_for_devices(std::vector<inkwell_device> known, double timeout_s) {
  std::size_t count = known.size();
  known.resize(count + 16);
  try {
    call([&] { return inkwell_wait_for_devices(timeout_s, known.data(), known.size(), &count); });
  } catch (py::error_already_set& error) {
    if (!error.matches(py::module_::import("inkwell.errors").attr("TimedOut"))) throw;
    return std::nullopt;
  }
  known.resize(std::min(count, known.size()));
  return known;
}

py::list parameters() {
  py::list rows;
  for (std::size_t i = 0; i < inkwell_parameter_count(); ++i) {
    const auto& row = *inkwell_parameter_at(i);
    rows.append(py::make_tuple(row.name, row.unit, row.help, row.minimum, row.maximum, row.default_value));
  }
  return rows;
}

/// List of (code, name).
py::list faults() {
  py::list rows;
  for (int code = 0; inkwell_fault_name(code) != nullptr; ++code)
    rows.append(py::make_tuple(code, inkwell_fault_name(code)));
  return rows;
}

py::list signals() {
  py::list rows;
  for (std::size_t i = 0; i < inkwell_signal_count(); ++i) {
    const auto& row = *inkwell_signal_at(i);
    rows.append(py::make_tuple(row.name, row.unit, row.help));
  }
  return rows;
}

void define_states(py::module_& module) {
  py::enum_<inkwell_state> state(module, "State", "State of the arm.");
  reduce_to_state(state);
  state.value("STARTING", INKWELL_STARTING)
      .value("UNREFERENCED", INKWELL_UNREFERENCED, "the stylus must rest in the inkwell once")
      .value("READY", INKWELL_READY, "the pose is valid, the force is off")
      .value("ACTIVE", INKWELL_ACTIVE, "the pose is valid, the force is on")
      .value("FAULT", INKWELL_FAULT, "the force is off, and Pose.fault_text has the cause");
  py::enum_<inkwell_force_mode> force_mode(module, "ForceMode", "Effect of a program's forces on the board's walls.");
  reduce_to_state(force_mode);
  force_mode.value("BESIDE_WALLS", INKWELL_BESIDE_WALLS, "the walls of the board's box are active too")
      .value("INSTEAD_OF_WALLS", INKWELL_INSTEAD_OF_WALLS, "only the forces of programs are active");
}

void define_pose(py::module_& module) {
  using Pose = inkwell_pose;
  py::class_<Pose> pose_type(module, "Pose",
                             "Position and state of the stylus, once per millisecond. The arrays are read-only.");
  make_value(pose_type, &Pose::time_s, &Pose::sequence, &Pose::state, &Pose::fault, &Pose::limits, &Pose::position_m,
             &Pose::velocity_m_s, &Pose::rotation, &Pose::gimbal_rad, &Pose::joint_rad, &Pose::force_N,
             &Pose::force_sources, &Pose::button_1, &Pose::button_2, &Pose::in_inkwell, &Pose::supply_V);
  pose_type.def_readonly("time_s", &inkwell_pose::time_s, "board time, s")
      .def_readonly("sequence", &inkwell_pose::sequence,
                    "counts milliseconds; a gap is a missed pose. It wraps at 2**32, after 49 days")
      .def_readonly("state", &inkwell_pose::state)
      .def_readonly("fault", &inkwell_pose::fault, "one of inkwell.Fault")
      .def_property_readonly(
          "fault_text", [](const inkwell_pose& pose) { return std::string(inkwell_fault_text(pose.fault)); },
          "cause and remedy of the fault")
      .def_property_readonly("position_m", array_of(&inkwell_pose::position_m),
                             "position of the probe in the workspace axes, m; shape (3,)")
      .def_property_readonly("velocity_m_s", array_of(&inkwell_pose::velocity_m_s),
                             "velocity of the probe over the last 8 ms, m/s; shape (3,)")
      .def_property_readonly("rotation", array_of(&inkwell_pose::rotation, {3, 3}),
                             "rotation of the stylus; the columns are its x, y and z axes; shape (3, 3)")
      .def_property_readonly("gimbal_rad", array_of(&inkwell_pose::gimbal_rad), "yaw, pitch and roll, rad; shape (3,)")
      .def_property_readonly("joint_rad", array_of(&inkwell_pose::joint_rad), "joint angles, rad; shape (3,)")
      .def_property_readonly("force_N", array_of(&inkwell_pose::force_N),
                             "total force that the board requests from the motors, N; shape (3,)")
      .def_property_readonly("feels_walls", &feels<INKWELL_WALLS>, "the hand feels the walls of the board's box")
      .def_property_readonly("feels_shapes", &feels<INKWELL_SHAPES>, "the hand feels shapes that a program placed")
      .def_property_readonly("feels_program", &feels<INKWELL_PROGRAM>, "the hand feels forces of a program")
      .def_property_readonly("limited_by_force", &is_limited<INKWELL_LIMIT_FORCE>,
                             "the force is limited to force_limit_N, or is rising to it")
      .def_property_readonly("limited_by_change", &is_limited<INKWELL_LIMIT_CHANGE>,
                             "the force changes at the rate force_change_N_per_s")
      .def_property_readonly("limited_by_energy", &is_limited<INKWELL_LIMIT_ENERGY>,
                             "the energy reserve is used up; the force along the motion is scaled down")
      .def_property_readonly("limited_by_heat", &is_limited<INKWELL_LIMIT_HEAT>,
                             "a hot motor is at its reduced current limit; all motors are scaled down together")
      .def_property_readonly("limited_by_speed", &is_limited<INKWELL_LIMIT_SPEED>,
                             "the probe is close to the speed limit; the force along the motion is scaled down")
      .def_property_readonly("limited_by_motors", &is_limited<INKWELL_LIMIT_MOTORS>,
                             "a motor is missing or unknown, so no motor receives current for the force")
      .def_property_readonly("limited_by_current", &is_limited<INKWELL_LIMIT_CURRENT>,
                             "a motor is at its current limit; all motors are scaled down together")
      .def_property_readonly("button_1", flag_of(&inkwell_pose::button_1), "pressed")
      .def_property_readonly("button_2", flag_of(&inkwell_pose::button_2), "pressed")
      .def_property_readonly("in_inkwell", flag_of(&inkwell_pose::in_inkwell), "the stylus rests in the inkwell")
      .def_readonly("supply_V", &inkwell_pose::supply_V, "supply of the motors, V")
      .def("__repr__", &describe);
}

void define_arm_state(py::module_& module) {
  using State = inkwell_arm_state;
  py::class_<State> state_type(module, "ArmState", "A pose with its validity, speeds and times.");
  make_value(state_type, &State::pose, &State::is_referenced, &State::received_ns, &State::received_monotonic_ns,
             &State::quaternion, &State::angular_velocity_rad_per_s, &State::joint_speed_rad_per_s,
             &State::joint_torque_Nm);
  state_type.def_readonly("pose", &State::pose)
      .def_property_readonly("is_referenced", flag_of(&State::is_referenced),
                             "True: position, joints and rotation of the pose are valid")
      .def_readonly("received_ns", &State::received_ns,
                    "host time of the pose's arrival, ns since 1970, as in time.time_ns()")
      .def_readonly("received_monotonic_ns", &State::received_monotonic_ns, "the same as in time.monotonic_ns()")
      .def_property_readonly("quaternion", array_of(&State::quaternion),
                             "rotation of the stylus as x, y, z, w; shape (4,)")
      .def_property_readonly("angular_velocity_rad_per_s", array_of(&State::angular_velocity_rad_per_s),
                             "of the stylus in the workspace axes, over the last 8 ms, rad/s; shape (3,)")
      .def_property_readonly("joint_speed_rad_per_s", array_of(&State::joint_speed_rad_per_s),
                             "over the last 8 ms, rad/s; shape (3,)")
      .def_property_readonly("joint_torque_Nm", array_of(&State::joint_torque_Nm),
                             "that pose.force_N requires, Nm; shape (3,)")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self, {"pose", "is_referenced", "received_ns", "quaternion",
                                          "angular_velocity_rad_per_s", "joint_speed_rad_per_s", "joint_torque_Nm"});
      });
}

void define_abilities(py::module_& module) {
  using Abilities = inkwell_abilities;
  py::class_<Abilities> type(module, "Abilities", "Capabilities of an arm, from its parameters.");
  make_value(type, &Abilities::workspace_minimum_m, &Abilities::workspace_maximum_m, &Abilities::workspace_radius_m,
             &Abilities::reach_minimum_m, &Abilities::reach_maximum_m, &Abilities::joint_minimum_rad,
             &Abilities::joint_maximum_rad, &Abilities::third_joint_is_absolute, &Abilities::force_N,
             &Abilities::continuous_force_N, &Abilities::joint_torque_Nm, &Abilities::continuous_joint_torque_Nm,
             &Abilities::stiffness_N_per_m, &Abilities::damping_Ns_per_m, &Abilities::pose_rate_Hz);
  type.def_property_readonly("workspace_minimum_m", array_of(&Abilities::workspace_minimum_m),
                             "corner of the arm's box, m; shape (3,)")
      .def_property_readonly("workspace_maximum_m", array_of(&Abilities::workspace_maximum_m),
                             "corner of the arm's box, m; shape (3,)")
      .def_readonly("workspace_radius_m", &Abilities::workspace_radius_m, "of the largest sphere in the box, m")
      .def_property_readonly("reach_minimum_m", array_of(&Abilities::reach_minimum_m),
                             "range of the probe within the joint stops, m; shape (3,)")
      .def_property_readonly("reach_maximum_m", array_of(&Abilities::reach_maximum_m),
                             "range of the probe within the joint stops, m; shape (3,)")
      .def_property_readonly("joint_minimum_rad", array_of(&Abilities::joint_minimum_rad),
                             "joint stops, rad; the third is that of link 3 relative to link 2; shape (3,)")
      .def_property_readonly("joint_maximum_rad", array_of(&Abilities::joint_maximum_rad),
                             "joint stops, rad; the third is that of link 3 relative to link 2; shape (3,)")
      .def_property_readonly("third_joint_is_absolute", flag_of(&Abilities::third_joint_is_absolute),
                             "True: joint 3 is measured from the base, as on the Omni")
      .def_readonly("force_N", &Abilities::force_N, "largest force, N")
      .def_readonly("continuous_force_N", &Abilities::continuous_force_N,
                    "force that every motor tolerates continuously in every pose, N")
      .def_property_readonly("joint_torque_Nm", array_of(&Abilities::joint_torque_Nm),
                             "at the current limits of the motors, Nm; shape (3,)")
      .def_property_readonly("continuous_joint_torque_Nm", array_of(&Abilities::continuous_joint_torque_Nm),
                             "that the motors tolerate continuously, Nm; shape (3,)")
      .def_readonly("stiffness_N_per_m", &Abilities::stiffness_N_per_m,
                    "recommended maximum for forces of a program at 1000 Hz, N/m")
      .def_readonly("damping_Ns_per_m", &Abilities::damping_Ns_per_m,
                    "recommended maximum for forces of a program at 1000 Hz, Ns/m")
      .def_readonly("pose_rate_Hz", &Abilities::pose_rate_Hz, "poses per second, Hz")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(
            self,
            {"workspace_minimum_m", "workspace_maximum_m", "workspace_radius_m", "reach_minimum_m", "reach_maximum_m",
             "joint_minimum_rad", "joint_maximum_rad", "third_joint_is_absolute", "force_N", "continuous_force_N",
             "joint_torque_Nm", "continuous_joint_torque_Nm", "stiffness_N_per_m", "damping_Ns_per_m", "pose_rate_Hz"});
      });
}

void define_device_and_information(py::module_& module) {
  using Device = inkwell_device;
  py::class_<Device> device_type(module, "Device", "An arm that can be opened.");
  make_value(device_type, &Device::address, &Device::serial_number, &Device::product, &Device::is_virtual);
  device_type.def_property_readonly("address", text_of(&inkwell_device::address), "for inkwell.open()")
      .def_property_readonly("serial_number", text_of(&inkwell_device::serial_number),
                             "empty if it is not known before the device is opened")
      .def_property_readonly("product", text_of(&inkwell_device::product))
      .def_property_readonly("is_virtual", flag_of(&inkwell_device::is_virtual), "True for a simulation")
      .def("__repr__", [](const inkwell_device& device) {
        return std::string(
            py::str("<inkwell.Device {!r}{}>").format(device.address, device.is_virtual != 0 ? ", a simulation" : ""));
      });

  using Information = inkwell_information;
  py::class_<Information> information_type(module, "Information", "Identity and counters of an arm.");
  make_value(information_type, &Information::serial_number, &Information::product, &Information::firmware_version,
             &Information::is_virtual, &Information::servo_rate_Hz, &Information::servo_cycles_longest,
             &Information::force_reports, &Information::force_reports_lost, &Information::force_reports_late,
             &Information::force_reports_refused, &Information::motor_heat);
  information_type.def_property_readonly("serial_number", text_of(&Information::serial_number))
      .def_property_readonly("product", text_of(&Information::product))
      .def_property_readonly("firmware_version", text_of(&Information::firmware_version))
      .def_property_readonly("is_virtual", flag_of(&Information::is_virtual), "True for a simulation")
      .def_readonly("servo_rate_Hz", &Information::servo_rate_Hz, "rate of the board's control interrupt, Hz")
      .def_readonly("servo_cycles_longest", &Information::servo_cycles_longest,
                    "longest control interrupt since the board started, processor cycles")
      .def_readonly("force_reports", &Information::force_reports, "forces of programs since the board started")
      .def_readonly("force_reports_lost", &Information::force_reports_lost)
      .def_readonly("force_reports_late", &Information::force_reports_late)
      .def_readonly("force_reports_refused", &Information::force_reports_refused)
      .def_property_readonly("motor_heat", array_of(&Information::motor_heat),
                             "1 is the heat at continuous current; shape (3,)")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self, {"product", "serial_number", "firmware_version", "is_virtual", "servo_rate_Hz",
                                          "servo_cycles_longest", "force_reports", "force_reports_lost",
                                          "force_reports_late", "force_reports_refused", "motor_heat"});
      });
}

void define_store(py::module_& module) {
  py::enum_<inkwell_stored> stored(module, "Stored", "Contents of the board's parameter store.");
  reduce_to_state(stored);
  stored.value("NOTHING", INKWELL_STORED_NOTHING)
      .value("PARAMETERS", INKWELL_STORED_PARAMETERS)
      .value("FACTORY_RESET", INKWELL_STORED_FACTORY_RESET, "the stored parameters were erased")
      .value("OTHER_SCHEMA", INKWELL_STORED_OTHER_SCHEMA,
             "records of another firmware, which this firmware cannot read");
  using Store = inkwell_store;
  py::class_<Store> store_type(module, "Store", "State of the board's parameter store.");
  make_value(store_type, &Store::contents, &Store::not_stored, &Store::stores_left, &Store::records_written,
             &Store::sector_erases);
  store_type.def_readonly("contents", &inkwell_store::contents)
      .def_readonly("not_stored", &inkwell_store::not_stored, "parameters that are lost at power loss")
      .def_readonly("stores_left", &inkwell_store::stores_left,
                    "stores that fit before the board's next start, which frees space")
      .def_readonly("records_written", &inkwell_store::records_written, "records since the board was made")
      .def_property_readonly(
          "sector_erases",
          [](const inkwell_store& store) { return py::make_tuple(store.sector_erases[0], store.sector_erases[1]); },
          "erases of each of the two sectors since the board was made")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self, {"contents", "not_stored", "stores_left", "records_written", "sector_erases"});
      });
}

void define_self_test(py::module_& module) {
  py::enum_<inkwell_test> test(module, "Test", "Result of a self-test item.");
  reduce_to_state(test);
  test.value("NOT_DONE", INKWELL_TEST_NOT_DONE, "not checked, or not checkable while another item fails")
      .value("PASSED", INKWELL_TEST_PASSED)
      .value("FAILED", INKWELL_TEST_FAILED)
      .value("MOVED", INKWELL_TEST_MOVED, "not done: the arm moved too fast")
      .value("NO_PART", INKWELL_TEST_NO_PART, "not done: a motor with a current limit of 0 is not used")
      .value("BROKEN_OFF", INKWELL_TEST_BROKEN_OFF, "not done: no supply, or another fault interrupted the test")
      .value("MISSING", INKWELL_TEST_MISSING, "a motor that is not connected")
      .value("UNKNOWN_MOTOR", INKWELL_TEST_UNKNOWN_MOTOR, "a motor of another resistance")
      .value("WRONG_SIGN", INKWELL_TEST_WRONG_SIGN, "a failure: the current has the wrong sign");
  using Item = inkwell_test_item;
  py::class_<Item> item_type(module, "TestItem", "An item of the board's self-test.");
  make_value(item_type, &Item::name, &Item::meaning, &Item::remedy, &Item::unit, &Item::figure, &Item::result,
             &Item::takes_force);
  item_type.def_readonly("name", &inkwell_test_item::name)
      .def_readonly("result", &inkwell_test_item::result)
      .def_readonly("figure", &inkwell_test_item::figure, "0 if the item has no figure, or was not checked")
      .def_readonly("unit", &inkwell_test_item::unit, "unit of the figure; empty if the item has no figure")
      .def_property_readonly("takes_force", [](const inkwell_test_item& item) { return item.takes_force != 0; })
      .def_readonly("meaning", &inkwell_test_item::meaning, "condition that the test checks")
      .def_readonly("remedy", &inkwell_test_item::remedy, "what to do if the item fails")
      .def("__repr__", [](const inkwell_test_item& item) {
        return std::string("<TestItem ") + item.name + ": " + py::str(py::cast(item.result)).cast<std::string>() + ">";
      });
}

void define_driver(py::module_& module) {
  using Driver = inkwell_driver;
  py::class_<Driver> driver_type(module, "Driver", "The program that drives an arm.");
  make_value(driver_type, &Driver::is_driven, &Driver::is_this_arm, &Driver::program, &Driver::process_id,
             &Driver::driven_s);
  driver_type.def_property_readonly("is_driven", flag_of(&Driver::is_driven), "False: no program drives the arm")
      .def_property_readonly("is_this_arm", flag_of(&Driver::is_this_arm),
                             "True: the arm is driven through this object")
      .def_property_readonly("program", text_of(&Driver::program), "name of the program")
      .def_readonly("process_id", &Driver::process_id, "process number on the driver's computer")
      .def_readonly("driven_s", &Driver::driven_s, "board time since it claimed the arm, s")
      .def("__repr__", [](const Driver& driver) {
        return driver.is_driven != 0
                   ? "<Driver " + std::string(driver.program) + " (process " + std::to_string(driver.process_id) + ")>"
                   : std::string("<Driver none>");
      });
}

void define_losses(py::module_& module) {
  using Losses = inkwell_losses;
  py::class_<Losses> losses_type(module, "Losses", "Losses since the arm was opened.");
  make_value(losses_type, &Losses::poses, &Losses::poses_missed_by_servo, &Losses::slow_servo_calls,
             &Losses::longest_servo_call_s);
  losses_type.def_readonly("poses", &Losses::poses, "poses that the board has sent and the library has not received")
      .def_readonly("poses_missed_by_servo", &Losses::poses_missed_by_servo,
                    "poses that arrived while the servo was still being called")
      .def_readonly("slow_servo_calls", &Losses::slow_servo_calls,
                    "calls of the servo that took longer than 1 ms on the PC's clock")
      .def_readonly("longest_servo_call_s", &Losses::longest_servo_call_s, "longest call of the servo, s")
      .def("__repr__", [](const py::object& self) {
        return describe_attributes(self,
                                   {"poses", "poses_missed_by_servo", "slow_servo_calls", "longest_servo_call_s"});
      });
}

void define_arm(py::module_& module) {
  py::class_<Arm>(module, "Arm")
      .def(py::init<const std::string&, std::optional<double>>(), py::arg("address"), py::arg("timeout_s") = py::none())
      .def("close", &Arm::close)
      .def("is_closed", &Arm::is_closed)
      .def("pose", &Arm::pose)
      .def("wait_for_pose", &Arm::wait_for_pose)
      .def("sleep", &Arm::sleep)
      .def("is_referenced", &Arm::is_referenced)
      .def("information", &Arm::information)
      .def("board_name", &Arm::board_name)
      .def("state", &Arm::state)
      .def("abilities", &Arm::abilities)
      .def("forward_kinematics", &Arm::forward_kinematics)
      .def("force_of_torques", &Arm::force_of_torques)
      .def("set_joint_torques", &Arm::set_joint_torques)
      .def("claim", &Arm::claim)
      .def("release", &Arm::release)
      .def("set_thread_priority", &Arm::set_thread_priority)
      .def("enable_force", &Arm::enable_force)
      .def("disable_force", &Arm::disable_force)
      .def("stop", &Arm::stop)
      .def("take_over", &Arm::take_over)
      .def("driver", &Arm::driver)
      .def("clear_fault", &Arm::clear_fault)
      .def("set_force_mode", &Arm::set_force_mode)
      .def("set_force", &Arm::set_force)
      .def("place_shapes", &place_shapes)
      .def("scene_add", &scene_add)
      .def("scene_move", &scene_move)
      .def("scene_set_material", &scene_set_material)
      .def("scene_remove", &scene_remove)
      .def("scene_clear", &scene_clear)
      .def("scene_contacts", &scene_contacts)
      .def("scene_events", &scene_events)
      .def("start_servo", &Arm::start_servo)
      .def("stop_servo", &Arm::stop_servo)
      .def("servo_is_running", &Arm::servo_is_running)
      .def("check_servo", &Arm::check_servo)
      .def("parameter", &Arm::parameter)
      .def("set_parameters", &Arm::set_parameters)
      .def("stored_parameter", &Arm::stored_parameter)
      .def("store_parameters", &Arm::store_parameters)
      .def("restore_parameters", &Arm::restore_parameters)
      .def("factory_reset", &Arm::factory_reset)
      .def("store", &Arm::store)
      .def("self_test", &Arm::self_test)
      .def("last_self_test", &Arm::last_self_test)
      .def("move_virtual_hand", &Arm::move_virtual_hand)
      .def("release_virtual_hand", &Arm::release_virtual_hand)
      .def("press_virtual_buttons", &Arm::press_virtual_buttons)
      .def("connect_virtual_hand", &Arm::connect_virtual_hand)
      .def("hold_virtual_hand", &Arm::hold_virtual_hand)
      .def("move_virtual_hand_along", &Arm::move_virtual_hand_along)
      .def("virtual_truth", &Arm::virtual_truth)
      .def("select_signals", &Arm::select_signals)
      .def("read_scope", &Arm::read_scope)
      .def("start_recording", &Arm::start_recording)
      .def("finish_recording", &Arm::finish_recording)
      .def("describe_recordings", &Arm::describe_recordings)
      .def("mark", &Arm::mark)
      .def("losses", &Arm::losses)
      .def("send_test_pulse", &Arm::send_test_pulse);
}

}  // namespace
}  // namespace inkwell::python

PYBIND11_MODULE(_native, module) {
  module.doc() = "Bindings of libinkwell for the Python files of the package.";
  inkwell::python::define_states(module);
  inkwell::python::define_pose(module);
  inkwell::python::define_arm_state(module);
  inkwell::python::define_abilities(module);
  inkwell::python::define_device_and_information(module);
  inkwell::python::define_store(module);
  inkwell::python::define_self_test(module);
  inkwell::python::define_driver(module);
  inkwell::python::define_losses(module);
  inkwell::python::define_scene(module);
  inkwell::python::define_arm(module);
  module.def("version", &inkwell_version);
  module.def("devices", &inkwell::python::list_devices,
             "Lists the arms on this computer's USB, and the virtual board that INKWELL_DEVICE names.");
  module.def("names", &inkwell::python::list_names,
             "Returns the names of arms, such as \"left\", with their addresses. `inkwell arms bind` adds names.");
  module.def("wait_for_devices", &inkwell::python::wait_for_devices);
  module.def("faults", &inkwell::python::faults);
  module.def("parameters", &inkwell::python::parameters);
  module.def("signals", &inkwell::python::signals);
}
