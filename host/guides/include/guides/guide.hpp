// A guide leads the user through steps: it says what will happen before anything moves, measures, and ends with a
// result and proposed changes.
//
//   phase     | left by
//   ----------+------------------------------------------------------------------------------
//   asks      | confirm -> working
//   working   | the step is done -> asks or working (next step), finished (last step)
//   finished  | apply sends the proposals as one transaction
//   cancelled | cancel, in any phase before
//   failed    | the device went away, reported a fault or showed something impossible
//
// Whatever ends it, force and test pulses are off and temporary parameters are put back.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <guides/step.hpp>

namespace inkwell::guides {

enum class Phase : std::uint8_t { asks, working, finished, cancelled, failed };

enum class Applied : std::uint8_t { no, sent, yes, refused };

/// The steps of a guide, and what they write their findings into.
struct Plan {
  std::vector<std::unique_ptr<Step>> steps;
  std::shared_ptr<Findings> findings = std::make_shared<Findings>();
};

class Guide {
 public:
  Guide(std::string name, std::string title, Plan plan);

  /// Call again and again, with the newest of the device, from one thread.
  void advance(const Observation& now, DevicePort& port);
  void receive(const device::ScopeSamples& samples);

  /// Agrees to what the step will do, or says that the user's part of it is done.
  void confirm();
  void cancel(DevicePort& port);
  /// Sends every proposal as one transaction. Only when finished; the device's answer shows in applied().
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
  /// How it ended, in a sentence; empty before.
  const std::string& outcome() const { return outcome_; }
  const Findings& findings() const { return *findings_; }
  Applied applied() const { return applied_; }
  /// False while the device has yet to take a transaction of this guide.
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
  std::shared_ptr<Findings> findings_;  ///< the steps write into it
  Phase phase_ = Phase::asks;
  std::size_t index_ = 0;
  bool agreed_ = false, begun_ = false, made_safe_ = false;
  std::string outcome_, refusal_;
  Applied applied_ = Applied::no;
  std::vector<device::ParameterChange> put_back_;  ///< sent and not yet seen on the device
  std::uint64_t seen_revision_ = 0;
};

/// Everything a program wants to know of a guide that is over.
nlohmann::ordered_json to_json(const Guide& guide);

}  // namespace inkwell::guides
