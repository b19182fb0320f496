// What happens to a device: the rows of the log that a session keeps and that recordings take along.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <device/wide_reports.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::device {

enum class EventKind : std::uint8_t {
  mark,        ///< set by the user
  connection,  ///< a device came or went
  force,       ///< it went on or off
  fault,       ///< the device came into one, or out of it
  parameter,   ///< one has another value, or a change was refused
  loss,        ///< of samples or poses on the way
};
inline constexpr std::size_t event_kind_count = static_cast<std::size_t>(EventKind::loss) + 1;  // the last one

/// "parameter", as in recordings.
std::string_view name_of(EventKind kind);
/// None for what is no kind's name.
std::optional<EventKind> find_event_kind(std::string_view name);

struct Event {
  EventKind kind;
  std::string text;       ///< one line
  std::string clock_utc;  ///< of the computer when it was noticed, as clock_utc_now() writes it
  /// Control period of the device; none if the device was not there to tell one.
  std::optional<std::int64_t> at_periods;
};

/// "2026-11-23T22:15:34.123Z"
std::string clock_utc_now();
/// One that is noticed now.
Event event_now(EventKind kind, std::string text, std::optional<std::int64_t> at_periods);

/// A line of a log: clock, seconds, kind, text; a dash where clock or time is not known.
std::string log_line(std::string_view clock_utc, std::optional<double> time_s, EventKind kind, std::string_view text);
/// With the board's own time.
std::string line_of(const Event& event);

/// What a pose tells that the one before did not, if there was one: force on or off, a fault or its end.
/// `noticed_at_periods`: of the fault that the device is in, where that is known better than by the pose.
std::vector<Event> events_between(const std::optional<Pose>& before, const Pose& now,
                                  std::optional<std::int64_t> noticed_at_periods);

/// "wall_stiffness_N_per_m = 600.0, was 800.0", one for each parameter that differs; `whose` stands behind it.
std::vector<Event> events_of_change(const protocol::ParameterSet& before, const protocol::ParameterSet& now,
                                    std::optional<std::int64_t> at_periods, std::string_view whose = {});

/// The newest events, each under its number since the log began.
class EventLog {
 public:
  static constexpr std::size_t kept_maximum = 5000;

  void add(Event event);
  void add(std::vector<Event> events);
  std::uint64_t begin() const { return end_ - events_.size(); }
  std::uint64_t end() const { return end_; }
  /// `number` from begin() on, before end().
  const Event& operator[](std::uint64_t number) const { return events_[number - begin()]; }

 private:
  std::deque<Event> events_;
  std::uint64_t end_ = 0;
};

}  // namespace inkwell::device
