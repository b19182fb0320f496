#include "host/companion/command_line/commands.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/command_line/interrupt.hpp"
#include "host/client/recording/event_feed.hpp"
#include "host/client/recording/recorder.hpp"
#include "host/client/recording/signals.hpp"

#include "host/companion/command_line/force_switch.hpp"
#include "host/companion/command_line/mark_keys.hpp"
#include "host/companion/command_line/next_pose.hpp"
#include "host/companion/command_line/progress_bar.hpp"
#include "host/companion/command_line/recorded_span.hpp"

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using nlohmann::ordered_json;
using recording::RecorderStatus;

constexpr auto read_timeout = 20ms;
/// The limit excludes the time during which the program is suspended.
constexpr auto silence_limit = 2s;

struct RecordOptions {
  std::string file;
  std::string signals;
  bool all = false;
  double seconds = 0;  ///< 0: until interrupted
  bool mark_key = false;
  bool force = false;
  std::string name, note;
};

/// Reads the scope in a separate thread, so that a slow terminal does not cause lost samples. Stops after a given
/// number of control periods.
class RecordingThread {
 public:
  RecordingThread(device::Device& device, recording::Recorder& recorder, RecordedSpan& span)
      : device_(device), recorder_(recorder), span_(span) {
    thread_ = std::thread([this] { read(); });
  }
  ~RecordingThread() {
    stopping_ = true;
    thread_.join();
  }
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Returns true if all samples have arrived. Throws device::Error if the recording has failed.
  bool is_done() const {
    if (has_failed_) throw device::Error(failure_);
    return is_done_;
  }

 private:
  void read() {
    try {
      for (int silent_reads = 0; !stopping_ && !is_done_;) {
        auto samples = device_.read_scope(read_timeout);
        silent_reads = samples ? 0 : silent_reads + 1;
        // This limit is twice the pose limit, so that a silent board causes the error about missing poses.
        if (silent_reads * read_timeout > 2 * silence_limit)
          throw device::Error("The board sends poses but no samples. Start the recording again.");
        if (samples) take(*samples);
      }
    } catch (const device::Error& error) {
      failure_ = error.what();
      has_failed_ = true;
    }
  }
  void take(device::ScopeSamples& samples) {
    span_.cut(samples);
    recorder_.push(samples);
    is_done_ = span_.is_over();
  }

  device::Device& device_;
  recording::Recorder& recorder_;
  RecordedSpan& span_;
  std::atomic<bool> stopping_ = false, is_done_ = false;
  std::string failure_;  ///< written once, before has_failed_
  std::atomic<bool> has_failed_ = false;
  std::thread thread_;
};

std::vector<protocol::Signal> chosen_signals(const RecordOptions& options) {
  if (options.all) return recording::all_signals();
  if (options.signals.empty()) return recording::standard_signals();
  return recording::parse_signals(options.signals);
}

/// Returns the number of control periods, or 0 for no limit. Rounds times shorter than a period up to one period.
std::uint64_t periods_of(const RecordOptions& options) {
  if (options.seconds == 0) return 0;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(options.seconds * protocol::servo_rate_Hz + 0.5));
}

std::string progress_text(const RecorderStatus& status) {
  std::string text = fmt::format("Recording: {:.1f} s, {:.1f} MB, {} lost", status.duration_s,
                                 1e-6 * static_cast<double>(status.bytes), status.lost);
  if (status.marks > 0) text += fmt::format(", {} mark{}", status.marks, status.marks == 1 ? "" : "s");
  return text;
}

/// Notes parameter changes of other programs.
class ParameterWatch {
 public:
  ParameterWatch(device::Device& device, recording::Recorder& recorder)
      : device_(device), recorder_(recorder), known_(device.parameters()) {}

  /// Call this function for each pose. It reads the parameters twice per second.
  void check(const device::Pose& pose) {
    constexpr std::int64_t interval_periods = protocol::servo_rate_Hz / 2;
    if (pose.time_periods < next_periods_) return;
    next_periods_ = pose.time_periods + interval_periods;
    protocol::ParameterSet now;
    try {
      now = device_.parameters();
    } catch (const device::Disconnected&) {
      throw;
    } catch (const device::Error&) {  // the board is busy; the next check reads the parameters again
      return;
    }
    for (const auto& event : device::events_of_change(known_, now, pose.time_periods, ", by another program"))
      recorder_.note(event);
    known_ = now;
  }

 private:
  device::Device& device_;
  recording::Recorder& recorder_;
  protocol::ParameterSet known_;
  std::int64_t next_periods_ = 0;
};

/// Returns the reason if the force was switched off during the recording.
std::optional<std::string> run(device::Device& device, recording::Recorder& recorder, const RecordOptions& options,
                               RecordedSpan& span, std::optional<ForceSwitch>& force) {
  const InterruptGuard interrupt;
  std::optional<std::string> force_went_off;
  std::optional<MarkKeys> keys;
  if (options.mark_key) keys.emplace(STDIN_FILENO);
  RecordingThread scope(device, recorder, span);
  ProgressBar progress;
  const auto show = [&](const RecorderStatus& status) {
    if (options.seconds == 0) return progress(progress_text(status) + ". Ctrl-C stops it.", std::nullopt);
    // The last sample is one period before the end of the recording.
    progress(progress_text(status),
             std::min(1.0, (status.duration_s + 1.0 / protocol::servo_rate_Hz) / options.seconds));
  };
  auto next_shown = std::chrono::steady_clock::now();
  int silent_reads = 0;
  recording::EventFeed events(recorder);
  ParameterWatch parameters(device, recorder);
  while (!scope.is_done() && !interrupt.is_interrupted() && recorder.status().running) {
    const auto now = std::chrono::steady_clock::now();
    device.keep_alive();
    const auto pose = device.read_pose(read_timeout);
    silent_reads = pose ? 0 : silent_reads + 1;
    if (pose) {
      events.take(*pose);
      parameters.check(*pose);
    }
    if (force && pose && !force_went_off) force_went_off = force->loss(*pose);
    if (silent_reads * read_timeout > silence_limit) throw device::Error(device_is_silent);
    while (keys) {
      const auto text = keys->next();
      if (!text) break;
      recorder.mark(*text);
    }
    if (now < next_shown) continue;
    next_shown = now + 100ms;
    show(recorder.status());
  }
  if (force) force->switch_off();  // immediately, because a missing sign of life would raise a fault
  show(recorder.status());
  progress.end();
  return force_went_off;
}

ordered_json to_json(const RecordOptions& options, const RecorderStatus& status,
                     const std::optional<std::string>& force_went_off) {
  ordered_json json{{"file", options.file},  {"duration_s", status.duration_s}, {"samples", status.samples},
                    {"lost", status.lost},   {"bytes", status.bytes},           {"free_bytes", status.free_bytes},
                    {"marks", status.marks}, {"complete", status.is_complete}};
  if (force_went_off) json["force_went_off"] = *force_went_off;
  if (!status.error.empty()) json["error"] = status.error;
  return json;
}

int record(const DeviceOptions& device_options, const RecordOptions& options) {
  auto [signals, early] = read_typed(
      device_options,
      [&] {
        recording::check_can_be_created(options.file);
        return chosen_signals(options);
      },
      BoardPace::real_time);
  const auto connection = early ? std::move(*early) : connect(device_options, BoardPace::real_time);
  auto& device = *connection.device;
  if (options.all) signals = chosen_signals(options);  // now with the signals of the board's force law
  const auto information = recording::describe(
      device.information(), device.parameters(), signals, connection.arm_name, connection.endpoint.is_virtual,
      {options.name, options.note, connection.image, connection.arm_description});
  std::optional<ForceSwitch> force;
  if (options.force) force.emplace(device);
  device.select_signals(signals);  // first, so that a busy scope does not leave an empty file
  recording::Recorder recorder(options.file, information);
  RecordedSpan span(periods_of(options));
  std::string failure;
  std::optional<std::string> force_went_off;
  try {
    force_went_off = run(device, recorder, options, span, force);
    device.select_signals({});
  } catch (const device::Error& error) {
    failure = error.what();
  }
  if (const auto status = recorder.status(); !failure.empty() || span.missing_at_end(status.samples, status.lost) > 0)
    recorder.miss_end();
  auto status = recorder.stop();
  if (status.error.empty() && !failure.empty())
    status.error = failure + " The recording contains all samples up to that time.";
  if (const auto missing = span.missing_at_end(status.samples, status.lost); missing > 0 && status.error.empty())
    status.error = fmt::format(
        "The last {:.4f} s were lost between board and PC, or the disk was too slow. The recording contains all "
        "samples up to that time.",
        static_cast<double>(missing) / protocol::servo_rate_Hz);
  if (device_options.json)
    fmt::print("{}\n", to_json(options, status, force_went_off).dump());
  else
    fmt::print("{}: {:.2f} s, {} samples of {} signals, {} lost, {:.1f} MB\n", options.file, status.duration_s,
               status.samples, signals.size(), status.lost, 1e-6 * static_cast<double>(status.bytes));
  if (force_went_off && !device_options.json) fmt::print("{}\n", *force_went_off);
  if (!status.error.empty()) throw device::Error(status.error);
  return 0;
}

}  // namespace

void add_record_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "record", "Records signals at every control period, until Ctrl-C or for a given time");
  const auto record_options = std::make_shared<RecordOptions>();
  command
      ->add_option("FILE", record_options->file,
                   "New file to write. Its extension selects the format: .h5 (HDF5) or .csv")
      ->required();
  auto* signals =
      command
          ->add_option(
              "--signals", record_options->signals,
              "Comma-separated names from `inkwell signals`. The default has the\nsignals that replay and plots need")
          ->type_name("NAMES");
  command
      ->add_flag("--all", record_options->all,
                 "All signals; those after the 32nd of `inkwell signals` at 1250 Hz; not with --signals")
      ->excludes(signals);
  command->add_option("--seconds", record_options->seconds, "Stop after this board time")
      ->type_name("SECONDS")
      ->check(more_than_zero());
  command->add_flag("--mark-key", record_options->mark_key,
                    "The space bar sets a mark; from a pipe, each line sets a mark with its text");
  command->add_option("--name", record_options->name, "Name of the recording, such as a subject and a trial")
      ->type_name("NAME");
  command->add_option("--note", record_options->note, "Note that is stored in the recording")->type_name("SENTENCE");
  command->add_flag("--force", record_options->force,
                    "Switch the force on before the recording, and off after the recording");
  add_examples(*command,
               "inkwell record push.h5 --mark-key --force\n"
               "inkwell record push.csv --signals force_N,position_z_m --seconds 10");
  command->callback([context, record_options] {
    context.action = [&options = context.device, record_options] { return record(options, *record_options); };
  });
}

}  // namespace inkwell::command_line
