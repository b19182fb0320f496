// A guide leads the user through steps. The guide announces each motion, measures, and finishes with a result and
// proposed changes.
//
//   `awaits_consent`  The user confirms the step, which leads to `working`.
//   `working`         A finished step leads to the next step, and the last step leads to `finished`.
//   `finished`        The user applies the proposals, which the guide sends as one transaction.
//   `cancelled`       The user has cancelled the guide in an earlier phase.
//   `failed`          The device disconnected, reported a fault or sent impossible values.
//
// At the end of a guide, force and test pulses are off and temporary parameters are restored.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/client/guides/step.hpp"

namespace inkwell::guides {

enum class Phase : std::uint8_t { awaits_consent, working, finished, cancelled, failed };

enum class Applied : std::uint8_t { no, sent, yes, refused };

/// The steps of a guide, and their common findings.
struct Plan {
  std::vector<std::unique_ptr<Step>> steps;
  std::shared_ptr<Findings> findings = std::make_shared<Findings>();
};

class Guide {
 public:
  Guide(std::string name, std::string title, Plan plan);

  /// Call repeatedly with the newest state of the device, from one thread.
  void advance(const Observation& now, DevicePort& port);
  void receive(const device::ScopeSamples& samples);

  /// Agrees to the step, or confirms that the user's part of the step is done.
  void confirm();
  void cancel(DevicePort& port);
  /// Sends all proposals as one transaction. Only allowed in the phase `finished`. The result of applied() shows the
  /// device's answer.
  void apply(DevicePort& port);

  const std::string& name() const { return name_; }
  const std::string& title() const { return title_; }
  Phase phase() const { return phase_; }
  bool is_over() const { return phase_ == Phase::finished || phase_ == Phase::cancelled || phase_ == Phase::failed; }
  std::size_t step_index() const { return index_; }
  std::size_t step_count() const { return steps_.size(); }
  const Step& step() const { return *steps_[index_ < steps_.size() ? index_ : steps_.size() - 1]; }
  bool takes_confirmation() const;
  double progress() const;  ///< of the whole guide, 0..1
  /// Sentence about the result; empty until the guide has finished.
  const std::string& outcome() const { return outcome_; }
  const Findings& findings() const { return *findings_; }
  Applied applied() const { return applied_; }
  /// Returns false while the device has not answered a transaction of this guide.
  bool at_rest() const { return applied_ != Applied::sent && put_back_.empty(); }
  const std::string& refusal() const { return refusal_; }

 private:
  void enter(std::size_t index);
  void run(const Observation& now, DevicePort& port);
  void leave_step(DevicePort& port);
  void end(Phase phase, std::string outcome, DevicePort& port);
  void watch_transaction(const Observation& now);
  static bool holds(const Observation& now, const std::vector<device::ParameterChange>& changes);
  std::vector<device::ParameterChange> proposed_changes() const;

  std::string name_, title_;
  std::vector<std::unique_ptr<Step>> steps_;
  std::shared_ptr<Findings> findings_;  ///< written by the steps
  Phase phase_ = Phase::awaits_consent;
  std::size_t index_ = 0;
  bool agreed_ = false, begun_ = false, made_safe_ = false;
  std::string outcome_, refusal_;
  Applied applied_ = Applied::no;
  std::vector<device::ParameterChange> put_back_;  ///< sent, but not yet confirmed by the device
  std::uint64_t seen_revision_ = 0;
};

/// Complete results of a finished guide.
nlohmann::ordered_json to_json(const Guide& guide);

}  // namespace inkwell::guides
