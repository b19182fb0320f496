// Events of a device for logs and recordings.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/wide_reports.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::device {

enum class EventKind : std::uint8_t {
  mark,        ///< set by a user
  connection,  ///< a device was connected or disconnected
  force,       ///< the force was switched on or off
  fault,       ///< the device entered or left the fault state
  parameter,   ///< a parameter was changed, or a change was refused
  loss,        ///< samples or poses were lost
  button,      ///< a button of the stylus was pressed or released
  source,      ///< the force that the hand feels has other sources
  shape,       ///< a program placed or removed shapes
};
inline constexpr std::size_t event_kind_count = static_cast<std::size_t>(EventKind::shape) + 1;  // the last entry

/// Returns a name such as "parameter".
std::string_view name_of(EventKind kind);
/// Returns std::nullopt if no kind has this name.
std::optional<EventKind> find_event_kind(std::string_view name);

struct Event {
  EventKind kind;
  std::string text;       ///< one line
  std::string clock_utc;  ///< computer time of the event, formatted by clock_utc_now()
  /// Control period of the event, or std::nullopt if no device was connected.
  std::optional<std::int64_t> at_periods;
};

/// Returns a text such as "2026-11-23T22:15:34.123456Z".
std::string clock_utc_now();
Event event_now(EventKind kind, std::string text, std::optional<std::int64_t> at_periods);

/// Formats a log line with clock, seconds, kind and text. Replaces an unknown clock or time by a dash.
std::string log_line(std::string_view clock_utc, std::optional<double> time_s, EventKind kind, std::string_view text);
std::string line_of(const Event& event);

/// Returns the events between two poses, such as a switched force or a raised fault. Without `before`, assumes an
/// earlier pose without force and fault. `noticed_at_periods` is the exact time of the current fault, if known.
std::vector<Event> events_between(const std::optional<Pose>& before, const Pose& now,
                                  std::optional<std::int64_t> noticed_at_periods);

/// Returns one event per changed parameter, such as "wall_stiffness_N_per_m = 600.0, was 800.0". Appends `whose` to
/// each text.
std::vector<Event> events_of_change(const protocol::ParameterSet& before, const protocol::ParameterSet& now,
                                    std::optional<std::int64_t> at_periods, std::string_view whose = {});

/// Stores the newest events. Event numbers count from the start of the log.
class EventLog {
 public:
  static constexpr std::size_t kept_maximum = 5000;

  void add(Event event);
  void add(std::vector<Event> events);
  std::uint64_t begin() const { return end_ - events_.size(); }
  std::uint64_t end() const { return end_; }
  /// `number` is at least begin() and less than end().
  const Event& operator[](std::uint64_t number) const { return events_[number - begin()]; }

 private:
  std::deque<Event> events_;
  std::uint64_t end_ = 0;
};

}  // namespace inkwell::device
