// Environment of the USB core in these tests: time, interrupt line, log.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "boards/stm32f405/core/rules.hpp"

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
  /// Runs the next event if its time is at most `end`.
  bool run_one(Ticks end) {
    if (events_.empty() || events_.begin()->first.first > end) return false;
    auto node = events_.extract(events_.begin());
    now_ = std::max(now_, node.key().first);
    node.mapped()();
    return true;
  }
  void run_until(Ticks end) {
    while (run_one(end)) {
    }
    pass_until(end);
  }
  void pass_until(Ticks end) { now_ = std::max(now_, end); }

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

class FakeLog final : public virtual_board::UnmodelledLog, public virtual_board::RuleKeeper {
 public:
  void note(const std::string& peripheral, std::uint32_t, bool, std::uint32_t) override {
    sentences.push_back(peripheral);
  }
  void violate(virtual_board::Rule rule, const std::string&) override {
    sentences.emplace_back(virtual_board::info(rule).done);
    broken.push_back(rule);
  }
  bool has(const std::string& part) const {
    for (const std::string& sentence : sentences)
      if (sentence.find(part) != std::string::npos) return true;
    return false;
  }
  std::vector<std::string> sentences;
  std::vector<virtual_board::Rule> broken;
};

/// Clocks and pins with the settings of a correct driver.
class FakeChipState final : public virtual_board::ChipState {
 public:
  std::uint32_t hclk_Hz() const override { return hclk; }
  std::uint32_t usb_Hz() const override { return usb; }
  bool has_function(char port, unsigned pin, unsigned alternate_function) const override {
    return connected && port == 'A' && (pin == 11 || pin == 12) && alternate_function == 10;
  }
  std::uint32_t hclk = 168'000'000, usb = 48'000'000;
  bool connected = true;
};

class FakeTriggers final : public virtual_board::TriggerLines {
 public:
  void usb_start_of_frame() override { ++starts_of_frame; }
  unsigned starts_of_frame = 0;
};

}  // namespace inkwell::virtual_usb_test
