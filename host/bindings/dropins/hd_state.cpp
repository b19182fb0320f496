// HDAPI functions for parameters and capabilities.
#include <algorithm>
#include <cmath>

#include "host/bindings/dropins/errors.hpp"
#include "host/bindings/dropins/guarded.hpp"
#include "host/bindings/dropins/hd_interface.hpp"
#include "host/bindings/dropins/parameters.hpp"
#include "host/bindings/dropins/runtime.hpp"

using namespace inkwell::dropins;

namespace {

/// Finds the parameter's table row, and the current device if the parameter requires a device. Raises an error for an
/// invalid call.
struct Query {
  const Parameter* row = nullptr;
  Device* device = nullptr;
  bool is_last = false;

  Query(Enum value, unsigned type, const void* values) {
    auto& devices = runtime().devices;
    const auto found = find_parameter(value);
    const ErrorCode error = !found                            ? invalid_enum
                            : (found->row->types & type) == 0 ? invalid_input_type
                            : values == nullptr               ? invalid_value
                                                              : success;
    if (error != success) {
      raise(error, devices.current_handle());
      return;
    }
    is_last = found->is_last;
    if (found->row->needs_device && (device = devices.current()) == nullptr) return;
    row = found->row;
  }

  Source source() const {
    const Moment* moment = device == nullptr ? nullptr : is_last ? &device->before() : &device->now();
    return {device, moment, runtime().scheduler};
  }
};

template <class Value>
void get(Enum value, unsigned type, Value* values) {
  guarded([&] {
    const std::lock_guard lock(runtime().devices.mutex());
    const Query query(value, type, values);
    if (query.row == nullptr) return;
    double read[values_maximum]{};
    query.row->read(query.source(), read);
    std::transform(read, read + query.row->count, values, [](double each) { return static_cast<Value>(each); });
  });
}

template <class Value>
void set(Enum value, unsigned type, const Value* values) {
  guarded([&] {
    const std::lock_guard lock(runtime().devices.mutex());
    const Query query(value, type, values);
    if (query.row == nullptr) return;
    const Handle handle = runtime().devices.current_handle();
    if (query.row->write == nullptr || query.is_last) return raise(invalid_operation, handle, "This can not be set.");
    if (!query.device->in_frame()) return raise(frame_error, handle);
    double given[values_maximum]{};
    std::copy_n(values, query.row->count, given);
    const bool is_finite =
        std::all_of(given, given + query.row->count, [](double each) { return std::isfinite(each); });
    if (!is_finite || !query.row->write(*query.device, given)) raise(invalid_value, handle);
  });
}

/// Calls `action` with a capability of the current device. Raises an error if the device or the capability does not
/// exist.
template <class Action>
void with_capability(Enum capability, Action action) {
  guarded([&] {
    auto& devices = runtime().devices;
    const std::lock_guard lock(devices.mutex());
    if (Capabilities().find(capability) == nullptr) return raise(invalid_enum, devices.current_handle());
    if (Device* device = devices.current()) action(*device, *device->capabilities.find(capability));
  });
}

/// Returns the device if the capability is `force_output`, and NULL otherwise.
std::shared_ptr<Device> switch_capability(Enum capability, bool on) {
  std::shared_ptr<Device> switched;
  with_capability(capability, [&](Device& device, bool& is_on) {
    is_on = on;
    if (&is_on != &device.capabilities.force_output) return;
    device.follow_force_output();
    switched = runtime().devices.hold_current();
  });
  return switched;
}

}  // namespace

void hdGetBooleanv(HdEnum parameter, HdBoolean* values) { get(parameter, type_boolean, values); }
void hdGetIntegerv(HdEnum parameter, int* values) { get(parameter, type_integer, values); }
void hdGetFloatv(HdEnum parameter, float* values) { get(parameter, type_float, values); }
void hdGetDoublev(HdEnum parameter, double* values) { get(parameter, type_double, values); }
void hdGetLongv(HdEnum parameter, long* values) { get(parameter, type_long, values); }

void hdSetBooleanv(HdEnum parameter, const HdBoolean* values) { set(parameter, type_boolean, values); }
void hdSetIntegerv(HdEnum parameter, const int* values) { set(parameter, type_integer, values); }
void hdSetFloatv(HdEnum parameter, const float* values) { set(parameter, type_float, values); }
void hdSetDoublev(HdEnum parameter, const double* values) { set(parameter, type_double, values); }
void hdSetLongv(HdEnum parameter, const long* values) { set(parameter, type_long, values); }

const char* hdGetString(HdEnum parameter) {
  const char* text = "";
  guarded([&] {
    const std::lock_guard lock(runtime().devices.mutex());
    const Query query(parameter, type_string, &text);
    if (query.row != nullptr) text = keep(query.row->text(query.source()));
  });
  return text;
}

void hdEnable(HdEnum capability) { switch_capability(capability, true); }

void hdDisable(HdEnum capability) {
  const auto device = switch_capability(capability, false);
  // A callback must not wait, because the wait would block the scheduler.
  if (device && !runtime().scheduler.tick_of_caller()) guarded([&] { device->wait_until_force_is_off(); });
}

HdBoolean hdIsEnabled(HdEnum capability) {
  HdBoolean answer = 0;
  with_capability(capability, [&](Device&, bool& is_on) { answer = is_on ? 1 : 0; });
  return answer;
}
