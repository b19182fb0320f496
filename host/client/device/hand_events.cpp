#include "host/client/device/hand_events.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace inkwell::device {
namespace {

using protocol::ForceSource;
using protocol::Switch;

std::string sources_text(std::uint8_t sources) {
  std::vector<std::string_view> names;
  for (const auto& row : protocol::force_source_table)
    if (protocol::is_felt(sources, row.source)) names.push_back(row.name);
  return names.empty() ? "No force source is active."
                       : fmt::format("Active force sources: {}.", fmt::join(names, " and "));
}

std::string vector_text(const std::array<float, 3>& vector) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", vector[0], vector[1], vector[2]);
}

std::string surface_text(const Surface& surface) {
  return fmt::format("{:.6g} N/m, {:.6g} Ns/m, friction {:.6g} and {:.6g}, viscosity {:.6g} Ns/m, life {:.6g} s",
                     surface.stiffness_N_per_m, surface.damping_Ns_per_m, surface.static_friction,
                     surface.dynamic_friction, surface.viscosity_Ns_per_m, surface.life_s);
}

}  // namespace

std::vector<Event> HandEvents::take(const Pose& pose) {
  std::vector<Event> events;
  for (const auto& [button, name] :
       {std::pair(Switch::button_1, "Button 1"), std::pair(Switch::button_2, "Button 2")}) {
    const bool was_pressed = is_closed(switches_, button), is_pressed = is_closed(pose.switches, button);
    if (was_pressed != is_pressed)
      events.push_back(event_now(
          EventKind::button, fmt::format("{} was {}.", name, is_pressed ? "pressed" : "released"), pose.time_periods));
  }
  switches_ = pose.switches;
  constexpr auto interval_periods = static_cast<std::int64_t>(source_interval_s * protocol::servo_rate_Hz);
  const bool is_early = sources_noted_at_periods_ && pose.time_periods >= *sources_noted_at_periods_ &&
                        pose.time_periods - *sources_noted_at_periods_ < interval_periods;
  if (pose.force_sources != force_sources_ && !is_early) {
    events.push_back(event_now(EventKind::source, sources_text(pose.force_sources), pose.time_periods));
    force_sources_ = pose.force_sources;
    sources_noted_at_periods_ = pose.time_periods;
  }
  return events;
}

std::vector<Event> events_of_shapes(const Shapes& shapes, std::int64_t at_periods) {
  std::vector<Event> events;
  const auto add = [&](std::string text) {
    events.push_back(event_now(EventKind::shape, std::move(text), at_periods));
  };
  for (std::size_t i = 0; i < shapes.planes.size(); ++i)
    if (const auto& plane = shapes.planes[i])
      add(fmt::format("Plane {}: point {} m, normal {}, {}", i + 1, vector_text(plane->point_m),
                      vector_text(plane->normal), surface_text(plane->surface)));
  if (const auto& sphere = shapes.sphere)
    add(fmt::format("Sphere: center {} m, radius {:.6g} m, {}", vector_text(sphere->centre_m), sphere->radius_m,
                    surface_text(sphere->surface)));
  static constexpr const char* kinds[] = {"sphere", "capsule", "cylinder", "box"};
  for (std::size_t i = 0; i < shapes.solids.size(); ++i) {
    const Solid& solid = shapes.solids[i];
    add(fmt::format("Solid {}: {}, center {} m, orientation {}, size {} m, {}", i + 1,
                    kinds[static_cast<std::size_t>(solid.kind)], vector_text(solid.centre_m),
                    fmt::join(solid.orientation, " "), vector_text(solid.size_m), surface_text(solid.surface)));
  }
  if (events.empty()) add("All shapes were removed.");
  return events;
}

std::optional<Event> event_of_lost_poses(std::uint64_t lost, std::int64_t at_periods) {
  if (lost == 0) return std::nullopt;
  return event_now(EventKind::loss, fmt::format("{} poses were lost.", lost), at_periods);
}

}  // namespace inkwell::device
