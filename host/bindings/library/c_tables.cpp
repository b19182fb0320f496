// Functions of the C interface for parameters, signals, scope and recordings.
#include <algorithm>
#include <deque>
#include <mutex>
#include <string_view>
#include <vector>

#include "host/client/device/board_store.hpp"
#include "host/client/device/nearest_name.hpp"

#include "host/bindings/library/c_guard.hpp"

using namespace inkwell::library;
namespace device = inkwell::device;
namespace protocol = inkwell::protocol;

namespace {

protocol::Parameter parameter_named(const char* name) {
  if (const auto parameter = protocol::find_parameter(std::string_view(required(name, "The parameter name"))))
    return *parameter;
  throw BadArgument(fmt::format("There is no parameter {}.{} `inkwell parameters` lists them all.", name,
                                device::suggestion(protocol::known_parameters(), name)));
}

protocol::Signal signal_named(const char* name) {
  if (const auto signal = protocol::find_signal(std::string_view(required(name, "The signal name")))) return *signal;
  throw BadArgument(fmt::format("There is no signal {}.{} `inkwell signals` lists them all.", name,
                                device::suggestion(protocol::known_signals(), name)));
}

void require_at_most(std::size_t maximum, std::size_t count, const char* what) {
  if (count > maximum) throw BadArgument(fmt::format("{} {} are too many. Give at most {}.", count, what, maximum));
}

std::mutex rows_mutex;
const inkwell::process::HeldAtFork rows_at_fork(rows_mutex);

// All texts of the tables are zero-terminated.
inkwell_parameter row_of(const protocol::ParameterInfo& row) {
  return {row.name.data(), row.unit.data(), row.help, row.minimum, row.maximum, row.default_value};
}
inkwell_signal row_of(const protocol::SignalInfo& row) { return {row.name.data(), row.unit.data(), row.help}; }

/// Returns a row as a C struct, or null after the last row. Rows are never moved or freed. A program may use a row
/// until the process exits.
template <class Row, class Table>
const Row* row_at(const Table& table, std::size_t index) {
  static auto& rows = *new std::deque<Row>;
  const std::lock_guard lock(rows_mutex);
  if (index >= table.size()) return nullptr;
  if (index >= rows.size()) rows.resize(index + 1);
  rows[index] = row_of(table[index]);
  return &rows[index];
}

}  // namespace

// ---- parameters --------------------------------------------------------------------------------------------

size_t inkwell_parameter_count(void) { return protocol::known_parameters().size(); }

const inkwell_parameter* inkwell_parameter_at(size_t index) {
  const inkwell_parameter* row = nullptr;
  guarded([&] { row = row_at<inkwell_parameter>(protocol::known_parameters(), index); });
  return row;
}

inkwell_result inkwell_get_parameter(inkwell_arm* arm, const char* name, double* value) {
  return guarded([&] {
    required(value, "The pointer to the value");
    const auto parameter = parameter_named(name);
    *value = arm_of(arm).device().parameters()[parameter];
  });
}

inkwell_result inkwell_set_parameters(inkwell_arm* arm, const char* const* names, const double* values, size_t count) {
  return guarded([&] {
    if (count > 0) required(names, "The list of names"), required(values, "The list of values");
    require_at_most(protocol::parameter_entries_maximum, count, "parameters");
    std::vector<device::ParameterChange> changes;
    for (std::size_t i = 0; i < count; ++i)
      changes.emplace_back(parameter_named(names[i]), static_cast<float>(values[i]));
    arm_of(arm).set_parameters(changes);
  });
}

// ---- stored parameters --------------------------------------------------------------------------------------

inkwell_result inkwell_store_parameters(inkwell_arm* arm) {
  return guarded([&] { device::store_parameters(arm_of(arm).device()); });
}

inkwell_result inkwell_restore_parameters(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).restore_parameters(); });
}

inkwell_result inkwell_factory_reset(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).factory_reset(); });
}

inkwell_result inkwell_get_stored_parameter(inkwell_arm* arm, const char* name, double* value) {
  return guarded([&] {
    required(value, "The pointer to the value");
    const auto parameter = parameter_named(name);
    *value = arm_of(arm).device().stored_parameters()[parameter];
  });
}

inkwell_result inkwell_get_store(inkwell_arm* arm, inkwell_store* store) {
  return guarded([&] {
    required(store, "The pointer to the store state");
    const auto report = arm_of(arm).device().store_report();
    *store = {};
    store->contents = static_cast<inkwell_stored>(report.contents);
    store->not_stored = report.differing;
    store->stores_left = report.stores_left;
    store->records_written = report.records_written;
    std::copy_n(report.sector_erases, protocol::store_sectors, store->sector_erases);
  });
}

// ---- self-test ---------------------------------------------------------------------------------------------

namespace {

void read_test(inkwell_arm* arm, bool is_new, inkwell_test_item* items, size_t capacity, size_t* count) {
  required(count, "The count");
  if (capacity > 0) required(items, "The pointer to the items");
  device::Device& board = arm_of(arm).device();
  const protocol::SelfTestReport report = is_new ? board.self_test() : board.read_self_test();
  *count = protocol::self_test_item_count;
  for (std::size_t i = 0; i < std::min(capacity, protocol::self_test_item_count); ++i) {
    const auto& row = protocol::self_test_item_table[i];
    const auto& entry = report.entries[i];
    items[i] = {row.name.data(),
                row.meaning.data(),
                row.remedy.data(),
                row.unit.data(),
                static_cast<double>(entry.figure),
                static_cast<inkwell_test>(entry.result),
                row.takes_force ? 1 : 0};
  }
}

}  // namespace

inkwell_result inkwell_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity, size_t* count) {
  return guarded([&] { read_test(arm, true, items, capacity, count); });
}

inkwell_result inkwell_get_self_test(inkwell_arm* arm, inkwell_test_item* items, size_t capacity, size_t* count) {
  return guarded([&] { read_test(arm, false, items, capacity, count); });
}

// ---- scope, recording --------------------------------------------------------------------------------------

size_t inkwell_signal_count(void) { return protocol::known_signals().size(); }

const inkwell_signal* inkwell_signal_at(size_t index) {
  const inkwell_signal* row = nullptr;
  guarded([&] { row = row_at<inkwell_signal>(protocol::known_signals(), index); });
  return row;
}

inkwell_result inkwell_select_signals(inkwell_arm* arm, const char* const* names, size_t count) {
  return guarded([&] {
    if (count > 0) required(names, "The list of names");
    require_at_most(protocol::scope_wide_maximum, count, "signals");
    std::vector<protocol::Signal> signals;
    for (std::size_t i = 0; i < count; ++i) signals.push_back(signal_named(names[i]));
    try {
      device::check_selection(signals);
    } catch (const device::Error& error) {
      throw BadArgument(error.what());
    }
    arm_of(arm).scope().select(signals);
  });
}

namespace {

template <class Period>
inkwell_result read_samples(inkwell_arm* arm, double timeout_s, float* values, Period* periods, size_t capacity,
                            size_t* count, uint64_t* lost) {
  return guarded([&] {
    required(count, "The count");
    if (capacity > 0) required(values, "The pointer to the samples");
    *count = 0;
    if (lost != nullptr) *lost = 0;
    const auto samples = arm_of(arm).scope().read(timeout_s, capacity);
    if (!samples) return;
    *count = samples->count;
    std::copy(samples->values.begin(), samples->values.end(), values);
    for (std::size_t i = 0; periods != nullptr && i < samples->count; ++i)
      periods[i] = static_cast<Period>(samples->first_period + static_cast<std::int64_t>(i));
    if (lost != nullptr) *lost = samples->lost_before;
  });
}

}  // namespace

inkwell_result inkwell_read_scope(inkwell_arm* arm, double timeout_s, float* values, uint32_t* periods, size_t capacity,
                                  size_t* count, uint64_t* lost) {
  return read_samples(arm, timeout_s, values, periods, capacity, count, lost);
}

inkwell_result inkwell_read_samples(inkwell_arm* arm, double timeout_s, float* values, int64_t* periods,
                                    size_t capacity, size_t* count, uint64_t* lost) {
  return read_samples(arm, timeout_s, values, periods, capacity, count, lost);
}

inkwell_result inkwell_start_recording(inkwell_arm* arm, const char* path) {
  return guarded([&] { arm_of(arm).start_recording(required(path, "The file name")); });
}

inkwell_result inkwell_stop_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost) {
  return guarded([&] {
    const auto status = arm_of(arm).stop_recording();
    if (samples != nullptr) *samples = status.samples;
    if (lost != nullptr) *lost = status.lost;
  });
}
