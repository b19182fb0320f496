// A plotted signal, which is a device signal or the result of a formula.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "host/companion/window/scope/formula.hpp"
#include "protocol/signals.hpp"

namespace inkwell::window {

class ScopeSignal {
 public:
  ScopeSignal(protocol::Signal signal) : signal_(signal) {}
  explicit ScopeSignal(Formula formula) : formula_(std::make_shared<const Formula>(std::move(formula))) {}

  /// Returns null for a device signal.
  const Formula* formula() const { return formula_.get(); }
  /// Requires a device signal.
  protocol::Signal of_device() const { return signal_; }

  std::string_view name() const { return formula_ ? std::string_view(formula_->name) : info(signal_).name; }
  std::string_view unit() const;
  std::string_view help() const {
    return formula_ ? std::string_view(formula_->text) : std::string_view(info(signal_).help);
  }
  /// Returns the device signals that this signal needs.
  std::vector<protocol::Signal> inputs() const;

  bool operator==(const ScopeSignal& other) const;

 private:
  protocol::Signal signal_{};
  std::shared_ptr<const Formula> formula_;
};

/// Returns true for a setpoint, such as a current reference. Setpoints are drawn in front of measured signals.
bool is_reference(const ScopeSignal& signal);
/// Returns the indices of the signals in drawing order.
std::vector<std::size_t> drawing_order(const std::vector<ScopeSignal>& signals);

/// Related signals with a common title.
struct SignalGroup {
  std::string_view title;
  std::vector<protocol::Signal> signals;
};
/// Returns the streamable signals in groups. Each word of the search must occur in the name, help text, unit or group
/// title of a signal. An empty search matches every signal.
std::vector<SignalGroup> signal_groups(std::string_view search);

}  // namespace inkwell::window
