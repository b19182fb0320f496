// Steps that several guides use.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "host/client/guides/step.hpp"

namespace inkwell::guides {

inline constexpr double user_limit_s = 120;  ///< limit for one step of the user, in board time

/// "the waist", "the shoulder", "the elbow".
const char* joint_name(int joint);

/// Returns the forward direction of a joint for the user, for example "to the right".
std::string forward_direction(const protocol::ParameterSet& parameters, int joint);

/// Waits until the stylus rests in the inkwell and the encoders are referenced.
class RestInInkwell final : public Step {
 public:
  /// `reports` is true if the findings contain the pose in the inkwell.
  RestInInkwell(std::shared_ptr<Findings> findings, bool reports) : findings_(std::move(findings)), reports_(reports) {}
  std::string title() const override { return "Stylus in the inkwell"; }
  std::string text() const override {
    return "Put the stylus into the inkwell and let it rest there. The force is off and nothing moves by itself.";
  }
  UserTask user_task() const override { return {UserTask::Kind::rest_in_inkwell, 0}; }
  void begin(const Observation& now, DevicePort&) override { since_.start(*now.pose); }
  bool advance(const Observation& now, DevicePort& port) override;
  std::vector<Check> checks() const override { return checks_; }

 private:
  std::shared_ptr<Findings> findings_;
  bool reports_;
  Stopwatch since_;
  std::optional<Stopwatch> resting_;
  std::vector<Check> checks_;
};

/// `true` for each reversed encoder, or std::nullopt if the encoder was not checked.
using ReversedEncoders = std::array<std::optional<bool>, 3>;

/// The user turns one joint forward, and the encoder of the joint must count up.
class TurnJointForward final : public Step {
 public:
  TurnJointForward(std::shared_ptr<Findings> findings, std::shared_ptr<ReversedEncoders> reversed, int joint)
      : findings_(std::move(findings)), reversed_(std::move(reversed)), joint_(joint) {}
  std::string title() const override;
  std::string text() const override;
  UserTask user_task() const override { return {UserTask::Kind::turn_joint_forward, joint_}; }
  void begin(const Observation& now, DevicePort&) override;
  bool advance(const Observation& now, DevicePort& port) override;
  std::vector<Check> checks() const override;

 private:
  std::shared_ptr<Findings> findings_;
  std::shared_ptr<ReversedEncoders> reversed_;
  int joint_;
  std::string direction_;
  std::array<double, 3> began_rad_{};
  double turned_rad_ = 0;
  Stopwatch since_;
};

}  // namespace inkwell::guides
