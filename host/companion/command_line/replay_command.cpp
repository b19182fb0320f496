#include "host/companion/command_line/commands.hpp"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/recording/stored_recording.hpp"

#include "host/companion/command_line/read_recording.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;
using recording::StoredRecording;

ordered_json to_json(const StoredRecording& recording) {
  const auto& about = recording.information;
  ordered_json signals = ordered_json::array(), simulated = ordered_json::array(), marks = ordered_json::array(),
               parameters = ordered_json::object();
  for (const auto signal : about.signals) signals.push_back({{"name", info(signal).name}, {"unit", info(signal).unit}});
  for (const auto known : about.simulated)
    simulated.push_back({{"name", info(known).name}, {"unit", info(known).unit}});
  for (const auto& mark : recording.marks)
    marks.push_back({{"time_s", recording.elapsed_s_at(mark.period)},
                     {"text", mark.text},
                     {"kind", name_of(mark.kind)},
                     {"clock_utc", mark.clock_utc}});
  ordered_json clock = ordered_json::array();
  for (const auto& reading : recording.clock)
    clock.push_back({{"time_s", recording.elapsed_s_at(reading.period)}, {"utc_us", reading.utc_us}});
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    parameters[std::string(protocol::known_parameters()[i].name)] = about.parameters.values[i];
  return {{"name", about.name},
          {"note", about.note},
          {"created_utc", about.created_utc},
          {"library_version", about.library_version},
          {"library_sha256", about.library_sha256},
          {"image_sha256", about.image_sha256},
          {"arm_sha256", about.arm_sha256},
          {"image_check", about.image_check},
          {"firmware_version", about.firmware_version},
          {"protocol_version", about.protocol_version},
          {"serial_number", about.serial_number},
          {"arm", about.arm},
          {"simulation", about.simulation},
          {"complete", recording.complete},
          {"duration_s", recording.duration_s()},
          {"samples", recording.size()},
          {"lost", recording.lost()},
          {"signals", signals},
          {"simulated", simulated},
          {"marks", marks},
          {"clock", clock},
          {"parameters", parameters},
          {"remarks", recording.remarks}};
}

template <class Value>
void print_names(const char* what, const std::vector<Value>& values) {
  std::vector<std::string_view> names;
  for (const auto value : values) names.push_back(info(value).name);
  fmt::print("{:<20}{}\n", fmt::format("{} {}", names.size(), what), fmt::join(names, ", "));
}

void print(const StoredRecording& recording) {
  const auto& about = recording.information;
  if (!about.name.empty()) fmt::print("name                {}\n", about.name);
  if (!about.note.empty()) fmt::print("note                {}\n", about.note);
  fmt::print("recorded            {}{}\n", about.created_utc, about.simulation ? ", from a simulation" : "");
  fmt::print("device              {}, firmware {}{}, protocol {}\n", about.serial_number, about.firmware_version,
             about.image_check.empty() ? "" : fmt::format(" (image {})", about.image_check), about.protocol_version);
  if (!about.arm.empty()) fmt::print("arm                 {}\n", about.arm);
  fmt::print("duration            {:.3f} s, {} samples, {} lost{}\n", recording.duration_s(), recording.size(),
             recording.lost(), recording.complete ? "" : "; not complete");
  print_names("signals", about.signals);
  if (!about.simulated.empty()) print_names("simulated", about.simulated);
  for (const auto& mark : recording.marks)
    fmt::print("{:<10}{:9.3f} s   {}\n", name_of(mark.kind), recording.elapsed_s_at(mark.period), mark.text);
  const auto defaults = protocol::default_parameters();
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    if (about.parameters.values[i] != defaults.values[i])
      fmt::print("not the default     {} = {}\n", protocol::known_parameters()[i].name, about.parameters.values[i]);
}

int describe(const DeviceOptions& options, const std::string& file) {
  const auto recording = open_recording(file);
  if (options.json)
    fmt::print("{}\n", to_json(recording).dump(2));
  else
    print(recording);
  return 0;
}

int print_log(const std::string& file) {
  fmt::print("{}", recording::log_text(open_recording(file)));
  return 0;
}

}  // namespace

void add_replay_command(const CommandContext& context) {
  struct ReplayOptions {
    std::string file;
    std::string over;
    std::string align;
    bool information = false;
    bool log = false;
  };
  auto* command = context.program.add_subcommand(
      "replay", "Opens a recording in the window, or describes it with --info or --json");
  const auto replay_options = std::make_shared<ReplayOptions>();
  command->add_option("FILE", replay_options->file, "Recording from `inkwell record` or `inkwell experiment`")
      ->required();
  command->add_option("OVER", replay_options->over, "Second recording, shown over FILE in the scope");
  command
      ->add_option("--align", replay_options->align,
                   "Text of the mark that aligns both recordings. Default: their first samples")
      ->type_name("MARK");
  command->add_flag("--info", replay_options->information, "Only describe the recording");
  command->add_flag("--log", replay_options->log, "Only print marks and device events: clock, time, kind, text");
  add_examples(*command,
               "inkwell replay push.h5\ninkwell replay soft.h5 stiff.h5 --align touch\n"
               "inkwell replay push.h5 --info\ninkwell replay push.h5 --log > push.txt");
  command->callback([context, replay_options] {
    context.action = [context, replay_options] {
      if (replay_options->log) return print_log(replay_options->file);
      return context.device.json || replay_options->information
                 ? describe(context.device, replay_options->file)
                 : context.open_window([&](window::WindowOptions& options) {
                     options.replay = {replay_options->file, replay_options->over, replay_options->align};
                   });
    };
  });
}

}  // namespace inkwell::command_line
