#include "host/client/guides/guide.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/fault_text.hpp"
#include "host/client/device/parameter_file.hpp"

namespace inkwell::guides {
namespace {

const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::awaits_consent: return "asks";
    case Phase::working: return "working";
    case Phase::finished: return "finished";
    case Phase::cancelled: return "cancelled";
    case Phase::failed: return "failed";
  }
  return "";
}

/// Disabling the force also ends a test pulse.
void make_safe(DevicePort& port) { port.send(protocol::Command::disable_force); }

}  // namespace

std::string measured_text(const Check& check) {
  return fmt::format("{:.4g}{}{}", check.value, check.unit.empty() ? "" : " ", check.unit);
}

void Findings::propose(const protocol::ParameterSet& held, protocol::Parameter parameter, double value,
                       const std::string& reason) {
  const auto& row = info(parameter);
  const float proposed = static_cast<float>(row.kind == protocol::ParameterKind::real ? value : std::round(value));
  if (proposed == held[parameter]) return;
  device::check_value(parameter, proposed);
  proposals.push_back({parameter, held[parameter], proposed, reason});
}

Guide::Guide(std::string name, std::string title, Plan plan)
    : name_(std::move(name)),
      title_(std::move(title)),
      steps_(std::move(plan.steps)),
      findings_(std::move(plan.findings)) {
  enter(0);
}

void Guide::enter(std::size_t index) {
  index_ = index;
  begun_ = agreed_ = false;
  phase_ = steps_[index]->needs_consent() ? Phase::awaits_consent : Phase::working;
}

bool Guide::takes_confirmation() const {
  return phase_ == Phase::awaits_consent ? !agreed_ : phase_ == Phase::working && step().takes_confirmation();
}

double Guide::progress() const {
  if (phase_ == Phase::finished) return 1;
  return (static_cast<double>(index_) + (begun_ ? step().progress() : 0)) / static_cast<double>(steps_.size());
}

void Guide::confirm() {
  if (phase_ == Phase::awaits_consent) agreed_ = true;
  if (phase_ == Phase::working && step().takes_confirmation()) steps_[index_]->confirm();
}

void Guide::receive(const device::ScopeSamples& samples) {
  if (phase_ == Phase::working && begun_) steps_[index_]->receive(samples);
}

void Guide::advance(const Observation& now, DevicePort& port) {
  if (applied_ == Applied::sent && now.parameters_revision != seen_revision_) watch_transaction(now);
  seen_revision_ = now.parameters_revision;
  if (now.parameters && holds(now, put_back_)) put_back_.clear();
  if (is_over()) return;
  try {
    run(now, port);
  } catch (const device::Error& error) {
    end(Phase::failed, error.what(), port);
  }
}

void Guide::run(const Observation& now, DevicePort& port) {
  if (!now.connected && made_safe_) {
    const bool lent = begun_ && !step().to_put_back().empty();
    throw device::Disconnected(
        fmt::format("The device was disconnected in the step \"{}\". No proposal was applied.{} Connect the device "
                    "again and restart the guide.",
                    step().title(), lent ? " If the device kept its power, it still has the trial parameters." : ""));
  }
  if (!now.connected || !now.pose || !now.parameters) return;  // the connection is not complete
  if (now.pose->state == protocol::State::fault)
    throw device::Error("The device reports the fault " + device::fault_line(now.pose->fault));
  if (!made_safe_) {
    make_safe(port);
    made_safe_ = true;
  }
  if (phase_ == Phase::awaits_consent) {
    if (!agreed_) return;
    phase_ = Phase::working;
  }
  if (!begun_) {
    begun_ = true;
    steps_[index_]->begin(now, port);
  }
  if (!steps_[index_]->advance(now, port)) return;
  leave_step(port);
  if (index_ + 1 < steps_.size())
    enter(index_ + 1);
  else
    end(Phase::finished,
        findings_->proposals.empty() ? "Finished. There is nothing to change."
                                     : "Finished. The proposals can now be applied.",
        port);
}

void Guide::leave_step(DevicePort& port) {
  if (!begun_) return;
  begun_ = false;
  put_back_ = steps_[index_]->to_put_back();
  if (!put_back_.empty()) port.set_parameters(put_back_);
}

bool Guide::holds(const Observation& now, const std::vector<device::ParameterChange>& changes) {
  return std::ranges::all_of(changes,
                             [&](const auto& change) { return (*now.parameters)[change.first] == change.second; });
}

void Guide::end(Phase phase, std::string outcome, DevicePort& port) {
  // Without a device the commands have no effect. The firmware ends a pulse after at most half a second.
  make_safe(port);
  leave_step(port);
  port.select_signals({});
  phase_ = phase;
  outcome_ = std::move(outcome);
}

void Guide::cancel(DevicePort& port) {
  if (!is_over()) end(Phase::cancelled, "Cancelled. The motors are off and no proposal was applied.", port);
}

std::vector<device::ParameterChange> Guide::proposed_changes() const {
  std::vector<device::ParameterChange> changes;
  for (const auto& proposal : findings_->proposals) changes.emplace_back(proposal.parameter, proposal.proposed);
  return changes;
}

void Guide::apply(DevicePort& port) {
  if (phase_ != Phase::finished || findings_->proposals.empty() || applied_ == Applied::sent) return;
  put_back_.clear();  // the proposals overwrite the temporary values
  port.set_parameters(proposed_changes());
  applied_ = Applied::sent;
}

void Guide::watch_transaction(const Observation& now) {
  if (!now.parameters) return;
  if (holds(now, proposed_changes())) {
    applied_ = Applied::yes;
  } else if (now.refusal) {
    applied_ = Applied::refused;
    refusal_ = *now.refusal;
  }
}

nlohmann::ordered_json to_json(const Guide& guide) {
  nlohmann::ordered_json proposals = nlohmann::ordered_json::array();
  for (const auto& proposal : guide.findings().proposals)
    proposals.push_back({{"parameter", info(proposal.parameter).name},
                         {"held", proposal.held},
                         {"proposed", proposal.proposed},
                         {"unit", info(proposal.parameter).unit},
                         {"reason", proposal.reason}});
  nlohmann::ordered_json json{{"guide", guide.name()},      {"result", phase_name(guide.phase())},
                              {"outcome", guide.outcome()}, {"findings", guide.findings().sentences},
                              {"proposals", proposals},     {"applied", guide.applied() == Applied::yes}};
  if (!guide.refusal().empty()) json["refusal"] = guide.refusal();
  json.update(guide.findings().details);
  return json;
}

}  // namespace inkwell::guides
