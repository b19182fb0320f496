// Touches of objects and presses of buttons, with their board time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "host/contact/step.hpp"

namespace inkwell::feel {

struct Event {
  enum class Kind : std::uint8_t { touched, left, pressed, released };
  Kind kind = Kind::touched;
  int button = 0;     ///< of a press or release: 1 or 2
  double time_s = 0;  ///< board time
  /// Of a touch: its first contact. Of the other kinds: the newest contact, of the left object or of a touched object.
  /// Object 0: the tip touches no object.
  contact::Contact contact;
  double contact_time_s = 0;  ///< board time of the contact
};

/// Events from one writing thread to one reading thread at a time. No call waits or allocates memory.
class EventQueue {
 public:
  static constexpr std::size_t capacity = 1024;

  /// Writing thread. A full queue loses the event.
  void put(const Event& event);
  /// Reading thread: the oldest event, or nullopt.
  std::optional<Event> take();
  /// Events that were lost since the start.
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<Event, capacity> events_{};
  std::atomic<std::uint64_t> written_ = 0, read_ = 0, lost_ = 0;
};

/// Finds the events in the results of successive contact steps. No call waits or allocates memory.
class EventWatch {
 public:
  /// An object is left after this board time without contact, so that one touch is one event.
  static constexpr double leave_s = 0.005;

  /// `switches`: bits of protocol::Switch. Buttons that are pressed in the first call cause no event.
  void follow(const contact::Step& step, std::uint8_t switches, double time_s, EventQueue& queue);
  /// Ends all touches, for example because the force is off.
  void end_touches(double time_s, EventQueue& queue);

 private:
  struct Touch {
    double time_s = 0;  ///< of the newest contact
    contact::Contact contact;
  };
  void follow_buttons(std::uint8_t switches, double time_s, EventQueue& queue);

  std::array<Touch, 2 * contact::features_max> touches_{};
  std::size_t touch_count_ = 0;
  std::optional<std::uint8_t> switches_;
};

}  // namespace inkwell::feel
