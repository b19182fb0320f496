#include "host/lab/soak/storm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace inkwell::soak {
namespace {

using protocol::Bounds;
using protocol::Parameter;
using protocol::ParameterKind;
using protocol::ParameterSet;
using protocol::Refusal;

/// Range of a parameter for Reach::careful.
struct Careful {
  Parameter parameter;
  float below_default, above_default;  ///< fractions of the default if `by_parts`
  bool by_parts;
};

constexpr float box_out_m = 0.02f, box_in_m = 0.03f;
constexpr auto around_default = std::to_array<Careful>({
    {Parameter::box_minimum_x_m, box_out_m, box_in_m, false},
    {Parameter::box_minimum_y_m, box_out_m, box_in_m, false},
    {Parameter::box_minimum_z_m, box_out_m, box_in_m, false},
    {Parameter::box_maximum_x_m, box_in_m, box_out_m, false},
    {Parameter::box_maximum_y_m, box_in_m, box_out_m, false},
    {Parameter::box_maximum_z_m, box_in_m, box_out_m, false},
    {Parameter::motor_resistance_1_ohm, 0.1f, 0.1f, true},
    {Parameter::motor_resistance_2_ohm, 0.1f, 0.1f, true},
    {Parameter::motor_resistance_3_ohm, 0.1f, 0.1f, true},
    {Parameter::current_proportional_gain_V_per_A, 0.5f, 0.2f, true},
    {Parameter::current_integral_gain_V_per_As, 0.5f, 0.2f, true},
});

struct Between {
  Parameter parameter;
  float minimum, maximum;
};
constexpr auto between = std::to_array<Between>({
    {Parameter::voltage_limit_V, 4.0f, 24.0f},
    {Parameter::speed_limit_m_per_s, 2.0f, 10.0f},
    {Parameter::host_timeout_s, 0.05f, 2.0f},
    // With a lower value, the heat fault would trip at a wall.
    {Parameter::continuous_current_1_A, 0.5f, 3.0f},
    {Parameter::continuous_current_2_A, 0.5f, 3.0f},
    {Parameter::continuous_current_3_A, 0.5f, 3.0f},
    {Parameter::winding_time_constant_s, 4.0f, 1000.0f},
    {Parameter::housing_time_constant_s, 4.0f, 2000.0f},
});

float random_value(Random& random, Parameter parameter, Reach reach) {
  const auto [minimum, maximum] = range_of(parameter, reach);
  if (random.chance(0.1)) return random.chance(0.5) ? minimum : maximum;  // includes the limits of the range
  const float value = std::clamp(
      static_cast<float>(random.from(static_cast<double>(minimum), static_cast<double>(maximum))), minimum, maximum);
  return info(parameter).kind == ParameterKind::real ? value : std::clamp(std::round(value), minimum, maximum);
}

void put(Changes& changes, Parameter parameter, float value) {
  const auto same = std::ranges::find(changes, parameter, &device::ParameterChange::first);
  if (same == changes.end())
    changes.emplace_back(parameter, value);
  else
    same->second = value;
}

/// Changes both parameters of a contradictory pair.
void reconcile(Random& random, Changes& changes, const ParameterSet& now, const Bounds& pair, Reach reach) {
  constexpr float gap = 0.001f;
  const ParameterSet set = with(now, changes);
  const float room = (pair.hold_sphere ? 2.0f * set[Parameter::sphere_radius_m] : 0.0f) + gap;
  if (set[pair.upper] - set[pair.lower] >= room) return;
  const Range low = range_of(pair.lower, reach), high = range_of(pair.upper, reach);
  const float lower = static_cast<float>(
      random.from(static_cast<double>(low.minimum), static_cast<double>(std::min(low.maximum, high.maximum - room))));
  put(changes, pair.lower, lower);
  put(changes, pair.upper,
      static_cast<float>(
          random.from(static_cast<double>(std::max(high.minimum, lower + room)), static_cast<double>(high.maximum))));
}

Parameter random_parameter(Random& random, auto condition) {
  std::vector<Parameter> some;
  for (const Parameter parameter : within(Reach::whole))
    if (condition(info(parameter))) some.push_back(parameter);
  return random.pick(some);
}

/// Returns an illegal change, or std::nullopt for a duplicated entry.
std::optional<device::ParameterChange> illegal_entry(Random& random, const ParameterSet& now, Refusal refusal) {
  const auto any = [](const auto&) { return true; };
  const auto with_choices = [](const auto& row) { return row.kind != ParameterKind::real; };
  switch (refusal) {
    case Refusal::not_finite: {
      const float value =
          random.chance(0.5) ? std::numeric_limits<float>::quiet_NaN() : -std::numeric_limits<float>::infinity();
      return device::ParameterChange{random_parameter(random, any), value};
    }
    case Refusal::out_of_range: {
      const Parameter parameter = random_parameter(random, any);
      const auto& row = info(parameter);
      const float beyond = (row.maximum - row.minimum) * static_cast<float>(random.from(0.001, 2.0));
      return device::ParameterChange{parameter, random.chance(0.5) ? row.maximum + beyond : row.minimum - beyond};
    }
    case Refusal::not_whole: {
      const Parameter parameter = random_parameter(random, with_choices);
      return device::ParameterChange{parameter, info(parameter).minimum + 0.5f};
    }
    case Refusal::force_is_on: {
      const Parameter parameter = random_parameter(random, [](const auto& row) { return row.needs_force_off; });
      const auto& row = info(parameter);
      return device::ParameterChange{parameter, now[parameter] == row.minimum ? row.maximum : row.minimum};
    }
    case Refusal::inconsistent: {
      const Bounds& pair = protocol::parameter_bounds[random.below(3)];  // bounds of the box, which may change with the
                                                                         // force on
      return device::ParameterChange{pair.lower, now[pair.upper]};
    }
    default: return std::nullopt;
  }
}

}  // namespace

std::vector<Parameter> within(Reach reach) {
  std::vector<Parameter> some;
  const auto rows = protocol::known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (reach == Reach::whole || !rows[i].needs_force_off) some.push_back(static_cast<Parameter>(i));
  return some;
}

Range range_of(Parameter parameter, Reach reach) {
  const auto& row = info(parameter);
  if (reach == Reach::whole) return {row.minimum, row.maximum};
  for (const Careful& careful : around_default)
    if (careful.parameter == parameter) {
      const float unit = careful.by_parts ? row.default_value : 1.0f;
      return {std::max(row.minimum, row.default_value - careful.below_default * unit),
              std::min(row.maximum, row.default_value + careful.above_default * unit)};
    }
  for (const Between& some : between)
    if (some.parameter == parameter) return {some.minimum, some.maximum};
  return {row.minimum, row.maximum};
}

ParameterSet with(ParameterSet set, std::span<const device::ParameterChange> changes) {
  for (const auto& [parameter, value] : changes) set[parameter] = value;
  return set;
}

Changes legal_changes(Random& random, const ParameterSet& now, Reach reach, std::size_t count) {
  std::vector<Parameter> some = within(reach);
  random.shuffle(some);
  some.resize(std::min(count, some.size()));
  Changes changes;
  for (const Parameter parameter : some) changes.emplace_back(parameter, random_value(random, parameter, reach));
  for (const Bounds& pair : protocol::parameter_bounds) reconcile(random, changes, now, pair, reach);
  return changes;
}

Illegal illegal_changes(Random& random, const ParameterSet& now, bool force_is_on) {
  constexpr Refusal kinds[] = {Refusal::not_finite,   Refusal::out_of_range, Refusal::not_whole,
                               Refusal::inconsistent, Refusal::given_twice,  Refusal::force_is_on};
  Illegal illegal;
  illegal.refusal = kinds[random.below(std::size(kinds) - (force_is_on ? 0 : 1))];
  illegal.changes = legal_changes(random, now, Reach::careful, 1 + random.below(6));
  auto entry = illegal_entry(random, now, illegal.refusal);
  if (!entry) entry = random.pick(illegal.changes);
  const bool twice = illegal.refusal == Refusal::given_twice;
  if (!twice) std::erase_if(illegal.changes, [&](const auto& change) { return change.first == entry->first; });
  if (illegal.refusal == Refusal::inconsistent)  // no other entry may make the pair consistent
    for (const Bounds& pair : protocol::parameter_bounds)
      if (pair.lower == entry->first)
        std::erase_if(illegal.changes, [&](const auto& change) { return change.first == pair.upper; });
  const auto at = static_cast<std::ptrdiff_t>(random.below(illegal.changes.size() + 1));
  illegal.changes.insert(illegal.changes.begin() + at, *entry);
  return illegal;
}

}  // namespace inkwell::soak
