#include "host/companion/command_line/guide_run.hpp"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "host/client/command_line/interrupt.hpp"
#include "host/client/guides/session_port.hpp"
#include "host/client/local/interruption.hpp"
#include "host/client/local/output.hpp"

#include "host/companion/command_line/guided_device.hpp"
#include "host/companion/command_line/store_commands.hpp"

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using guides::Guide;
using guides::Phase;

constexpr auto silence_limit = 5s;

/// Returns the typed line, or an empty value if no input is available. Throws UsageError if standard input is closed.
std::optional<std::string> typed_line() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, 0) <= 0) return std::nullopt;
  std::string line;
  for (char c = 0;;) {
    if (local::repeat_interrupted([&] { return read(STDIN_FILENO, &c, 1); }) != 1)
      throw UsageError(
          "This step needs your consent, but standard input cannot be read. Add --yes to agree in advance.");
    if (c == '\n') return line;
    line += c;
  }
}

/// Prints the guide's state to standard error, because standard output may contain the --json output.
class Display {
 public:
  void show(const Guide& guide, bool prompts) {
    if (guide.step_index() != shown_step_) {
      end_line();
      shown_step_ = guide.step_index();
      shown_text_.clear();
      has_prompted_ = false;
      local::print_error("[{}/{}] {}\n", shown_step_ + 1, guide.step_count(), guide.step().title());
    }
    if (const std::string text = guide.step().text(); text != shown_text_) {
      end_line();
      shown_text_ = text;
      local::print_error("{}\n", text);
    }
    if (prompts && !has_prompted_ && guide.phase() == Phase::awaits_consent)
      local::print_error("Press Enter to agree, Ctrl+C to cancel.\n");
    if (prompts) has_prompted_ = true;
    if (is_terminal_ && guide.phase() == Phase::working) live(guide);
  }
  void end_line() {
    if (line_is_open_) local::print_error("\n");
    line_is_open_ = false;
  }

 private:
  void live(const Guide& guide) {
    if (Clock::now() - drawn_at_ < 100ms) return;
    drawn_at_ = Clock::now();
    std::string line;
    for (const auto& check : guide.step().checks())
      line += fmt::format(
          "{}{} {}{}", line.empty() ? "" : "; ", check.name, guides::measured_text(check),
          check.expected.empty() ? "" : fmt::format(" ({}: {})", check.passed ? "ok" : "expected", check.expected));
    local::print_error("\r\x1b[K{:.160}", line);
    line_is_open_ = true;
  }

  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  std::size_t shown_step_ = SIZE_MAX;
  std::string shown_text_;
  bool has_prompted_ = false, line_is_open_ = false;
  Clock::time_point drawn_at_{};
};

class GuideRun {
 public:
  /// Ctrl+C cancels the guide instead of terminating the program.
  GuideRun(GuidedDevice& device, Guide& guide, const Consent& options, bool json, const InterruptGuard& interrupt)
      : device_(device),
        guide_(guide),
        consent_(options),
        json_(json),
        interrupt_(interrupt),
        port_(device.session()) {}

  void run() {
    local::print_error("{}\n", guide_.title());
    while (!guide_.is_over()) {
      round();
      if (guide_.is_over()) break;
      display_.show(guide_, guide_.takes_confirmation() && !consent_.yes);
      if (guide_.takes_confirmation() && agrees()) guide_.confirm();
      if (guide_.phase() == Phase::working) device_.carry_out(guide_.step().user_task());
    }
    display_.end_line();
    settle();
    if (guide_.phase() == Phase::finished && !guide_.findings().proposals.empty() && wants_to_apply()) {
      guide_.apply(port_);
      settle();
    }
  }

 private:
  void round() {
    if (interrupt_.is_interrupted()) guide_.cancel(port_);
    for (const auto& samples : device_.take_frames()) guide_.receive(samples);
    const auto now = guides::observe(device_.session());
    guide_.advance(now, port_);
    if (now.pose && now.pose->sequence != sequence_) {
      sequence_ = now.pose->sequence;
      heard_at_ = Clock::now();
    }
    if (now.connected && Clock::now() - heard_at_ > silence_limit) {
      guide_.cancel(port_);
      throw device::Error(
          "The device is silent. Reset the board, or let a paused virtual board run, and start the guide again.");
    }
    std::this_thread::sleep_for(1ms);
  }

  /// --yes confirms the actions of the device, but not the manual tasks. The user confirms each manual task with Enter
  /// or button 1.
  bool agrees() {
    if (guide_.phase() == Phase::awaits_consent && consent_.yes) return true;
    if (guide_.phase() == Phase::working && (consent_.yes || isatty(STDIN_FILENO) != 1)) return false;
    return typed_line().has_value();
  }

  /// Waits until the device has confirmed the guide's parameter changes.
  void settle() {
    auto limit = transaction_limit();
    while (!guide_.at_rest() && !limit.update_time(device_.session().newest_pose()) &&
           guides::observe(device_.session()).connected)
      round();
  }

  bool wants_to_apply() {
    if (consent_.apply) return true;
    if (json_ || consent_.yes || isatty(STDIN_FILENO) != 1) return false;
    for (const auto& proposal : guide_.findings().proposals) local::print_error(text_of(proposal));
    local::print_error("Apply these changes? Type yes: ");
    for (;;) {
      if (const auto line = typed_line()) return *line == "yes" || *line == "y";
      round();
      if (interrupt_.is_interrupted()) return false;
    }
  }

 public:
  static std::string text_of(const guides::Proposal& proposal) {
    return fmt::format("  {} = {} (now {}): {}\n", info(proposal.parameter).name, proposal.proposed, proposal.held,
                       proposal.reason);
  }

 private:
  GuidedDevice& device_;
  Guide& guide_;
  const Consent& consent_;
  bool json_;
  const InterruptGuard& interrupt_;
  guides::SessionPort port_;
  Display display_;
  std::int64_t sequence_ = 0;
  Clock::time_point heard_at_ = Clock::now();
};

/// Returns true if the user wants to store the changes. Without a terminal, prints the command that stores the changes.
bool ask_to_store(const DeviceOptions& options, const Consent& consent, const InterruptGuard& interrupt) {
  if (consent.store) return true;
  if (options.json || consent.yes || isatty(STDIN_FILENO) != 1) {
    if (!options.is_virtual)  // a virtual board exits before another command could reach it
      local::print_error(
          "The changes are lost when the board loses power. Run `inkwell parameters store` to store them.\n");
    return false;
  }
  local::print_error("Store the changes on the board, so that they survive power loss? Type yes: ");
  for (;;) {
    if (const auto line = typed_line()) return *line == "yes" || *line == "y";
    if (interrupt.is_interrupted()) return false;
    std::this_thread::sleep_for(1ms);
  }
}

void print_result(const Guide& guide) {
  for (const auto& sentence : guide.findings().sentences) fmt::print("{}\n", sentence);
  if (guide.phase() != Phase::finished) return;
  if (guide.findings().proposals.empty()) {
    fmt::print("Nothing needs to change.\n");
    return;
  }
  fmt::print("{}\n", guide.applied() == guides::Applied::yes ? "Applied:" : "Proposed, not applied (add --apply):");
  for (const auto& proposal : guide.findings().proposals) fmt::print("{}", GuideRun::text_of(proposal));
}

}  // namespace

void Consent::add_to(CLI::App& command) {
  command.add_flag("--yes", yes, "Agree to all steps in advance: motors are energized without asking");
  command.add_flag("--apply", apply, "Apply the proposed changes without asking");
  command.add_flag("--store", store, "Store the parameters on the board at the end, so that they survive power loss");
}

int run_guides(const DeviceOptions& options, const Consent& consent, const std::vector<const guides::Offer*>& offers,
               const guides::Choices& choices) {
  const InterruptGuard interrupt;
  GuidedDevice device(options);
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::string failure;
  bool has_changed = false;
  for (const guides::Offer* offer : offers) {
    Guide guide = offer->start(choices);
    GuideRun(device, guide, consent, options.json, interrupt).run();
    if (options.json)
      results.push_back(to_json(guide));
    else
      print_result(guide);
    has_changed |= guide.applied() == guides::Applied::yes;
    if (guide.phase() != Phase::finished) failure = guide.outcome();
    if (guide.applied() == guides::Applied::refused) failure = guide.refusal();
    if (guide.applied() == guides::Applied::sent)
      failure = "The device did not confirm the changes. Check the values with `inkwell parameters`.";
    if (!failure.empty()) break;
  }
  bool is_stored = false;
  if (failure.empty() && (has_changed || consent.store) && ask_to_store(options, consent, interrupt)) {
    try {
      device.store_parameters();
      is_stored = true;
      if (!options.json) fmt::print("The parameters are stored on the board and survive power loss.\n");
    } catch (const device::Error& error) {
      failure = error.what();
    }
  }
  for (auto& result : results) result["stored"] = is_stored;
  if (options.json) fmt::print("{}\n", (offers.size() == 1 ? results[0] : results).dump(2));
  local::flush_output();
  if (!failure.empty()) throw device::Error(failure);
  if (has_changed) print_unstored(options, is_stored);
  return 0;
}

}  // namespace inkwell::command_line
