#include "host/feel/events.hpp"

#include <algorithm>
#include <utility>

#include "protocol/reports.hpp"

namespace inkwell::feel {
namespace {

/// Above the rounding of times, and below a pose.
constexpr double rounding_s = 1e-6;

}  // namespace

void EventQueue::put(const Event& event) {
  const std::uint64_t written = written_.load(std::memory_order_relaxed);
  if (written - read_.load(std::memory_order_acquire) == capacity) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  events_[written % capacity] = event;
  written_.store(written + 1, std::memory_order_release);
}

std::optional<Event> EventQueue::take() {
  const std::uint64_t read = read_.load(std::memory_order_relaxed);
  if (read == written_.load(std::memory_order_acquire)) return std::nullopt;
  const Event event = events_[read % capacity];
  read_.store(read + 1, std::memory_order_release);
  return event;
}

void EventWatch::follow(const contact::Step& step, std::uint8_t switches, double time_s, EventQueue& queue) {
  const auto end = [&] { return touches_.begin() + static_cast<std::ptrdiff_t>(touch_count_); };
  for (std::size_t index = 0; index < step.contact_count; ++index) {
    const contact::Contact& contact = step.contacts[index];
    const auto touch =
        std::find_if(touches_.begin(), end(), [&](const Touch& each) { return each.contact.object == contact.object; });
    if (touch != end()) {
      *touch = {time_s, contact};
    } else if (touch_count_ < touches_.size()) {
      touches_[touch_count_++] = {time_s, contact};
      queue.put({Event::Kind::touched, 0, time_s, contact, time_s});
    }
  }
  std::size_t kept = 0;
  for (std::size_t index = 0; index < touch_count_; ++index) {
    const Touch touch = touches_[index];
    if (time_s - touch.time_s < leave_s - rounding_s)
      touches_[kept++] = touch;
    else
      queue.put({Event::Kind::left, 0, time_s, touch.contact, touch.time_s});
  }
  touch_count_ = kept;
  follow_buttons(switches, time_s, queue);
}

void EventWatch::follow_buttons(std::uint8_t switches, double time_s, EventQueue& queue) {
  const std::uint8_t before = std::exchange(switches_, switches).value_or(switches);
  const Touch touch = touch_count_ > 0 ? touches_[0] : Touch{};
  for (const auto& [number, button] : {std::pair{1, protocol::Switch::button_1}, {2, protocol::Switch::button_2}}) {
    const bool is_pressed = protocol::is_closed(switches, button);
    if (is_pressed == protocol::is_closed(before, button)) continue;
    queue.put({is_pressed ? Event::Kind::pressed : Event::Kind::released, number, time_s, touch.contact, touch.time_s});
  }
}

void EventWatch::end_touches(double time_s, EventQueue& queue) {
  for (std::size_t index = 0; index < touch_count_; ++index)
    queue.put({Event::Kind::left, 0, time_s, touches_[index].contact, touches_[index].time_s});
  touch_count_ = 0;
}

}  // namespace inkwell::feel
