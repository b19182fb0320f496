#include "firmware/store/parameter_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "firmware/control/signal_path/installed_force_law.hpp"

namespace inkwell::link {

namespace {

using protocol::Bounds;
using protocol::Parameter;
using protocol::parameter_count;
using protocol::ParameterKind;
using protocol::ParameterSet;
using protocol::Refusal;

/// Parameter table columns for the check. The image does not contain the texts of the parameter table.
struct Limits {
  std::uint16_t id;
  bool whole;
  bool needs_force_off;
  float minimum;
  float maximum;
};

constexpr std::array<Limits, parameter_count> table_limits = []() {
  std::array<Limits, parameter_count> rows{};
  for (std::size_t i = 0; i < parameter_count; ++i) {
    const protocol::ParameterInfo& row = protocol::parameter_table[i];
    rows[i] = {row.id, row.kind != ParameterKind::real, row.needs_force_off, row.minimum, row.maximum};
  }
  return rows;
}();

constexpr ParameterSet table_defaults = protocol::table_defaults();

std::uint16_t id_of(std::size_t index) {
  return index < parameter_count ? table_limits[index].id
                                 : static_cast<std::uint16_t>(protocol::force_law_first_id + index - parameter_count);
}

Limits limits(std::size_t index) {
  if (index < parameter_count) return table_limits[index];
  const control::ForceLawRange& range = control::installed_force_law.ranges[index - parameter_count];
  return {id_of(index), false, false, range.minimum, range.maximum};
}

/// Uses binary search, because the table is sorted by id.
std::optional<std::size_t> find(std::uint16_t id) {
  if (id >= protocol::force_law_first_id) {
    const std::size_t index = parameter_count + id - protocol::force_law_first_id;
    return index < image_parameter_count() ? std::optional(index) : std::nullopt;
  }
  std::size_t first = 0, end = parameter_count;
  while (first < end) {
    const std::size_t middle = (first + end) / 2;
    if (table_limits[middle].id == id) return middle;
    if (table_limits[middle].id < id)
      first = middle + 1;
    else
      end = middle;
  }
  return std::nullopt;
}

/// Returns the first pair of contradicting bounds, or null.
constexpr const Bounds* find_contradiction(const ParameterSet& set) {
  for (const Bounds& pair : protocol::parameter_bounds) {
    const float room = pair.hold_sphere ? 2.0f * set[Parameter::sphere_radius_m] : 0.0f;
    if (!(set[pair.upper] - set[pair.lower] > room)) return &pair;
  }
  return nullptr;
}
static_assert(find_contradiction(table_defaults) == nullptr, "the arm's defaults contradict each other");

ParameterCheck refuse(Refusal refusal, std::uint16_t id = 0, float value = 0.0f) { return {refusal, id, value, {}}; }

Refusal check_value(std::size_t index, float value, float current, bool force_is_on) {
  const Limits row = limits(index);
  if (!std::isfinite(value)) return Refusal::not_finite;
  if (!(row.minimum <= value && value <= row.maximum)) return Refusal::out_of_range;
  // The values of every integer parameter are within the range of int32.
  if (row.whole && static_cast<float>(static_cast<std::int32_t>(value)) != value) return Refusal::not_whole;
  if (row.needs_force_off && force_is_on && value != current) return Refusal::force_is_on;
  return Refusal::accepted;
}

using Written = std::array<bool, parameter_count + protocol::force_law_parameters_maximum>;

/// Returns the parameter whose change caused the contradiction.
Parameter find_cause(const Bounds& pair, const Written& written) {
  if (written[static_cast<std::size_t>(pair.lower)]) return pair.lower;
  if (written[static_cast<std::size_t>(pair.upper)]) return pair.upper;
  return Parameter::sphere_radius_m;  // the previous set had no contradiction
}

ParameterCheck check_whole(const ParameterSet& set, const Written& written) {
  if (const Bounds* pair = find_contradiction(set)) {
    const Parameter parameter = find_cause(*pair, written);
    return refuse(Refusal::inconsistent, id_of(static_cast<std::size_t>(parameter)), set[parameter]);
  }
  return {Refusal::accepted, 0, 0.0f, set};
}

/// Restores the defaults or the stored parameters.
ParameterCheck restore(const ParameterSet& wanted, const ParameterSet& current, bool force_is_on) {
  if (force_is_on)
    for (std::size_t i = 0; i < parameter_count; ++i)
      if (table_limits[i].needs_force_off && wanted.values[i] != current.values[i])
        return refuse(Refusal::force_is_on, id_of(i), wanted.values[i]);
  return {Refusal::accepted, 0, 0.0f, wanted};
}

protocol::ParameterEntry entry_at(std::span<const std::byte> report, std::size_t i) {
  protocol::ParameterEntry entry;
  std::memcpy(&entry, report.data() + protocol::parameters_report_size(i), sizeof entry);
  return entry;
}

}  // namespace

std::size_t image_parameter_count() { return parameter_count + control::installed_force_law.parameter_count; }

std::uint16_t image_parameter_id(std::size_t index) { return id_of(index); }

std::optional<std::size_t> image_parameter_index(std::uint16_t id) { return find(id); }

ParameterSet image_defaults() {
  ParameterSet set = table_defaults;
  for (std::size_t i = parameter_count; i < image_parameter_count(); ++i)
    set.values[i] = control::installed_force_law.ranges[i - parameter_count].default_value;
  return set;
}

void StoredSet::put(std::size_t index, float value) {
  if (check_value(index, value, value, false) == Refusal::accepted)
    set_.values[index] = value;
  else
    ++refused_;
}

void StoredSet::make_consistent() {
  const ParameterSet defaults = image_defaults();
  const auto give_up = [&](Parameter parameter) {
    if (set_[parameter] == defaults[parameter]) return;
    set_[parameter] = defaults[parameter];
    ++refused_;
  };
  while (const Bounds* pair = find_contradiction(set_)) {
    give_up(pair->lower);
    give_up(pair->upper);
    if (pair->hold_sphere) give_up(Parameter::sphere_radius_m);
  }
}

TransactionHeader header_of(std::span<const std::byte> report) {
  TransactionHeader header{};
  static_assert(sizeof header == protocol::parameters_report_size(0));
  std::memcpy(&header, report.data(), std::min(report.size(), sizeof header));
  return header;
}

ParameterCheck check_transaction(std::span<const std::byte> report, const ParameterSet& current, bool force_is_on,
                                 const ParameterSet* stored) {
  constexpr std::size_t header_size = protocol::parameters_report_size(0);
  if (report.size() < header_size) return refuse(Refusal::wrong_length);
  const TransactionHeader header = header_of(report);

  if (header.version != protocol::protocol_version) return refuse(Refusal::wrong_version);
  if (header.count > protocol::parameter_entries_maximum) return refuse(Refusal::wrong_length);
  if (report.size() < protocol::parameters_report_size(header.count)) return refuse(Refusal::wrong_length);

  if (header.operation == protocol::ParameterOperation::restore_defaults)
    return header.count == 0 ? restore(image_defaults(), current, force_is_on) : refuse(Refusal::wrong_length);
  if (header.operation == protocol::ParameterOperation::restore_stored) {
    if (header.count != 0) return refuse(Refusal::wrong_length);
    return stored != nullptr ? restore(*stored, current, force_is_on) : refuse(Refusal::nothing_stored);
  }
  if (header.operation != protocol::ParameterOperation::set) return refuse(Refusal::unknown_operation);

  ParameterSet set = current;
  Written written{};
  for (std::size_t i = 0; i < header.count; ++i) {
    const protocol::ParameterEntry entry = entry_at(report, i);
    const std::optional<std::size_t> index = find(entry.id);
    if (!index) return refuse(Refusal::unknown_parameter, entry.id, entry.value);
    if (written[*index]) return refuse(Refusal::given_twice, entry.id, entry.value);
    const Refusal refusal = check_value(*index, entry.value, current.values[*index], force_is_on);
    if (refusal != Refusal::accepted) return refuse(refusal, entry.id, entry.value);
    written[*index] = true;
    set.values[*index] = entry.value;
  }
  return check_whole(set, written);
}

}  // namespace inkwell::link
