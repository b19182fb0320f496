// What a plot draws: a signal of the device, or one that a formula makes of them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>
#include <scope/formula.hpp>

namespace inkwell::window {

class ScopeSignal {
 public:
  ScopeSignal(protocol::Signal signal) : signal_(signal) {}
  explicit ScopeSignal(Formula formula) : formula_(std::make_shared<const Formula>(std::move(formula))) {}

  /// Null for a signal of the device.
  const Formula* formula() const { return formula_.get(); }
  /// Of a signal of the device only.
  protocol::Signal of_device() const { return signal_; }

  std::string_view name() const { return formula_ ? std::string_view(formula_->name) : info(signal_).name; }
  std::string_view unit() const;
  std::string_view help() const { return formula_ ? std::string_view(formula_->text) : info(signal_).help; }
  /// What has to be streamed for it.
  std::vector<protocol::Signal> inputs() const;

  bool operator==(const ScopeSignal& other) const;

 private:
  protocol::Signal signal_{};
  std::shared_ptr<const Formula> formula_;
};

/// Whether it is what others are to follow, such as a current's reference: it is drawn above their noise.
bool is_reference(const ScopeSignal& signal);
/// The places of the signals in the order in which they are drawn.
std::vector<std::size_t> drawing_order(const std::vector<ScopeSignal>& signals);

/// Signals that belong together, under a title.
struct SignalGroup {
  std::string_view title;
  std::vector<protocol::Signal> signals;
};
/// All that the device can stream, in groups; of them those in whose name or help, or in whose group's title, each word
/// of the search stands. An empty search finds all.
std::vector<SignalGroup> signal_groups(std::string_view search);

}  // namespace inkwell::window
