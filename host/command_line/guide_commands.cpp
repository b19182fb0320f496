// Guides on a terminal: the text of each step, a prompt before anything moves, the numbers as they are measured.
#include "commands.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include <device/session.hpp>
#include <guides/guides.hpp>
#include <guides/session_port.hpp>
#include <guides/simulated_user.hpp>

#include "help.hpp"
#include "interrupt.hpp"

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using guides::Guide;
using guides::Phase;

constexpr auto connection_limit = 15s, silence_limit = 5s, transaction_limit = 5s;

struct GuideOptions {
  bool yes = false;
  bool apply = false;

  void add_to(CLI::App& command) {
    command.add_flag("--yes", yes, "Agree to every step beforehand: motors get current without a question");
    command.add_flag("--apply", apply, "Send the proposed changes to the device without a question");
  }
};

/// A line that the user typed, if there is one; none while he has not. Throws UsageError when no one can type.
std::optional<std::string> typed_line() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, 0) <= 0) return std::nullopt;
  std::string line;
  for (char c = 0;;) {
    if (read(STDIN_FILENO, &c, 1) != 1)
      throw UsageError("This step needs your consent, but nothing can be typed here. Give --yes to agree beforehand.");
    if (c == '\n') return line;
    line += c;
  }
}

/// Where a guide stands, on standard error, so that --json stays clean.
class Display {
 public:
  void show(const Guide& guide, bool asks) {
    if (guide.step_index() != shown_step_) {
      end_line();
      shown_step_ = guide.step_index();
      shown_text_.clear();
      asked_ = false;
      fmt::print(stderr, "[{}/{}] {}\n", shown_step_ + 1, guide.step_count(), guide.step().title());
    }
    if (const std::string text = guide.step().text(); text != shown_text_) {
      end_line();
      shown_text_ = text;
      fmt::print(stderr, "{}\n", text);
    }
    if (asks && !asked_ && guide.phase() == Phase::asks)
      fmt::print(stderr, "Press Enter to agree, Ctrl+C to cancel.\n");
    if (asks) asked_ = true;
    if (is_terminal_ && guide.phase() == Phase::working) live(guide);
    std::fflush(stderr);
  }
  void end_line() {
    if (line_is_open_) fmt::print(stderr, "\n");
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
    fmt::print(stderr, "\r\x1b[K{:.160}", line);
    line_is_open_ = true;
  }

  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  std::size_t shown_step_ = SIZE_MAX;
  std::string shown_text_;
  bool asked_ = false, line_is_open_ = false;
  Clock::time_point drawn_at_{};
};

/// The device that the options name, kept by a session, with its scope's frames on the way to a guide.
class Bench {
 public:
  explicit Bench(const DeviceOptions& options) {
    protocol::ParameterSet arm = protocol::default_parameters();
    std::vector<device::ParameterChange> changes;
    if (!options.arm.empty()) changes = arm_parameters(options.arm);
    for (const auto& [parameter, value] : changes) arm[parameter] = value;
    if (options.is_virtual) {
      board_ = std::make_unique<device::VirtualBoard>(options.virtual_board(device::SimulationMode::fast, true));
      user_.emplace(board_->control(), arm);
      session_ = std::make_unique<device::Session>([this] { return board_->find(); });
    } else {
      const auto endpoint = find_one(options);  // complains at once if there is none
      session_ = std::make_unique<device::Session>([endpoint] { return endpoint; });
    }
    session_->on_scope([this](const device::ScopeSamples& samples) {
      const std::lock_guard lock(mutex_);
      frames_.push_back(samples);
    });
    wait_for_device();
    if (!changes.empty()) session_->set_parameters(changes);
    const auto give_up_at = Clock::now() + transaction_limit;
    const auto holds_arm = [&] {
      const auto held = session_->parameters();
      return held &&
             std::ranges::all_of(changes, [&](const auto& change) { return (*held)[change.first] == change.second; });
    };
    while (!holds_arm()) {
      if (Clock::now() > give_up_at)
        throw device::Error(session_->refusal().value_or("The device did not take the arm's parameters."));
      std::this_thread::sleep_for(5ms);
    }
  }

  device::Session& session() { return *session_; }
  std::vector<device::ScopeSamples> take_frames() {
    const std::lock_guard lock(mutex_);
    return std::exchange(frames_, {});
  }
  void carry_out(const guides::UserTask& task) {
    if (user_) user_->advance(task);
  }

 private:
  void wait_for_device() {
    const auto give_up_at = Clock::now() + connection_limit;
    for (;;) {
      const auto status = session_->status();
      if (status.connection == device::Connection::connected && session_->newest_pose()) return;
      const bool hopeless = status.connection == device::Connection::incompatible ||
                            status.connection == device::Connection::no_permission;
      if (hopeless || Clock::now() > give_up_at) throw device::Error(status.message);
      std::this_thread::sleep_for(5ms);
    }
  }

  std::unique_ptr<device::VirtualBoard> board_;
  std::optional<guides::SimulatedUser> user_;
  std::mutex mutex_;
  std::vector<device::ScopeSamples> frames_;
  std::unique_ptr<device::Session> session_;  ///< last: its threads use what is above
};

class GuideRun {
 public:
  /// Ctrl+C cancels the guide, which leaves the motors off, instead of ending the program in the middle.
  GuideRun(Bench& bench, Guide& guide, const GuideOptions& options, bool json, const InterruptGuard& interrupt)
      : bench_(bench), guide_(guide), options_(options), json_(json), interrupt_(interrupt), port_(bench.session()) {}

  void run() {
    fmt::print(stderr, "{}\n", guide_.title());
    while (!guide_.is_over()) {
      round();
      if (guide_.is_over()) break;
      display_.show(guide_, guide_.takes_confirmation() && !options_.yes);
      if (guide_.takes_confirmation() && agrees()) guide_.confirm();
      if (guide_.phase() == Phase::working) bench_.carry_out(guide_.step().user_task());
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
    if (interrupt_.was_asked_to_end()) guide_.cancel(port_);
    for (const auto& samples : bench_.take_frames()) guide_.receive(samples);
    const auto now = guides::observe(bench_.session());
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

  /// --yes agrees to what the device will do; that the user's own part is done only he can say, or button 1.
  bool agrees() {
    if (guide_.phase() == Phase::asks && options_.yes) return true;
    if (guide_.phase() == Phase::working && (options_.yes || isatty(STDIN_FILENO) != 1)) return false;
    return typed_line().has_value();
  }

  /// Until the device holds what the guide put back or applied.
  void settle() {
    const auto give_up_at = Clock::now() + transaction_limit;
    while (!guide_.at_rest() && Clock::now() < give_up_at && guides::observe(bench_.session()).connected) round();
  }

  bool wants_to_apply() {
    if (options_.apply) return true;
    if (json_ || options_.yes || isatty(STDIN_FILENO) != 1) return false;
    for (const auto& proposal : guide_.findings().proposals) print(proposal, stderr);
    fmt::print(stderr, "Apply these changes? Type yes: ");
    std::fflush(stderr);
    for (;;) {
      if (const auto line = typed_line()) return *line == "yes" || *line == "y";
      round();
      if (interrupt_.was_asked_to_end()) return false;
    }
  }

 public:
  static void print(const guides::Proposal& proposal, std::FILE* file) {
    fmt::print(file, "  {} = {} (now {}): {}\n", info(proposal.parameter).name, proposal.proposed, proposal.held,
               proposal.reason);
  }

 private:
  Bench& bench_;
  Guide& guide_;
  const GuideOptions& options_;
  bool json_;
  const InterruptGuard& interrupt_;
  guides::SessionPort port_;
  Display display_;
  std::uint32_t sequence_ = 0;
  Clock::time_point heard_at_ = Clock::now();
};

void print_result(const Guide& guide) {
  for (const auto& sentence : guide.findings().sentences) fmt::print("{}\n", sentence);
  if (guide.phase() != Phase::finished) return;
  if (guide.findings().proposals.empty()) {
    fmt::print("Nothing needs to change.\n");
    return;
  }
  fmt::print("{}\n", guide.applied() == guides::Applied::yes ? "Applied:" : "Proposed, not applied (--apply does it):");
  for (const auto& proposal : guide.findings().proposals) GuideRun::print(proposal, stdout);
}

int run_guides(const DeviceOptions& options, const GuideOptions& guide_options, std::vector<Guide> all) {
  const InterruptGuard interrupt;
  Bench bench(options);
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::string failure;
  for (Guide& guide : all) {
    GuideRun(bench, guide, guide_options, options.json, interrupt).run();
    if (options.json)
      results.push_back(to_json(guide));
    else
      print_result(guide);
    if (guide.phase() != Phase::finished) failure = guide.outcome();
    if (guide.applied() == guides::Applied::refused) failure = guide.refusal();
    if (guide.applied() == guides::Applied::sent)
      failure = "The device did not confirm the changes. Read them back with `inkwell parameters`.";
    if (!failure.empty()) break;
  }
  if (options.json) fmt::print("{}\n", (all.size() == 1 ? results[0] : results).dump(2));
  std::fflush(stdout);
  if (!failure.empty()) throw device::Error(failure);
  return 0;
}

guides::AngleRange parse_range(const std::string& text) {
  guides::AngleRange range{};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &range.minimum_rad, &range.maximum_rad, &rest) != 2 ||
      !(range.minimum_rad < range.maximum_rad))
    throw UsageError(
        fmt::format("`{}` is no range. Give the angles of both stops in radians, the lower first, for example "
                    "-2.455:2.455.",
                    text));
  return range;
}

}  // namespace

void add_calibrate_command(CLI::App& program, const DeviceOptions& options, Action& action) {
  struct Settings : GuideOptions {
    std::string what = "all";
    std::string trust = "limits";
    std::array<std::string, 3> range;
    bool quadratic = false;
  };
  const auto settings = std::make_shared<Settings>();
  auto* command =
      program.add_subcommand("calibrate",
                             "Guides through the calibration: inkwell, joint stops, potentiometers of the gimbal\n"
                             "You move the arm and press button 1; with --virtual a simulated hand does.");
  command->add_option("WHAT", settings->what, "What to calibrate")
      ->check(CLI::IsMember({"inkwell", "stops", "pots", "all"}))
      ->capture_default_str();
  command->add_option("--trust", settings->trust, "What is right when the stops lie elsewhere than described")
      ->check(CLI::IsMember({"limits", "encoders"}))
      ->capture_default_str();
  const char* names[] = {"--yaw-range", "--pitch-range", "--roll-range"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    command->add_option(names[axis], settings->range[axis], "MINIMUM:MAXIMUM, the angles of its stops in radians")
        ->type_name("RANGE");
  command->add_flag("--quadratic", settings->quadratic,
                    "Fit the potentiometers' square term, with a third point in the middle");
  settings->add_to(*command);
  add_examples(*command,
               "inkwell calibrate\n"
               "inkwell calibrate pots --roll-range -2.58:2.58 --apply\n"
               "inkwell calibrate all --virtual --yes --json");
  command->callback([&options, &action, settings] {
    action = [&options, settings] {
      guides::PotentiometerOptions pots;
      pots.quadratic = settings->quadratic;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!settings->range[axis].empty()) pots.range[axis] = parse_range(settings->range[axis]);
      std::vector<Guide> all;
      const auto wanted = [&](const char* what) { return settings->what == what || settings->what == "all"; };
      if (wanted("inkwell")) all.push_back(guides::inkwell_guide());
      if (wanted("stops"))
        all.push_back(guides::stops_guide(settings->trust == "limits" ? guides::StopsTrust::limits
                                                                      : guides::StopsTrust::encoders));
      if (wanted("pots")) all.push_back(guides::potentiometer_guide(pots));
      return run_guides(options, *settings, std::move(all));
    };
  });
}

void add_tune_command(CLI::App& program, const DeviceOptions& options, Action& action) {
  struct Settings : GuideOptions {
    guides::CurrentLoopOptions loop;
    int motor = 0;
  };
  const auto settings = std::make_shared<Settings>();
  auto* command = program.add_subcommand("tune", "Guides that find parameters by measuring");
  command->require_subcommand(1);
  add_examples(*command, "inkwell tune current-loop");
  auto* loop = command->add_subcommand(
      "current-loop",
      "Measures the motors' resistance and inductance and suggests gains of the current loops\n"
      "Pulses of voltage go through the motors, and steps of current try the gains. The arm may twitch.");
  loop->add_option("--motor", settings->motor, "This motor only, 1 to 3; all three unless given")
      ->type_name("NUMBER")
      ->check(CLI::Range(1, 3));
  loop->add_option("--bandwidth", settings->loop.bandwidth_Hz,
                   fmt::format("Bandwidth of the current loops, {} to {} Hz", guides::bandwidth_minimum_Hz,
                               guides::bandwidth_maximum_Hz))
      ->type_name("HZ")
      ->check(CLI::Range(guides::bandwidth_minimum_Hz, guides::bandwidth_maximum_Hz))
      ->capture_default_str();
  settings->add_to(*loop);
  add_examples(*loop,
               "inkwell tune current-loop\n"
               "inkwell tune current-loop --motor 2 --bandwidth 1500 --yes --apply");
  loop->callback([&options, &action, settings] {
    action = [&options, settings] {
      if (settings->motor != 0) settings->loop.motors = {settings->motor};
      std::vector<Guide> all;
      all.push_back(guides::current_loop_guide(settings->loop));
      return run_guides(options, *settings, std::move(all));
    };
  });
}

void add_check_command(CLI::App& program, const DeviceOptions& options, Action& action) {
  const auto settings = std::make_shared<GuideOptions>();
  auto* command = program.add_subcommand("check", "Guides that look whether the arm is wired and described as it is");
  command->require_subcommand(1);
  add_examples(*command, "inkwell check connection\ninkwell check directions");
  const auto add = [&](const char* name, const char* help, Guide (*make)()) {
    auto* check = command->add_subcommand(name, help);
    settings->add_to(*check);
    add_examples(*check, fmt::format("inkwell check {0}\ninkwell check {0} --virtual --yes --json", name));
    check->callback([&options, &action, settings, make] {
      action = [&options, settings, make] {
        std::vector<Guide> all;
        all.push_back(make());
        return run_guides(options, *settings, std::move(all));
      };
    });
  };
  add("connection", "First connection: versions, supply, inkwell, encoders, buttons", guides::first_connection_guide);
  add("directions", "Each encoder while you turn its joint, then each motor with a pulse of current",
      guides::direction_guide);
}

}  // namespace inkwell::command_line
