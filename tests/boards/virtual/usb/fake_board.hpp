// What stands around the USB core in these tests: time, the interrupt line, the log.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <chip/interfaces.hpp>

namespace inkwell::virtual_usb_test {

using virtual_board::Ticks;

class FakeScheduler final : public virtual_board::Scheduler {
 public:
  Ticks now() const override { return now_; }
  Id at(Ticks when, std::function<void()> action) override {
    const Id id = ++last_id_;
    events_.emplace(std::pair{std::max(when, now_), id}, std::move(action));
    return id;
  }
  void cancel(Id id) override {
    std::erase_if(events_, [&](const auto& event) { return event.first.second == id; });
  }
  /// Runs one event, if there is one until `end`.
  bool run_one(Ticks end) {
    if (events_.empty() || events_.begin()->first.first > end) return false;
    auto node = events_.extract(events_.begin());
    now_ = node.key().first;
    node.mapped()();
    return true;
  }
  void pass_until(Ticks end) { now_ = end; }

 private:
  Ticks now_ = 0;
  Id last_id_ = 0;
  std::map<std::pair<Ticks, Id>, std::function<void()>> events_;
};

class FakeInterrupts final : public virtual_board::InterruptController {
 public:
  void set_level(unsigned position, bool asserted) override {
    position_ = position;
    asserted_ = asserted;
  }
  bool asserted() const { return asserted_; }
  unsigned position() const { return position_; }

 private:
  unsigned position_ = 0;
  bool asserted_ = false;
};

class FakeLog final : public virtual_board::UnmodelledLog {
 public:
  void note(const std::string& peripheral, std::uint32_t, bool, std::uint32_t) override {
    sentences.push_back(peripheral);
  }
  bool has(const std::string& part) const {
    for (const std::string& sentence : sentences)
      if (sentence.find(part) != std::string::npos) return true;
    return false;
  }
  std::vector<std::string> sentences;
};

}  // namespace inkwell::virtual_usb_test
