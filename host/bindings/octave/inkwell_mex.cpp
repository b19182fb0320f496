// MEX interface of libinkwell for Octave and MATLAB. The .m files in this folder call inkwell_mex(COMMAND, ...).
//
// Build commands:
//   mkoctfile --mex inkwell_mex.cpp -Ihost/bindings/library/include -Lbuild/pc -linkwell     Octave
//   mex inkwell_mex.cpp -Ihost/bindings/library/include -Lbuild/pc -linkwell                 MATLAB
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <mex.h>
#include <inkwell/inkwell.hpp>

namespace {

using inkwell::require;
using Arguments = std::vector<const mxArray*>;

std::map<int, inkwell_arm*> arms;  ///< open arms by their number in the interpreter
int newest = 0;

struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const mxArray* argument(const Arguments& arguments, std::size_t index) {
  if (index >= arguments.size()) throw Wrong("An argument is missing. Read the help of the function.");
  return arguments[index];
}

std::string text(const mxArray* value) {
  char* characters = mxIsChar(value) ? mxArrayToString(value) : nullptr;
  if (characters == nullptr) throw Wrong("An argument is not a name. Give the name as text, 'like this'.");
  const std::string copy = characters;
  mxFree(characters);
  return copy;
}

std::vector<std::string> texts(const mxArray* value) {
  if (!mxIsCell(value)) return {text(value)};
  std::vector<std::string> all;
  for (std::size_t i = 0; i < mxGetNumberOfElements(value); ++i) {
    const mxArray* cell = mxGetCell(value, static_cast<mwIndex>(i));
    if (cell == nullptr) throw Wrong("An entry of the name list is not a name. Give all names as text.");
    all.push_back(text(cell));
  }
  return all;
}

std::vector<const char*> pointers(const std::vector<std::string>& names) {
  std::vector<const char*> pointers;
  for (const auto& name : names) pointers.push_back(name.c_str());
  return pointers;
}

/// Returns the values of a numeric or logical array. Text is refused: it would be converted to character codes.
std::vector<double> numbers(const mxArray* value) {
  if (!(mxIsNumeric(value) || mxIsLogical(value)) || mxIsComplex(value))
    throw Wrong("An argument is not a number. Give a number.");
  const bool is_plain = mxIsDouble(value) && !mxIsSparse(value);
  mxArray* converted = const_cast<mxArray*>(value);
  if (!is_plain) {
    mxArray* real = nullptr;
    mexCallMATLAB(1, &real, 1, &converted, "double");
    mexCallMATLAB(1, &converted, 1, &real, "full");
    mxDestroyArray(real);
  }
  const double* first = mxGetPr(converted);
  const std::vector<double> copy(first, first + mxGetNumberOfElements(converted));
  if (!is_plain) mxDestroyArray(converted);
  return copy;
}

double number(const mxArray* value) {
  const auto values = numbers(value);
  if (values.size() != 1) throw Wrong("An argument is not a number. Give a number.");
  return values[0];
}

inkwell::Vector vector(const mxArray* value) {
  if (mxIsChar(value)) throw Wrong("An argument is text. Three numbers are required, [x y z].");
  const auto values = numbers(value);
  if (values.size() != 3) throw Wrong("An argument is not a vector. Three numbers are required, [x y z].");
  return {values[0], values[1], values[2]};
}

std::map<int, inkwell_arm*>::iterator find(const Arguments& arguments) {
  const double wanted = number(argument(arguments, 0));
  const auto found = wanted >= 1 && wanted <= newest ? arms.find(static_cast<int>(wanted)) : arms.end();
  if (found == arms.end() || found->first != wanted) throw Wrong("This arm is not open. Open one with inkwell_open.");
  return found;
}

void close_all() {
  for (const auto& [_, arm] : arms) inkwell_close(arm);
  arms.clear();
}

mxArray* column(const double* values, std::size_t count) {
  mxArray* array = mxCreateDoubleMatrix(static_cast<mwSize>(count), 1, mxREAL);
  for (std::size_t i = 0; i < count; ++i) mxGetPr(array)[i] = values[i];
  return array;
}

// ---- commands ------------------------------------------------------------------------------------------------

using Answers = std::vector<mxArray*>;

Answers open(const Arguments& arguments) {
  const std::string address = arguments.empty() ? std::string() : text(arguments[0]);
  inkwell_arm* arm = nullptr;
  require(arguments.size() > 1 ? inkwell_open_with_timeout(address.c_str(), number(arguments[1]), &arm)
                               : inkwell_open(address.c_str(), &arm));
  arms[++newest] = arm;
  return {mxCreateDoubleScalar(newest)};
}

Answers close(const Arguments& arguments) {
  const auto found = find(arguments);
  inkwell_close(found->second);
  arms.erase(found);
  return {};
}

Answers information(const Arguments& arguments) {
  inkwell_information device_information;
  char board[INKWELL_BOARD_NAME_SIZE];
  require(inkwell_get_information(find(arguments)->second, &device_information));
  require(inkwell_get_board_name(find(arguments)->second, board));
  const char* names[] = {"product", "serial_number", "board", "firmware_version", "is_virtual"};
  mxArray* values[] = {mxCreateString(device_information.product), mxCreateString(device_information.serial_number),
                       mxCreateString(board), mxCreateString(device_information.firmware_version),
                       mxCreateLogicalScalar(device_information.is_virtual != 0)};
  mxArray* all = mxCreateStructMatrix(1, 1, static_cast<int>(std::size(names)), names);
  for (std::size_t i = 0; i < std::size(names); ++i) mxSetField(all, 0, names[i], values[i]);
  return {all};
}

mxArray* struct_of(const inkwell_pose& pose, bool is_referenced) {
  static const char* const states[] = {"starting", "unreferenced", "ready", "active", "fault"};
  const char* names[] = {"time_s",
                         "state",
                         "fault_text",
                         "is_referenced",
                         "position_m",
                         "velocity_m_s",
                         "rotation",
                         "gimbal_rad",
                         "joint_rad",
                         "force_N",
                         "limited_by_force",
                         "limited_by_current",
                         "limited_by_change",
                         "limited_by_energy",
                         "limited_by_heat",
                         "limited_by_speed",
                         "limited_by_motors",
                         "button_1",
                         "button_2",
                         "in_inkwell"};
  mxArray* structure = mxCreateStructMatrix(1, 1, static_cast<int>(std::size(names)), names);
  mxArray* rotation = mxCreateDoubleMatrix(3, 3, mxREAL);
  for (int row = 0; row < 3; ++row)
    for (int each = 0; each < 3; ++each) mxGetPr(rotation)[3 * each + row] = pose.rotation[3 * row + each];
  mxArray* values[] = {mxCreateDoubleScalar(pose.time_s),
                       mxCreateString(pose.state >= 0 && pose.state < 5 ? states[pose.state] : "unknown"),
                       mxCreateString(inkwell_fault_text(pose.fault)),
                       mxCreateLogicalScalar(is_referenced),
                       column(pose.position_m, 3),
                       column(pose.velocity_m_s, 3),
                       rotation,
                       column(pose.gimbal_rad, 3),
                       column(pose.joint_rad, 3),
                       column(pose.force_N, 3),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_FORCE) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_CURRENT) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_CHANGE) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_ENERGY) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_HEAT) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_SPEED) != 0),
                       mxCreateLogicalScalar((pose.limits & INKWELL_LIMIT_MOTORS) != 0),
                       mxCreateLogicalScalar(pose.button_1 != 0),
                       mxCreateLogicalScalar(pose.button_2 != 0),
                       mxCreateLogicalScalar(pose.in_inkwell != 0)};
  for (std::size_t i = 0; i < std::size(names); ++i) mxSetField(structure, 0, names[i], values[i]);
  return structure;
}

Answers pose(const Arguments& arguments) {
  inkwell_pose pose;
  // The encoders were referenced during the pose if they were referenced before and after the pose.
  int was_referenced, is_referenced;
  require(inkwell_is_referenced(find(arguments)->second, &was_referenced));
  require(inkwell_wait_for_pose(find(arguments)->second, 10.0, &pose));
  require(inkwell_is_referenced(find(arguments)->second, &is_referenced));
  return {struct_of(pose, was_referenced != 0 && is_referenced != 0)};
}

/// Returns the last pose without an error if no poses arrive.
Answers last_pose(const Arguments& arguments) {
  inkwell_arm_state last{};
  inkwell_get_state(find(arguments)->second, &last, sizeof last);
  return {struct_of(last.pose, last.is_referenced != 0)};
}

// ---- states, abilities, joint torques, claims, list of arms ----

mxArray* struct_of(const std::vector<std::pair<const char*, mxArray*>>& fields) {
  std::vector<const char*> names;
  for (const auto& field : fields) names.push_back(field.first);
  mxArray* structure = mxCreateStructMatrix(1, 1, static_cast<int>(names.size()), names.data());
  for (const auto& [name, value] : fields) mxSetField(structure, 0, name, value);
  return structure;
}

Answers state(const Arguments& arguments) {
  inkwell_arm_state state;
  require(inkwell_get_state(find(arguments)->second, &state, sizeof state));
  return {struct_of({{"pose", struct_of(state.pose, state.is_referenced != 0)},
                     {"received_s", mxCreateDoubleScalar(1e-9 * static_cast<double>(state.received_ns))},
                     {"quaternion", column(state.quaternion, 4)},
                     {"angular_velocity_rad_per_s", column(state.angular_velocity_rad_per_s, 3)},
                     {"joint_speed_rad_per_s", column(state.joint_speed_rad_per_s, 3)},
                     {"joint_torque_Nm", column(state.joint_torque_Nm, 3)}})};
}

Answers abilities(const Arguments& arguments) {
  inkwell_abilities abilities;
  require(inkwell_get_abilities(find(arguments)->second, &abilities, sizeof abilities));
  return {struct_of({{"workspace_minimum_m", column(abilities.workspace_minimum_m, 3)},
                     {"workspace_maximum_m", column(abilities.workspace_maximum_m, 3)},
                     {"workspace_radius_m", mxCreateDoubleScalar(abilities.workspace_radius_m)},
                     {"reach_minimum_m", column(abilities.reach_minimum_m, 3)},
                     {"reach_maximum_m", column(abilities.reach_maximum_m, 3)},
                     {"joint_minimum_rad", column(abilities.joint_minimum_rad, 3)},
                     {"joint_maximum_rad", column(abilities.joint_maximum_rad, 3)},
                     {"third_joint_is_absolute", mxCreateLogicalScalar(abilities.third_joint_is_absolute != 0)},
                     {"force_N", mxCreateDoubleScalar(abilities.force_N)},
                     {"continuous_force_N", mxCreateDoubleScalar(abilities.continuous_force_N)},
                     {"joint_torque_Nm", column(abilities.joint_torque_Nm, 3)},
                     {"continuous_joint_torque_Nm", column(abilities.continuous_joint_torque_Nm, 3)},
                     {"stiffness_N_per_m", mxCreateDoubleScalar(abilities.stiffness_N_per_m)},
                     {"damping_Ns_per_m", mxCreateDoubleScalar(abilities.damping_Ns_per_m)},
                     {"pose_rate_Hz", mxCreateDoubleScalar(abilities.pose_rate_Hz)}})};
}

Answers kinematics(const Arguments& arguments) {
  double position_m[3], jacobian[9];
  require(
      inkwell_forward_kinematics(find(arguments)->second, vector(argument(arguments, 1)).data(), position_m, jacobian));
  mxArray* matrix = mxCreateDoubleMatrix(3, 3, mxREAL);
  for (int row = 0; row < 3; ++row)
    for (int each = 0; each < 3; ++each) mxGetPr(matrix)[3 * each + row] = jacobian[3 * row + each];
  return {column(position_m, 3), matrix};
}

/// With two vectors, returns the force of these joint angles and torques. With one vector, sets the joint torques.
Answers joint_torques(const Arguments& arguments) {
  inkwell_arm* const arm = find(arguments)->second;
  const auto first = vector(argument(arguments, 1));
  if (arguments.size() < 3) {
    require(inkwell_set_joint_torques(arm, first.data()));
    return {};
  }
  double force_N[3];
  require(inkwell_force_of_torques(arm, first.data(), vector(arguments[2]).data(), force_N));
  return {column(force_N, 3)};
}

Answers claim(const Arguments& arguments) {
  const bool on = number(argument(arguments, 1)) != 0.0;
  require(on ? inkwell_claim(find(arguments)->second) : inkwell_release(find(arguments)->second));
  return {};
}

Answers priority(const Arguments& arguments) {
  require(inkwell_set_thread_priority(find(arguments)->second, static_cast<int>(number(argument(arguments, 1)))));
  return {};
}

/// Returns a structure array with the name and the address of each named arm.
Answers arm_names(const Arguments&) {
  const auto names = inkwell::names();
  const char* fields[] = {"name", "address"};
  mxArray* table =
      mxCreateStructMatrix(static_cast<mwSize>(names.size()), 1, static_cast<int>(std::size(fields)), fields);
  for (std::size_t i = 0; i < names.size(); ++i) {
    mxSetField(table, static_cast<mwIndex>(i), fields[0], mxCreateString(names[i].name));
    mxSetField(table, static_cast<mwIndex>(i), fields[1], mxCreateString(names[i].address));
  }
  return {table};
}

mxArray* cell_of(const std::vector<inkwell_device>& devices) {
  mxArray* cell = mxCreateCellMatrix(static_cast<mwSize>(devices.size()), 1);
  for (std::size_t i = 0; i < devices.size(); ++i)
    mxSetCell(cell, static_cast<mwIndex>(i), mxCreateString(devices[i].address));
  return cell;
}

/// Returns the addresses of all arms. With a time, waits until this list changes.
Answers devices(const Arguments& arguments) {
  auto known = inkwell::devices();
  if (!arguments.empty() && !inkwell::wait_for_devices(known, number(arguments[0])))
    throw inkwell::Failure(INKWELL_TIMED_OUT);
  return {cell_of(known)};
}

Answers version(const Arguments&) { return {mxCreateString(inkwell_version())}; }

Answers sleep(const Arguments& arguments) {
  require(inkwell_sleep(find(arguments)->second, number(argument(arguments, 1))));
  return {};
}

Answers enable(const Arguments& arguments) {
  const bool on = number(argument(arguments, 1)) != 0.0;
  inkwell_arm* arm = find(arguments)->second;
  require(on ? inkwell_enable_force(arm, 5.0) : inkwell_disable_force(arm));
  return {};
}

Answers stop(const Arguments& arguments) {
  require(inkwell_stop(find(arguments)->second));
  return {};
}

Answers take_over(const Arguments& arguments) {
  require(inkwell_take_over(find(arguments)->second));
  return {};
}

Answers driver(const Arguments& arguments) {
  inkwell_driver driver;
  require(inkwell_get_driver(find(arguments)->second, &driver));
  const char* names[] = {"is_driven", "is_this_arm", "program", "process_id", "driven_s"};
  mxArray* answer = mxCreateStructMatrix(1, 1, static_cast<int>(std::size(names)), names);
  mxSetField(answer, 0, names[0], mxCreateLogicalScalar(driver.is_driven != 0));
  mxSetField(answer, 0, names[1], mxCreateLogicalScalar(driver.is_this_arm != 0));
  mxSetField(answer, 0, names[2], mxCreateString(driver.program));
  mxSetField(answer, 0, names[3], mxCreateDoubleScalar(driver.process_id));
  mxSetField(answer, 0, names[4], mxCreateDoubleScalar(driver.driven_s));
  return {answer};
}

Answers clear_fault(const Arguments& arguments) {
  require(inkwell_clear_fault(find(arguments)->second));
  return {};
}

Answers force(const Arguments& arguments) {
  require(inkwell_set_force(find(arguments)->second, vector(argument(arguments, 1)).data()));
  return {};
}

// ---- scene ----

/// Material from a name, or from a structure with its properties.
inkwell::Material material_of(const mxArray* value) {
  if (mxIsChar(value)) return inkwell::find_material(text(value));
  if (!mxIsStruct(value)) throw Wrong("A material is not valid. Give the name of a material, or a structure.");
  inkwell::Material material{};
  const std::pair<const char*, double*> fields[] = {{"stiffness_N_per_m", &material.stiffness_N_per_m},
                                                    {"damping_Ns_per_m", &material.damping_Ns_per_m},
                                                    {"static_friction", &material.static_friction},
                                                    {"dynamic_friction", &material.dynamic_friction},
                                                    {"viscosity_Ns_per_m", &material.viscosity_Ns_per_m}};
  for (int i = 0; i < mxGetNumberOfFields(value); ++i) {
    const std::string name = mxGetFieldNameByNumber(value, i);
    double* property = nullptr;
    for (const auto& field : fields)
      if (name == field.first) property = field.second;
    if (property == nullptr) throw Wrong("A material has no property " + name + ". Read help inkwell_scene_add.");
    *property = number(mxGetFieldByNumber(value, 0, i));
  }
  return material;
}

void put(const mxArray* value, std::size_t count, const char* what, double* to) {
  const auto values = numbers(value);
  if (values.size() != count)
    throw Wrong(std::string("The ") + what + " is not valid. Give " + std::to_string(count) + " numbers.");
  std::copy(values.begin(), values.end(), to);
}

/// Position, quaternion, velocity and angular velocity from the arguments from `first` on. Missing ones are 0.
inkwell::Placement placement_of(const Arguments& arguments, std::size_t first) {
  inkwell::Placement placement{};
  struct Part {
    const char* name;
    std::size_t count;
    double* to;
  };
  const Part parts[] = {{"position", 3, placement.position_m},
                        {"quaternion", 4, placement.quaternion},
                        {"velocity", 3, placement.velocity_m_per_s},
                        {"angular velocity", 3, placement.angular_velocity_rad_per_s}};
  for (std::size_t i = 0; i < std::size(parts) && first + i < arguments.size(); ++i)
    if (!mxIsEmpty(arguments[first + i])) put(arguments[first + i], parts[i].count, parts[i].name, parts[i].to);
  return placement;
}

/// Rows of a matrix with three columns.
template <class Number>
std::vector<std::array<Number, 3>> rows_of_three(const mxArray* value, const char* what, double offset) {
  const auto values = numbers(value);  // column by column
  if (mxGetN(value) != 3) throw Wrong(std::string("The ") + what + " are not valid. Give a matrix with three columns.");
  const std::size_t count = values.size() / 3;
  std::vector<std::array<Number, 3>> rows(count);
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t i = 0; i < 3; ++i) {
      const double entry = values[i * count + row] + offset;
      if (std::is_integral<Number>::value && !(entry >= 0 && entry < 4e9 && entry == std::floor(entry)))
        throw Wrong(std::string("An entry of the ") + what + " is not the row of a vertex. Count the rows from 1.");
      rows[row][i] = static_cast<Number>(entry);
    }
  return rows;
}

/// Arm, shape or vertices, sizes or faces, material or [], placement.
Answers scene_add(const Arguments& arguments) {
  inkwell_arm* const arm = find(arguments)->second;
  std::vector<std::array<double, 3>> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  inkwell::Object object{};
  if (mxIsChar(argument(arguments, 1))) {
    static const std::pair<const char*, std::size_t> shapes[] = {{"sphere", 1}, {"capsule", 2}, {"cylinder", 2},
                                                                 {"box", 3},    {"", 0},        {"half-space", 0}};
    const std::string name = text(arguments[1]);
    std::size_t shape = 0;
    while (shape < std::size(shapes) && (name != shapes[shape].first || name.empty())) ++shape;
    if (shape == std::size(shapes))
      throw Wrong("The shape " + name + " does not exist. Give sphere, capsule, cylinder, box or half-space.");
    object.shape = static_cast<inkwell_shape>(shape);
    put(argument(arguments, 2), shapes[shape].second, "size", object.size_m);
  } else {
    vertices_m = rows_of_three<double>(arguments[1], "vertices", 0);
    faces = rows_of_three<std::uint32_t>(argument(arguments, 2), "faces", -1);
    object = inkwell::make_mesh(vertices_m, faces);
  }
  if (!mxIsEmpty(argument(arguments, 3))) object.material = material_of(arguments[3]);
  object.placement = placement_of(arguments, 4);
  std::uint32_t number_of_object = 0;
  require(inkwell_scene_add(arm, &object, sizeof object, &number_of_object));
  return {mxCreateDoubleScalar(number_of_object)};
}

std::uint32_t object_of(const Arguments& arguments) {
  const double wanted = number(argument(arguments, 1));
  return wanted >= 0 && wanted < 4e9 ? static_cast<std::uint32_t>(wanted) : 0;
}

Answers scene_move(const Arguments& arguments) {
  const auto placement = placement_of(arguments, 2);
  require(inkwell_scene_move(find(arguments)->second, object_of(arguments), &placement));
  return {};
}

Answers scene_material(const Arguments& arguments) {
  const auto material = material_of(argument(arguments, 2));
  require(inkwell_scene_set_material(find(arguments)->second, object_of(arguments), &material));
  return {};
}

/// Without an object, removes all objects.
Answers scene_remove(const Arguments& arguments) {
  inkwell_arm* const arm = find(arguments)->second;
  require(arguments.size() > 1 ? inkwell_scene_remove(arm, object_of(arguments)) : inkwell_scene_clear(arm));
  return {};
}

std::vector<std::pair<const char*, mxArray*>> fields_of(const inkwell_contact& contact) {
  return {{"object", mxCreateDoubleScalar(contact.object)},
          {"triangle", mxCreateDoubleScalar(contact.triangle + 1.0)},
          {"point_m", column(contact.point_m, 3)},
          {"normal", column(contact.normal, 3)},
          {"depth_m", mxCreateDoubleScalar(contact.depth_m)},
          {"time_s", mxCreateDoubleScalar(contact.time_s)}};
}

/// Structure array with these fields and the rows of the result of `fields_of_row`.
template <class Rows, class Fields>
mxArray* table_of(std::vector<const char*> names, const Rows& rows, Fields fields_of_row) {
  mxArray* table =
      mxCreateStructMatrix(static_cast<mwSize>(rows.size()), 1, static_cast<int>(names.size()), names.data());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& [name, value] : fields_of_row(rows[i])) mxSetField(table, static_cast<mwIndex>(i), name, value);
  return table;
}

Answers scene_contacts(const Arguments& arguments) {
  std::vector<inkwell_contact> contacts(INKWELL_CONTACTS_MAXIMUM);
  std::size_t count = 0;
  require(inkwell_scene_get_contacts(find(arguments)->second, contacts.data(), sizeof(inkwell_contact), contacts.size(),
                                     &count));
  contacts.resize(std::min(count, contacts.size()));
  return {table_of({"object", "triangle", "point_m", "normal", "depth_m", "time_s"}, contacts, fields_of)};
}

Answers scene_events(const Arguments& arguments) {
  std::vector<inkwell_event> events(1024);
  std::size_t count = 0;
  std::uint64_t lost = 0;
  require(inkwell_scene_read_events(find(arguments)->second, events.data(), sizeof(inkwell_event), events.size(),
                                    &count, &lost));
  events.resize(count);
  static const char* const kinds[] = {"touched", "left", "pressed", "released"};
  const auto fields = [](const inkwell_event& event) {
    return std::vector<std::pair<const char*, mxArray*>>{
        {"kind", mxCreateString(event.kind >= 0 && event.kind < 4 ? kinds[event.kind] : "unknown")},
        {"button", mxCreateDoubleScalar(event.button)},
        {"time_s", mxCreateDoubleScalar(event.time_s)},
        {"contact", struct_of(fields_of(event.contact))}};
  };
  return {table_of({"kind", "button", "time_s", "contact"}, events, fields),
          mxCreateDoubleScalar(static_cast<double>(lost))};
}

Answers get(const Arguments& arguments) {
  double value = 0;
  require(inkwell_get_parameter(find(arguments)->second, text(argument(arguments, 1)).c_str(), &value));
  return {mxCreateDoubleScalar(value)};
}

Answers set(const Arguments& arguments) {
  const auto names = texts(argument(arguments, 1));
  const auto values = numbers(argument(arguments, 2));
  if (values.size() != names.size())
    throw Wrong("The numbers of names and values differ. Give as many values as names.");
  require(inkwell_set_parameters(find(arguments)->second, pointers(names).data(), values.data(), names.size()));
  return {};
}

Answers store(const Arguments& arguments) {
  require(inkwell_store_parameters(find(arguments)->second));
  return {};
}

Answers restore(const Arguments& arguments) {
  require(inkwell_restore_parameters(find(arguments)->second));
  return {};
}

Answers factory_reset(const Arguments& arguments) {
  require(inkwell_factory_reset(find(arguments)->second));
  return {};
}

Answers store_state(const Arguments& arguments) {
  inkwell_store store;
  require(inkwell_get_store(find(arguments)->second, &store));
  static const char* const contents[] = {"nothing", "parameters", "factory reset", "other schema"};
  const char* names[] = {"contents", "not_stored", "stores_left", "records_written"};
  mxArray* values[] = {mxCreateString(store.contents >= 0 && store.contents < 4 ? contents[store.contents] : "unknown"),
                       mxCreateDoubleScalar(store.not_stored), mxCreateDoubleScalar(store.stores_left),
                       mxCreateDoubleScalar(store.records_written)};
  mxArray* structure = mxCreateStructMatrix(1, 1, static_cast<int>(std::size(names)), names);
  for (std::size_t i = 0; i < std::size(names); ++i) mxSetField(structure, 0, names[i], values[i]);
  return {structure};
}

Answers self_test(const Arguments& arguments) {
  inkwell_arm* const arm = find(arguments)->second;
  std::size_t count = 0;
  require(inkwell_get_self_test(arm, nullptr, 0, &count));
  std::vector<inkwell_test_item> items(count);
  const bool only_last = mxGetScalar(arguments.at(1)) != 0;
  require((only_last ? inkwell_get_self_test : inkwell_self_test)(arm, items.data(), items.size(), &count));
  static const char* const results[] = {"not done",   "passed",  "failed",        "moved",     "no part",
                                        "broken off", "missing", "unknown motor", "wrong sign"};
  const char* names[] = {"name", "result", "figure", "unit", "takes_force", "meaning", "remedy"};
  mxArray* table =
      mxCreateStructMatrix(static_cast<mwSize>(items.size()), 1, static_cast<int>(std::size(names)), names);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const inkwell_test_item& item = items[i];
    const bool is_known = item.result >= 0 && static_cast<std::size_t>(item.result) < std::size(results);
    mxArray* values[] = {mxCreateString(item.name),
                         mxCreateString(is_known ? results[item.result] : "unknown"),
                         mxCreateDoubleScalar(item.figure),
                         mxCreateString(item.unit),
                         mxCreateLogicalScalar(item.takes_force != 0),
                         mxCreateString(item.meaning),
                         mxCreateString(item.remedy)};
    for (std::size_t j = 0; j < std::size(names); ++j) mxSetField(table, static_cast<mwIndex>(i), names[j], values[j]);
  }
  return {table};
}

Answers parameters(const Arguments&) {
  const char* names[] = {"name", "unit", "help", "minimum", "maximum", "default_value"};
  mxArray* table = mxCreateStructMatrix(static_cast<mwSize>(inkwell_parameter_count()), 1,
                                        static_cast<int>(std::size(names)), names);
  for (std::size_t i = 0; i < inkwell_parameter_count(); ++i) {
    const inkwell_parameter& row = *inkwell_parameter_at(i);
    mxArray* values[] = {mxCreateString(row.name),          mxCreateString(row.unit),
                         mxCreateString(row.help),          mxCreateDoubleScalar(row.minimum),
                         mxCreateDoubleScalar(row.maximum), mxCreateDoubleScalar(row.default_value)};
    for (std::size_t j = 0; j < std::size(names); ++j) mxSetField(table, static_cast<mwIndex>(i), names[j], values[j]);
  }
  return {table};
}

Answers signals(const Arguments&) {
  mxArray* names = mxCreateCellMatrix(static_cast<mwSize>(inkwell_signal_count()), 1);
  for (std::size_t i = 0; i < inkwell_signal_count(); ++i)
    mxSetCell(names, static_cast<mwIndex>(i), mxCreateString(inkwell_signal_at(i)->name));
  return {names};
}

Answers select(const Arguments& arguments) {
  const auto names = texts(argument(arguments, 1));
  require(inkwell_select_signals(find(arguments)->second, pointers(names).data(), names.size()));
  return {};
}

/// Reads samples of the selected signals. Returns the values, the control periods and the number of lost samples.
Answers read(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  const auto columns = static_cast<std::size_t>(number(argument(arguments, 1)));
  const auto wanted = static_cast<std::size_t>(number(argument(arguments, 2)));
  std::vector<float> values(wanted * columns);
  std::vector<std::int64_t> periods(wanted);
  std::size_t rows = 0;
  std::uint64_t lost = 0;
  while (rows < wanted) {
    std::size_t count = 0;
    std::uint64_t lost_before = 0;
    require(inkwell_read_samples(arm, 10.0, values.data() + rows * columns, periods.data() + rows, wanted - rows,
                                 &count, &lost_before));
    if (count == 0) throw Wrong("No samples arrived within 10 s. Reset the board, or let a paused virtual board run.");
    rows += count;
    lost += lost_before;
  }
  mxArray* matrix = mxCreateDoubleMatrix(static_cast<mwSize>(rows), static_cast<mwSize>(columns), mxREAL);
  mxArray* numbers = mxCreateDoubleMatrix(static_cast<mwSize>(rows), 1, mxREAL);
  for (std::size_t row = 0; row < rows; ++row) {
    mxGetPr(numbers)[row] = static_cast<double>(periods[row]);
    for (std::size_t i = 0; i < columns; ++i) mxGetPr(matrix)[i * rows + row] = values[row * columns + i];
  }
  return {matrix, numbers, mxCreateDoubleScalar(static_cast<double>(lost))};
}

Answers record(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  const auto names = texts(argument(arguments, 2));
  require(inkwell_select_signals(arm, pointers(names).data(), names.size()));
  require(inkwell_describe_recordings(arm, text(argument(arguments, 3)).c_str(), text(argument(arguments, 4)).c_str()));
  require(inkwell_start_recording(arm, text(argument(arguments, 1)).c_str()));
  return {};
}

Answers stop_recording(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  std::uint64_t samples = 0, lost = 0;
  int is_complete = 0;
  require(inkwell_finish_recording(arm, &samples, &lost, &is_complete));
  require(inkwell_select_signals(arm, nullptr, 0));
  return {mxCreateDoubleScalar(static_cast<double>(samples)), mxCreateDoubleScalar(static_cast<double>(lost)),
          mxCreateLogicalScalar(is_complete != 0)};
}

Answers mark(const Arguments& arguments) {
  require(inkwell_mark(find(arguments)->second, text(argument(arguments, 1)).c_str()));
  return {};
}

Answers losses(const Arguments& arguments) {
  inkwell_losses losses;
  require(inkwell_get_losses(find(arguments)->second, &losses));
  const char* names[] = {"poses", "poses_missed_by_servo", "slow_servo_calls", "longest_servo_call_s"};
  const double values[] = {static_cast<double>(losses.poses), static_cast<double>(losses.poses_missed_by_servo),
                           static_cast<double>(losses.slow_servo_calls), losses.longest_servo_call_s};
  mxArray* answer = mxCreateStructMatrix(1, 1, static_cast<int>(std::size(names)), names);
  for (std::size_t i = 0; i < std::size(names); ++i) mxSetField(answer, 0, names[i], mxCreateDoubleScalar(values[i]));
  return {answer};
}

Answers test_pulse(const Arguments& arguments) {
  const std::string unit = text(argument(arguments, 2));
  if (unit != "V" && unit != "A") throw Wrong("The unit of the pulse is not known. Give 'V' or 'A'.");
  require(inkwell_send_test_pulse(find(arguments)->second, static_cast<int>(number(argument(arguments, 1))),
                                  unit == "V" ? INKWELL_PULSE_V : INKWELL_PULSE_A, number(argument(arguments, 3)),
                                  number(argument(arguments, 4))));
  return {};
}

Answers hand(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  if (arguments.size() < 2) {
    require(inkwell_release_virtual_hand(arm));
    return {};
  }
  const auto target_m = vector(arguments[1]);
  const double stiffness_N_per_m = number(argument(arguments, 2));
  require(arguments.size() < 4
              ? inkwell_move_virtual_hand(arm, target_m.data(), stiffness_N_per_m)
              : inkwell_hold_virtual_hand(arm, target_m.data(), stiffness_N_per_m, number(arguments[3])));
  return {};
}

Answers connect_hand(const Arguments& arguments) {
  require(inkwell_connect_virtual_hand(find(arguments)->second, text(argument(arguments, 1)).c_str()));
  return {};
}

/// The rows of the matrix are the points of the path: time and target.
Answers hand_path(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  const mxArray* points = argument(arguments, 1);
  if (mxGetN(points) != 4) throw Wrong("The path is not valid. Give a matrix with rows [time_s x_m y_m z_m].");
  const auto values = numbers(points);  // column by column
  const std::size_t count = mxGetM(points);
  std::vector<inkwell_waypoint> path(count);
  for (std::size_t i = 0; i < count; ++i)
    path[i] = {values[i], {values[count + i], values[2 * count + i], values[3 * count + i]}};
  require(inkwell_move_virtual_hand_along(arm, path.data(), path.size()));
  return {};
}

Answers truth(const Arguments& arguments) {
  inkwell_arm* arm = find(arguments)->second;
  std::vector<char> json(1);
  std::size_t size = 0;
  for (;;) {  // the length of a number can change between two calls
    require(inkwell_read_virtual_truth(arm, json.data(), json.size(), &size));
    if (size <= json.size()) return {mxCreateString(json.data())};
    json.resize(size);
  }
}

const std::map<std::string, Answers (*)(const Arguments&)> commands{
    {"open", open},
    {"close", close},
    {"pose", pose},
    {"last_pose", last_pose},
    {"state", state},
    {"abilities", abilities},
    {"kinematics", kinematics},
    {"joint_torques", joint_torques},
    {"claim", claim},
    {"priority", priority},
    {"devices", devices},
    {"names", arm_names},
    {"version", version},
    {"sleep", sleep},
    {"enable", enable},
    {"stop", stop},
    {"take_over", take_over},
    {"driver", driver},
    {"clear_fault", clear_fault},
    {"force", force},
    {"scene_add", scene_add},
    {"scene_move", scene_move},
    {"scene_material", scene_material},
    {"scene_remove", scene_remove},
    {"scene_contacts", scene_contacts},
    {"scene_events", scene_events},
    {"get", get},
    {"set", set},
    {"store", store},
    {"restore", restore},
    {"factory_reset", factory_reset},
    {"self_test", self_test},
    {"store_state", store_state},
    {"select", select},
    {"parameters", parameters},
    {"signals", signals},
    {"read", read},
    {"hand", hand},
    {"connect_hand", connect_hand},
    {"hand_path", hand_path},
    {"truth", truth},
    {"record", record},
    {"stop_recording", stop_recording},
    {"mark", mark},
    {"losses", losses},
    {"test_pulse", test_pulse},
    {"information", information},
};

Answers run(const Arguments& arguments) {
  const auto command = commands.find(text(argument(arguments, 0)));
  if (command == commands.end())
    throw Wrong("There is no such command. Use the functions whose names begin with inkwell_.");
  return command->second(Arguments(arguments.begin() + 1, arguments.end()));
}

/// Returns the error identifier for a result code.
const char* identifier_of(inkwell_result result) {
  switch (result) {
    case INKWELL_TIMED_OUT: return "inkwell:timed_out";
    case INKWELL_DISCONNECTED: return "inkwell:disconnected";
    case INKWELL_FORCE_LOST: return "inkwell:force_lost";
    default: return "inkwell:refused";
  }
}

}  // namespace

void mexFunction(int answer_count, mxArray* answers[], int argument_count, const mxArray* arguments[]) {
  static char sentence[1024];  // static, because mexErrMsgIdAndTxt() does not return and runs no destructors
  sentence[0] = '\0';
  const char* identifier = identifier_of(INKWELL_FAILED);
  mexAtExit(close_all);
  try {
    const Answers answers_given = run(Arguments(arguments, arguments + argument_count));
    for (std::size_t i = 0; i < answers_given.size() && (i == 0 || i < static_cast<std::size_t>(answer_count)); ++i)
      answers[i] = answers_given[i];
  } catch (const inkwell::Failure& error) {
    std::snprintf(sentence, sizeof sentence, "%s", error.what());
    identifier = identifier_of(error.result);
  } catch (const std::exception& error) {
    std::snprintf(sentence, sizeof sentence, "%s", error.what());
  }
  if (sentence[0] != '\0') mexErrMsgIdAndTxt(identifier, "%s", sentence);
}
