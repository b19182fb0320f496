#include "host/client/device/event.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"
#include "host/client/device/parameter_file.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::device {
namespace {

constexpr std::array<std::string_view, event_kind_count> event_kind_names{
    "mark", "connection", "force", "fault", "parameter", "loss", "button", "source", "shape"};

}  // namespace

std::string_view name_of(EventKind kind) { return event_kind_names[static_cast<std::size_t>(kind)]; }

std::optional<EventKind> find_event_kind(std::string_view name) {
  const auto found = std::ranges::find(event_kind_names, name);
  if (found == event_kind_names.end()) return std::nullopt;
  return static_cast<EventKind>(found - event_kind_names.begin());
}

std::string clock_utc_now() {
  using namespace std::chrono;
  const auto now = time_point_cast<microseconds>(system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}Z", fmt::gmtime(system_clock::to_time_t(now)),
                     now.time_since_epoch().count() % 1'000'000);
}

Event event_now(EventKind kind, std::string text, std::optional<std::int64_t> at_periods) {
  return {kind, protocol::plain_text(text), clock_utc_now(), at_periods};
}

std::string log_line(std::string_view clock_utc, std::optional<double> time_s, EventKind kind, std::string_view text) {
  return fmt::format("{:<27}  {:>14}  {:<10}  {}\n", clock_utc.empty() ? "-" : clock_utc,
                     time_s ? fmt::format("{:.5f} s", *time_s) : "-", name_of(kind), text);
}

std::string line_of(const Event& event) {
  std::optional<double> time_s;
  if (event.at_periods) time_s = board_time_s(*event.at_periods);
  return log_line(event.clock_utc, time_s, event.kind, event.text);
}

std::vector<Event> events_between(const std::optional<Pose>& before, const Pose& now,
                                  std::optional<std::int64_t> noticed_at_periods) {
  std::vector<Event> events;
  const bool was_on = before && protocol::force_is_on(before->state);
  const bool is_on = protocol::force_is_on(now.state);
  if (was_on != is_on)
    events.push_back(event_now(EventKind::force, is_on ? "The force is on." : "The force is off.", now.time_periods));
  const auto fault_of = [](const Pose& pose) {
    return pose.state == protocol::State::fault ? pose.fault : protocol::Fault::none;
  };
  const protocol::Fault was_in = before ? fault_of(*before) : protocol::Fault::none;
  const protocol::Fault is_in = fault_of(now);
  if (is_in == was_in) return events;
  if (is_in == protocol::Fault::none)
    events.push_back(event_now(EventKind::fault, fmt::format("{} was cleared.", info(was_in).name), now.time_periods));
  else
    events.push_back(event_now(EventKind::fault, fmt::format("{}: {}", info(is_in).name, fault_text(is_in).cause),
                               noticed_at_periods.value_or(now.time_periods)));
  return events;
}

std::vector<Event> events_of_change(const protocol::ParameterSet& before, const protocol::ParameterSet& now,
                                    std::optional<std::int64_t> at_periods, std::string_view whose) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
    if (before.values[i] == now.values[i]) continue;
    const auto parameter = static_cast<protocol::Parameter>(i);
    events.push_back(
        event_now(EventKind::parameter,
                  fmt::format("{} = {}, was {}{}", info(parameter).name, format_value(parameter, now.values[i]),
                              format_value(parameter, before.values[i]), whose),
                  at_periods));
  }
  return events;
}

void EventLog::add(Event event) {
  if (events_.size() == kept_maximum) events_.pop_front();
  events_.push_back(std::move(event));
  ++end_;
}

void EventLog::add(std::vector<Event> events) {
  for (Event& event : events) add(std::move(event));
}

}  // namespace inkwell::device
