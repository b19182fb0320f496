// Schedules the parts of the chip in board time.
//
// Each timed part (timer, converter, watchdog) sets two times. `due` is the time of the part's next internal step.
// `wake` is the time at which the step affects the processor (interrupt, reset, memory). The processor runs up to the
// earliest `wake`. Steps before the earliest `wake` are delayed until a part is accessed. The delayed steps are then
// executed in order of time. PWM edges therefore do not stop the processor.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <queue>
#include <unordered_set>
#include <vector>
#include "boards/stm32f405/core/interfaces.hpp"

#include "boards/stm32f405/core/clock.hpp"

namespace inkwell::virtual_board {

class TimedPart {
 public:
  virtual ~TimedPart() = default;
  /// Called when board time has reached the `due` time of this part. The function must set the next `due` time before
  /// it returns.
  virtual void step(Ticks now) = 0;
};

class Timeline {
 public:
  using Slot = std::size_t;
  static constexpr std::size_t capacity = 40;

  Timeline() {
    due_.fill(never);
    wake_.fill(never);
  }
  Slot add(TimedPart& part) {
    parts_[count_] = &part;
    return count_++;
  }
  void set(Slot slot, Ticks due, Ticks wake) {
    due_[slot] = due;
    wake_[slot] = wake;
    next_due_ = std::min(next_due_, due);
    if (wake < next_wake_) {
      next_wake_ = wake;
      wake_moved_forward_ = true;
    }
  }
  Ticks now() const { return now_; }
  /// Executes all steps that are due up to and including `until`.
  void catch_up(Ticks until) {
    while (next_due_ <= until) {
      std::size_t first = 0;
      for (std::size_t i = 1; i < count_; ++i)
        if (due_[i] < due_[first]) first = i;
      const Ticks due = due_[first];
      next_due_ = due;
      if (due > until) break;
      now_ = std::max(now_, due);
      due_[first] = never;
      parts_[first]->step(now_);
      next_due_ = 0;
    }
    now_ = std::max(now_, until);
  }
  Ticks next_wake() {
    next_wake_ = *std::min_element(wake_.begin(), wake_.begin() + static_cast<std::ptrdiff_t>(count_));
    wake_moved_forward_ = false;
    return next_wake_;
  }
  /// Returns true if a part has set a `wake` time that is earlier than the result of the last next_wake().
  bool wake_moved_forward() const { return wake_moved_forward_; }

 private:
  std::array<Ticks, capacity> due_{};
  std::array<Ticks, capacity> wake_{};
  std::array<TimedPart*, capacity> parts_{};
  std::size_t count_ = 0;
  Ticks now_ = 0;
  Ticks next_due_ = never;
  Ticks next_wake_ = never;
  bool wake_moved_forward_ = false;
};

/// Runs the events of the USB host and of the circuit.
class EventQueue final : public Scheduler, public TimedPart {
 public:
  explicit EventQueue(Timeline& timeline) : timeline_(timeline), slot_(timeline.add(*this)) {}
  Ticks now() const override { return timeline_.now(); }
  Id at(Ticks when, std::function<void()> action) override {
    const Id id = ++last_id_;
    queue_.push({std::max(when, timeline_.now()), id, std::move(action)});
    alive_.insert(id);
    announce();
    return id;
  }
  void cancel(Id id) override { alive_.erase(id); }
  void step(Ticks now) override {
    while (!queue_.empty() && queue_.top().when <= now) {
      // Moving the event out of the queue is safe, because the queue order depends only on time and number.
      Event event = std::move(const_cast<Event&>(queue_.top()));
      queue_.pop();
      if (alive_.erase(event.id) != 0) event.action();
    }
    announce();
  }

 private:
  struct Event {
    Ticks when;
    Id id;
    std::function<void()> action;
    bool operator<(const Event& other) const { return when != other.when ? when > other.when : id > other.id; }
  };
  void announce() {
    const Ticks next = queue_.empty() ? never : queue_.top().when;
    timeline_.set(slot_, next, next);
  }
  Timeline& timeline_;
  Timeline::Slot slot_;
  std::priority_queue<Event> queue_;
  std::unordered_set<Id> alive_;
  Id last_id_ = 0;
};

}  // namespace inkwell::virtual_board
